// The clip box and plane in the picture: outlines, and dots that can be dragged.
import { frame, projector, view_height } from "./camera.js";
import { box_corners, with_side } from "./clip.js";
import { at_shares, centre, diagonal, edges, plane_in_box } from "./geometry.js";
import { add, along, inner, norm, scale, subtract, unit } from "./vectors.js";

const of_box = "#ffd166", of_plane = "#7fd1ff";
const reach = { mouse: 11, pen: 14, touch: 26 }; // [CSS pixels]

/// The dots: {x, y, kind: "side"|"offset"|"tilt", side}, in CSS pixels of a picture of width x height.
export function clip_dots(app, width, height) {
    const { scene } = app.state, project = projector(app.camera, width, height), dots = [];
    const put = (point, rest) => {
        const at = project(point);
        if (at) dots.push({ x: at.x, y: at.y, point, ...rest });
    };
    if (scene.clip_box) for (let side = 0; side < 6; ++side) put(side_centre(app.volume, scene.clip_box, side), { kind: "side", side });
    if (scene.clip_plane) {
        const { point, tip } = plane_points(app);
        put(point, { kind: "offset" });
        put(tip, { kind: "tilt" });
    }
    return dots;
}

function side_centre(volume, box, side) {
    const shares = [0, 1, 2].map((a) => (box[a] + box[a + 3]) / 2);
    shares[side % 3] = box[side];
    return at_shares(volume, shares);
}

/// The plane's point nearest to the volume's centre, and one before it.
function plane_points({ state, volume }) {
    const plane = state.scene.clip_plane, n = unit(plane.normal), middle = centre(volume);
    const point = along(middle, n, plane.offset / norm(plane.normal) - inner(n, middle));
    return { point, tip: along(point, n, diagonal(volume) * 0.14), n };
}

/// A drag of what lies under (x, y), as tools.js has them, or null.
export function clip_drag(app, x, y, width, height, pointer_type) {
    if (!app.clip.shows_handles) return null;
    const near = (d) => Math.hypot(d.x - x, d.y - y);
    const dot = clip_dots(app, width, height).sort((a, b) => near(a) - near(b))[0];
    if (!dot || near(dot) > (reach[pointer_type] ?? reach.mouse)) return null;
    if (dot.kind === "side") return side_drag(app, dot, width, height);
    return dot.kind === "offset" ? offset_drag(app, dot, width, height) : tilt_drag(app, height);
}

/// How far one moves along a direction in space, by pixels; directions that point at the viewer are moved gently.
function pixels_along(app, point, direction, width, height) {
    const project = projector(app.camera, width, height), a = project(point), b = project(add(point, direction));
    if (!a || !b) return () => 0;
    const v = [b.x - a.x, b.y - a.y], square = Math.max(v[0] ** 2 + v[1] ** 2, (0.1 * height * norm(direction)) ** 2 / view_height(app.camera) ** 2);
    return (dx, dy) => (dx * v[0] + dy * v[1]) / square;
}

function side_drag(app, dot, width, height) {
    const { volume } = app, axis = dot.side % 3, from = app.state.scene.clip_box;
    const shares = [0, 0, 0];
    shares[axis] = 1;
    const along_axis = subtract(at_shares(volume, shares), at_shares(volume, [0, 0, 0]));
    const moved = pixels_along(app, dot.point, along_axis, width, height);
    const box = (dx, dy) => with_side(from, dot.side, from[dot.side] + moved(dx, dy));
    return { total: (dx, dy) => app.state.edit("clip_box.drag", (scene) => (scene.clip_box = box(dx, dy))) };
}

function offset_drag(app, dot, width, height) {
    const from = app.state.scene.clip_plane, moved = pixels_along(app, dot.point, unit(from.normal), width, height);
    const offset = (dx, dy) => from.offset + moved(dx, dy) * norm(from.normal);
    return { total: (dx, dy) => app.state.edit("clip_plane.drag", (scene) => (scene.clip_plane.offset = offset(dx, dy))) };
}

/// The tip follows the pointer in the plane of the picture; the plane turns around its own point.
function tilt_drag(app, height) {
    const { point, tip } = plane_points(app), { right, up } = frame(app.camera), mm = view_height(app.camera) / height;
    return {
        total: (dx, dy) => {
            const normal = unit(subtract(add(tip, add(scale(right, dx * mm), scale(up, -dy * mm))), point));
            app.state.edit("clip_plane.tilt", (scene) => (scene.clip_plane = { normal, offset: inner(normal, point) }));
        },
    };
}

/// Draws into a picture of width x height CSS pixels.
export function draw_clip(context, app, width, height) {
    if (!app.clip.shows_handles) return;
    const { scene } = app.state, project = projector(app.camera, width, height);
    const path = (points, color, closed) => {
        const ends = points.map(project);
        if (ends.some((p) => !p)) return;
        for (const [line, style] of [[3.5, "rgb(0 0 0 / 0.5)"], [1.5, color]]) {
            context.beginPath();
            ends.forEach((p, i) => (i ? context.lineTo(p.x, p.y) : context.moveTo(p.x, p.y)));
            if (closed) context.closePath();
            context.lineWidth = line;
            context.strokeStyle = style;
            context.stroke();
        }
    };
    const box = box_corners(app.volume, scene);
    if (scene.clip_box) for (const [i, j] of edges) path([box[i], box[j]], of_box);
    if (scene.clip_plane) {
        path(plane_in_box(box, scene.clip_plane.normal, scene.clip_plane.offset), of_plane, true);
        const { point, tip } = plane_points(app);
        path([point, tip], of_plane);
    }
    for (const dot of clip_dots(app, width, height)) {
        context.beginPath();
        context.arc(dot.x, dot.y, dot.kind === "tilt" ? 5 : 7, 0, 2 * Math.PI);
        context.fillStyle = dot.kind === "side" ? of_box : of_plane;
        context.fill();
        context.lineWidth = 1.5;
        context.strokeStyle = "rgb(0 0 0 / 0.8)";
        context.stroke();
    }
}
