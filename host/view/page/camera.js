// The camera: a value {eye, target, up, fov, orthographic, height, zoom} in LPS millimetres, as scene files hold it, and what moves it.
// Every function takes a camera and gives a new one. `up` is the world's z, or the picture's own where that is not upwards: never parallel to
// the view.
import { add, along, clamp, cross, direction, inner, norm, radian, rotate, scale, subtract, unit } from "./vectors.js";

const steepest = 89.9; // degrees at which z still is upwards

/// Unit right, up and forward of the view. They are the ones of the renderer.
export function frame(camera) {
    const forward = unit(subtract(camera.target, camera.eye));
    const right = unit(cross(forward, camera.up));
    return { right, up: cross(right, forward), forward };
}

const distance = (camera) => norm(subtract(camera.target, camera.eye));

/// Height of what the picture shows at the target [mm].
export function view_height(camera) {
    const height = camera.orthographic ? camera.height : 2 * Math.tan((camera.fov / 2) * radian) * distance(camera);
    return height / camera.zoom;
}

/// Projects world points into a picture of `width` x `height`: gives a function from a point to {x, y, depth}, or null behind the eye.
export function projector(camera, width, height) {
    const { right, up, forward } = frame(camera);
    const at_target = height / view_height(camera), reach = distance(camera);
    return (point) => {
        const from_eye = subtract(point, camera.eye), depth = inner(from_eye, forward);
        if (!camera.orthographic && depth <= 1e-6 * reach) return null;
        const pixels = camera.orthographic ? at_target : (at_target * reach) / depth;
        return { x: width / 2 + inner(from_eye, right) * pixels, y: height / 2 - inner(from_eye, up) * pixels, depth };
    };
}

/// The point of the plane through the target that lies behind the picture's point (shares 0..1 of width and height).
export function point_at_target(camera, x, y, aspect) {
    const { right, up } = frame(camera), height = view_height(camera);
    return along(along(camera.target, right, (x - 0.5) * height * aspect), up, (0.5 - y) * height);
}

/// Azimuth and elevation of the eye as seen from the target [degrees]. Straight above and below, the picture's up decides the azimuth.
export function angles(camera) {
    const { up, forward } = frame(camera);
    const elevation = Math.asin(clamp(-forward[2], -1, 1)) / radian;
    if (Math.hypot(forward[0], forward[1]) > 1e-6) return { azimuth: Math.atan2(-forward[0], forward[1]) / radian, elevation };
    const sign = elevation > 0 ? 1 : -1;
    return { azimuth: Math.atan2(-up[0] * sign, up[1] * sign) / radian, elevation };
}

/// Looks at the target from a direction [degrees], with the world's z upwards in the picture.
export function look_from(camera, azimuth, elevation) {
    const e = clamp(elevation, -90, 90), up = Math.abs(e) < steepest ? [0, 0, 1] : direction(azimuth, e + 90);
    return { ...camera, eye: along(camera.target, direction(azimuth, e), distance(camera)), up };
}

/// Turns around the target by angles [degrees], as if the hand moved the volume. The turntable keeps the horizon level.
export function orbit(camera, to_right, downwards, trackball) {
    if (!trackball) {
        const { azimuth, elevation } = angles(camera);
        return look_from(camera, azimuth - to_right, elevation + downwards);
    }
    const { right, up } = frame(camera);
    const turn = (v) => rotate(rotate(v, up, -to_right * radian), right, -downwards * radian);
    const eye = add(camera.target, turn(subtract(camera.eye, camera.target)));
    return { ...camera, eye, up: turn(up) };
}

/// Moves the picture's content by shares of the picture's height.
export function pan(camera, to_right, downwards) {
    const { right, up } = frame(camera), height = view_height(camera);
    return moved(camera, add(scale(right, -to_right * height), scale(up, downwards * height)));
}

function moved(camera, by) {
    return { ...camera, eye: add(camera.eye, by), target: add(camera.target, by) };
}

/// Brings everything nearer (factor below 1) or farther, around a world point that keeps its place in the picture.
/// The view's height stays within `limits` = [least, greatest] millimetres.
export function zoom_around(camera, factor, point, limits) {
    const height = view_height(camera);
    const by = clamp(height * factor, limits[0], limits[1]) / height;
    const toward = (p) => add(point, scale(subtract(p, point), by));
    const target = toward(camera.target);
    if (camera.orthographic) return { ...moved(camera, subtract(target, camera.target)), height: camera.height * by };
    return { ...camera, eye: toward(camera.eye), target };
}

/// Another field of view [degrees] with what is at the target as large as before.
export function with_fov(camera, fov) {
    if (camera.orthographic) return { ...camera, fov };
    const factor = Math.tan((camera.fov / 2) * radian) / Math.tan((fov / 2) * radian);
    return { ...camera, fov, eye: add(camera.target, scale(subtract(camera.eye, camera.target), factor)) };
}

/// Parallel or perspective projection with what is at the target as large as before. `clear` [mm] is a distance at which a parallel
/// camera stands outside the volume.
export function with_projection(camera, orthographic, clear) {
    if (orthographic === camera.orthographic) return camera;
    const back = unit(subtract(camera.eye, camera.target)), slope = 2 * Math.tan((camera.fov / 2) * radian);
    const height = orthographic ? slope * distance(camera) : camera.height;
    const away = orthographic ? Math.max(clear, distance(camera)) : height / slope;
    return { ...camera, orthographic, height: orthographic ? height : 0, eye: along(camera.target, back, away) };
}

/// Looks from a direction [degrees] with all points in the picture, in the middle of what they cover.
export function framed(camera, points, aspect, azimuth, elevation) {
    const margin = 0.94, middle = scale(points.reduce(add), 1 / points.length);
    const aimed = look_from({ ...camera, orthographic: false, height: 0, eye: add(middle, [1, 0, 0]), target: middle }, azimuth, elevation);
    const { right, up, forward } = frame(aimed), tan_y = Math.tan((camera.fov / 2) * radian) * margin;
    const needed = points.map((p) => {
        const d = subtract(p, middle);
        return Math.max(Math.abs(inner(d, right)) / (tan_y * aspect), Math.abs(inner(d, up)) / tan_y) - inner(d, forward);
    });
    return { ...aimed, zoom: 1, eye: along(middle, forward, -Math.max(...needed)) };
}

/// Adapts a camera that was framed for one aspect (width over height) to another, so that nothing is cut off at the sides.
export function fitted(camera, framed_aspect, aspect) {
    const factor = Math.min(1, framed_aspect) / Math.min(1, aspect);
    if (camera.orthographic) return { ...camera, height: camera.height * factor };
    return { ...camera, eye: add(camera.target, scale(subtract(camera.eye, camera.target), factor)) };
}
