// What the page draws over the picture, crisp at any size: scale bar, orientation, colour bar, samples and time. The same code draws it
// over exported stills.
import { frame, view_height } from "./camera.js";
import { css_of } from "./color.js";
import { readable } from "./controls.js";
import { at, physical, span } from "./transfer_function.js";
import { ticks } from "./transfer_plot.js";
import { inner } from "./vectors.js";

export const overlay_names = { scale: "Scale bar", axes: "Orientation", colors: "Colour bar", samples: "Samples and time" };

const axis_colors = ["#ff8a7a", "#8fe388", "#86b7ff"];
const letters = [["R", "L"], ["A", "P"], ["I", "S"]]; // low and high end of x, y, z

/// Draws into a rectangle of `context`. what: {x, y, width, height, pixel (size of a CSS pixel), camera, scene, volume, automatic, status, shown}
export function draw_overlays(context, what) {
    context.save();
    context.translate(what.x, what.y);
    context.scale(what.pixel, what.pixel);
    const place = { ...what, width: what.width / what.pixel, height: what.height / what.pixel };
    context.font = "500 12px system-ui, sans-serif";
    if (what.shown.axes) draw_axes(context, place);
    if (what.shown.scale) draw_scale(context, place);
    if (what.shown.colors) draw_colors(context, place);
    if (what.shown.samples && what.status) draw_status(context, place);
    context.restore();
}

/// White with a dark rim, so that it can be read over anything.
function text(context, words, x, y, align, baseline = "middle", color = "#fff") {
    context.textAlign = align;
    context.textBaseline = baseline;
    context.lineJoin = "round";
    context.lineWidth = 3;
    context.strokeStyle = "rgb(0 0 0 / 0.65)";
    context.strokeText(words, x, y);
    context.fillStyle = color;
    context.fillText(words, x, y);
}

function line(context, points, color = "#fff") {
    for (const [width, style] of [[4, "rgb(0 0 0 / 0.5)"], [2, color]]) {
        context.beginPath();
        points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
        context.lineWidth = width;
        context.strokeStyle = style;
        context.stroke();
    }
}

/// A length in words: micrometres and metres where they are handier.
function length_text(mm) {
    if (mm < 1) return `${readable(mm * 1000)} µm`;
    return mm >= 1000 ? `${readable(mm / 1000)} m` : `${readable(mm)} mm`;
}

/// In perspective the scale holds at the depth of the camera's target.
function draw_scale(context, { width, height, camera }) {
    const per_mm = height / view_height(camera), longest = Math.min(150, width * 0.24) / per_mm;
    const power = 10 ** Math.floor(Math.log10(longest)), mm = power * [5, 2, 1].find((s) => s * power <= longest);
    const x0 = 112, x1 = x0 + mm * per_mm, y = height - 22;
    line(context, [[x0, y - 5], [x0, y], [x1, y], [x1, y - 5]]);
    text(context, length_text(mm) + (camera.orthographic ? "" : " at the centre"), x0, y - 15, "left");
}

function draw_axes(context, { height, camera, volume }) {
    const { right, up, forward } = frame(camera), reach = 30, middle = [54, height - 54];
    const ends = [0, 1, 2].flatMap((a) => [-1, 1].map((sign) => {
        const d = [0, 0, 0];
        d[a] = sign;
        return { axis: a, sign, x: middle[0] + inner(d, right) * reach, y: middle[1] - inner(d, up) * reach, depth: inner(d, forward),
            letter: volume.anatomical ? letters[a][sign > 0 ? 1 : 0] : sign > 0 ? "xyz"[a] : "" };
    }));
    for (const end of ends.sort((a, b) => b.depth - a.depth)) {
        context.globalAlpha = end.depth > 0.25 ? 0.55 : 1;
        if (end.sign > 0 || volume.anatomical) line(context, [middle, [end.x, end.y]], axis_colors[end.axis]);
        const out = 1.36;
        text(context, end.letter, middle[0] + (end.x - middle[0]) * out, middle[1] + (end.y - middle[1]) * out, "center");
    }
    context.globalAlpha = 1;
}

/// The values that the volume has and the function covers.
function draw_colors(context, { width, height, scene, volume, automatic }) {
    const transfer = physical(scene.transfer ?? automatic, volume.range), [first, last] = span(transfer);
    const low = Math.max(first, volume.range[0]), high = Math.min(last, volume.range[1]);
    if (!(low < high)) return;
    const long = Math.min(220, height * 0.4), x = width - 26, y0 = height / 2 - long / 2;
    for (let i = 0; i < long; ++i) {
        context.fillStyle = css_of(at(transfer, high - ((i + 0.5) / long) * (high - low)).color);
        context.fillRect(x, y0 + i, 10, 1.5);
    }
    context.lineWidth = 1;
    context.strokeStyle = "rgb(255 255 255 / 0.6)";
    context.strokeRect(x - 0.5, y0 - 0.5, 11, long + 1);
    for (const value of ticks(low, high, Math.max(2, long / 45))) {
        const y = y0 + ((high - value) / (high - low)) * long;
        text(context, readable(value).replace("-", "−"), x - 6, y, "right");
    }
    if (volume.unit) text(context, volume.unit, x + 10, y0 - 12, "right");
}

function draw_status(context, { width, height, status }) {
    text(context, status, width - 16, width < 430 ? height - 48 : height - 22, "right"); // above the scale bar where it is narrow
}
