// Where the volume lies: boxes as shares 0..1 along its index axes, in world space (LPS millimetres), and how bodies name directions.
import { add, along, inner, norm, scale, subtract, unit } from "./vectors.js";

/// World position of shares along the volume's axes: 0 and 1 are its outer faces.
export function at_shares(volume, shares) {
    const m = volume.index_to_world, index = shares.map((s, a) => s * volume.size[a] - 0.5);
    return [0, 1, 2].map((r) => m[4 * r] * index[0] + m[4 * r + 1] * index[1] + m[4 * r + 2] * index[2] + m[4 * r + 3]);
}

/// The eight corners of a box [low xyz, high xyz] of shares.
export function corners(volume, box) {
    return [0, 1, 2, 3, 4, 5, 6, 7].map((k) => at_shares(volume, [0, 1, 2].map((a) => box[k & (1 << a) ? a + 3 : a])));
}

/// Pairs of corners that an edge joins.
export const edges = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((k) => [1, 2, 4].filter((bit) => !(k & bit)).map((bit) => [k, k | bit]));

export const whole_box = [0, 0, 0, 1, 1, 1];
export const centre = (volume) => at_shares(volume, [0.5, 0.5, 0.5]);
export const diagonal = (volume) => norm(subtract(at_shares(volume, [1, 1, 1]), at_shares(volume, [0, 0, 0])));

/// Unit direction in which an index axis grows.
export const axis_direction = (volume, axis) => unit([0, 1, 2].map((r) => volume.index_to_world[4 * r + axis]));

const names = [["right", "left"], ["front", "back"], ["bottom", "top"]];

/// Words for the lower and upper end of an index axis: ["right", "left"] of a patient, else ["x low", "x high"].
export function ends_of_axis(volume, axis) {
    const letter = "xyz"[axis];
    if (!volume.anatomical) return [`${letter}, from`, `${letter}, to`];
    const d = axis_direction(volume, axis), sizes = d.map(Math.abs), world = sizes.indexOf(Math.max(...sizes));
    const [low, high] = d[world] > 0 ? names[world] : [...names[world]].reverse();
    return [low, high];
}

/// What a plane across an index axis is called.
export function name_of_plane(volume, axis) {
    if (!volume.anatomical) return "xyz"[axis];
    const sizes = axis_direction(volume, axis).map(Math.abs);
    return ["Sagittal", "Coronal", "Axial"][sizes.indexOf(Math.max(...sizes))];
}

/// The polygon in which the plane inner(normal, x) = offset cuts a box: its corners in order, or none.
export function plane_in_box(box_corners, normal, offset) {
    const found = [];
    for (const [i, j] of edges) {
        const a = box_corners[i], b = box_corners[j], da = inner(normal, a) - offset, db = inner(normal, b) - offset;
        if (da * db < 0) found.push(along(a, subtract(b, a), da / (da - db)));
    }
    if (found.length < 3) return [];
    const middle = scale(found.reduce(add), 1 / found.length), u = unit(subtract(found[0], middle)), n = unit(normal);
    const v = [n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]];
    const angle = (p) => Math.atan2(inner(subtract(p, middle), v), inner(subtract(p, middle), u));
    return found.sort((p, q) => angle(p) - angle(q));
}
