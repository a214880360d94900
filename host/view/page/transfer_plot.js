// Draws a transfer function: its opacity over the volume's logarithmic histogram, its knots, colours, value axis, and the bar that moves all.
import { css_of } from "./color.js";
import { readable } from "./controls.js";
import { at, span } from "./transfer_function.js";

const margin = 12, top = 12, below_plot = 58; // [CSS pixels]
const bar_height = 16;

/// Where things lie in a plot of `width` x `height` CSS pixels that shows the values view[0]..view[1].
export class PlotLayout {
    /// `spread`: low opacities get more room, as their square roots.
    constructor(width, height, view, spread) {
        Object.assign(this, { width, height, view, spread, left: margin, right: width - margin, top, bottom: height - below_plot });
        this.strip = this.bottom + 4; // colours
        this.bar = height - bar_height - 2; // shifts and stretches
    }
    x(value) {
        return this.left + ((value - this.view[0]) / (this.view[1] - this.view[0])) * (this.right - this.left);
    }
    value(x) {
        return this.view[0] + ((x - this.left) / (this.right - this.left)) * (this.view[1] - this.view[0]);
    }
    y(opacity) {
        return this.bottom - (this.spread ? Math.sqrt(opacity) : opacity) * (this.bottom - this.top);
    }
    opacity(y) {
        const share = Math.max(0, (this.bottom - y) / (this.bottom - this.top));
        return this.spread ? share * share : share;
    }
}

/// Round numbers to label an axis with, about `count` of them.
export function ticks(low, high, count) {
    const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find((s) => s * power >= raw);
    const all = [];
    for (let i = Math.ceil(low / step); i * step <= high; ++i) all.push(i * step);
    return all;
}

/// what: {transfer, volume, selected, hovered, colors: {ink, faint, accent, surface, bars}}
export function draw_plot(context, layout, what) {
    context.clearRect(0, 0, layout.width, layout.height);
    context.save();
    context.beginPath();
    context.rect(layout.left, 0, layout.right - layout.left, layout.height);
    context.clip();
    draw_histogram(context, layout, what);
    draw_curve(context, layout, what);
    draw_strip(context, layout, what);
    context.restore();
    draw_axis(context, layout, what);
    draw_bar(context, layout, what);
    draw_knots(context, layout, what);
}

function draw_histogram(context, layout, { volume, colors }) {
    const { low, high } = volume.histogram, counts = without_gaps(volume.histogram.counts);
    const per_bin = counts.length / (high - low), most = Math.log1p(Math.max(1, ...counts));
    context.fillStyle = colors.bars;
    for (let x = Math.floor(layout.left); x < layout.right; ++x) {
        const first = Math.floor((layout.value(x) - low) * per_bin), last = Math.floor((layout.value(x + 1) - low) * per_bin);
        let count = 0;
        for (let bin = Math.max(0, first); bin <= Math.min(counts.length - 1, last); ++bin) count = Math.max(count, counts[bin]);
        const height = (Math.log1p(count) / most) * (layout.bottom - layout.top);
        if (count > 0) context.fillRect(x, layout.bottom - height, 1, height);
    }
}

/// Fewer values than bins leave single empty bins, which mean nothing.
const without_gaps = (counts) => counts.map((c, i) => c || Math.min(counts[i - 1] ?? 0, counts[i + 1] ?? 0));

function draw_curve(context, layout, { transfer, colors }) {
    for (let x = Math.floor(layout.left); x < layout.right; ++x) {
        const here = at(transfer, layout.value(x + 0.5));
        context.fillStyle = css_of(here.color, 0.5);
        context.fillRect(x, layout.y(here.opacity), 1, layout.bottom - layout.y(here.opacity));
    }
    const { points } = transfer;
    const line = () => {
        context.beginPath();
        context.moveTo(layout.left, layout.y(points[0].opacity));
        points.forEach((p, i) => {
            if (layout.spread && i > 0) curve_to(context, layout, points[i - 1], p);
            context.lineTo(layout.x(p.value), layout.y(p.opacity));
        });
        context.lineTo(layout.right, layout.y(points[points.length - 1].opacity));
        context.stroke();
    };
    context.lineJoin = "round";
    context.lineWidth = 4;
    context.strokeStyle = colors.surface;
    line();
    context.lineWidth = 1.75;
    context.strokeStyle = colors.ink;
    line();
}

/// Between two knots the opacity is linear, so its root is not.
function curve_to(context, layout, from, to) {
    for (let k = 1; k < 24; ++k) {
        const s = to.opacity > from.opacity ? (k / 24) ** 2 : 1 - (1 - k / 24) ** 2; // closer together where the root is steep
        context.lineTo(layout.x(from.value + s * (to.value - from.value)), layout.y(from.opacity + s * (to.opacity - from.opacity)));
    }
}

function draw_strip(context, layout, { transfer }) {
    for (let x = Math.floor(layout.left); x < layout.right; ++x) {
        context.fillStyle = css_of(at(transfer, layout.value(x + 0.5)).color);
        context.fillRect(x, layout.strip, 1, 10);
    }
}

function draw_axis(context, layout, { volume, colors }) {
    context.fillStyle = context.strokeStyle = colors.faint;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "top";
    context.textAlign = "center";
    const unit_width = volume.unit ? context.measureText(volume.unit).width + 8 : 0;
    for (const value of ticks(layout.view[0], layout.view[1], Math.max(2, layout.width / 60))) {
        const x = layout.x(value), text = readable(value), half = context.measureText(text).width / 2;
        context.fillRect(Math.round(x), layout.strip + 10, 1, 3);
        if (x + half < layout.width - unit_width && x - half > 0) context.fillText(text, x, layout.strip + 15);
    }
    context.textAlign = "right";
    context.fillText(volume.unit, layout.width - 2, layout.strip + 15);
}

/// From the first knot to the last.
function draw_bar(context, layout, { transfer, colors, hovered }) {
    const [first, last] = span(transfer), x0 = Math.max(layout.left - 4, layout.x(first)), x1 = Math.min(layout.right + 4, layout.x(last));
    const middle = layout.bar + bar_height / 2;
    context.fillStyle = colors.bars;
    context.fillRect(layout.left, middle - 1, layout.right - layout.left, 2);
    if (x1 <= layout.left || x0 >= layout.right) return;
    context.fillStyle = hovered?.part === "bar" ? colors.accent : colors.faint;
    context.fillRect(x0, middle - 3, Math.max(2, x1 - x0), 6);
    for (const [x, part] of [[x0, "first"], [x1, "last"]]) {
        context.fillStyle = hovered?.part === part ? colors.accent : colors.ink;
        context.beginPath();
        context.roundRect(x - 4, layout.bar, 8, bar_height, 3);
        context.fill();
    }
}

function draw_knots(context, layout, { transfer, colors, selected, hovered }) {
    transfer.points.forEach((p, i) => {
        const x = layout.x(p.value), y = layout.y(p.opacity);
        if (x < layout.left - 6 || x > layout.right + 6) return;
        const large = i === selected || (hovered?.part === "knot" && hovered.index === i);
        context.beginPath();
        context.arc(x, y, large ? 7 : 5, 0, 2 * Math.PI);
        context.fillStyle = css_of(p.color);
        context.fill();
        context.lineWidth = i === selected ? 3 : 1.75;
        context.strokeStyle = i === selected ? colors.accent : colors.ink;
        context.stroke();
    });
}
