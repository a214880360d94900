// Transfer functions as values {name, domain, color_space, points: [{value, color, opacity}]}: what editing does to them.
import { from_srgb } from "./color.js";
import { clamp } from "./vectors.js";

/// The same function over physical values with linear colours: the form that the page edits. `range` is that of the volume.
export function physical(transfer, range) {
    const value_of = transfer.domain === "normalized" ? (v) => range[0] + v * (range[1] - range[0]) : (v) => v;
    const color_of = transfer.color_space === "linear" ? (c) => [...c] : from_srgb;
    const points = transfer.points.map((p) => ({ value: value_of(p.value), color: color_of(p.color), opacity: p.opacity }));
    return { name: transfer.name ?? "", domain: "physical", color_space: "linear", points };
}

/// First and last value.
export const span = (transfer) => [transfer.points[0].value, transfer.points[transfer.points.length - 1].value];

/// Colour and opacity at a value, as the renderer has them.
export function at(transfer, value) {
    const { points } = transfer, last = points[points.length - 1];
    if (!(value > points[0].value)) return points[0];
    if (value >= last.value) return last;
    const i = points.findIndex((p) => p.value > value), a = points[i - 1], b = points[i];
    const t = (value - a.value) / (b.value - a.value), mix = (x, y) => x + (y - x) * t;
    return { value, color: a.color.map((c, k) => mix(c, b.color[k])), opacity: mix(a.opacity, b.opacity) };
}

/// Something of the range is visible.
export function shows_something(transfer, range) {
    const inside = transfer.points.filter((p) => p.value >= range[0] && p.value <= range[1]);
    return [at(transfer, range[0]), at(transfer, range[1]), ...inside].some((p) => p.opacity > 0);
}

const with_points = (transfer, points) => ({ ...transfer, points });

export const shifted = (transfer, by) => with_points(transfer, transfer.points.map((p) => ({ ...p, value: p.value + by })));

/// Stretched around a value that stays; the factor is above 0.
export const stretched = (transfer, factor, around) =>
    with_points(transfer, transfer.points.map((p) => ({ ...p, value: around + (p.value - around) * factor })));

/// All opacities times a factor, at most 1.
export const with_opacities_times = (transfer, factor) =>
    with_points(transfer, transfer.points.map((p) => ({ ...p, opacity: Math.min(1, p.opacity * factor) })));

/// A new knot; gives {transfer, index}.
export function with_knot(transfer, value, opacity) {
    const after = transfer.points.findIndex((p) => p.value > value), index = after < 0 ? transfer.points.length : after;
    const points = [...transfer.points];
    points.splice(index, 0, { value, color: [...at(transfer, value).color], opacity: clamp(opacity, 0, 1) });
    return { transfer: with_points(transfer, points), index };
}

/// Without a knot; the last one stays.
export const without_knot = (transfer, index) =>
    transfer.points.length < 2 ? transfer : with_points(transfer, transfer.points.filter((_, i) => i !== index));

/// A knot changed; its value stays between its neighbours'.
export function with_changed_knot(transfer, index, change) {
    const { points } = transfer, next = { ...points[index], ...change };
    next.value = clamp(next.value, points[index - 1]?.value ?? -Infinity, points[index + 1]?.value ?? Infinity);
    next.opacity = clamp(next.opacity, 0, 1);
    return with_points(transfer, points.map((p, i) => (i === index ? next : p)));
}
