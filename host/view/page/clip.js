// Cutting the volume open: a box along its own axes and a plane anywhere, as sections of the panel.
import { frame } from "./camera.js";
import { button, checkbox, element, note, row, section, slider } from "./controls.js";
import { axis_direction, centre, corners, diagonal, ends_of_axis, name_of_plane, whole_box } from "./geometry.js";
import { inner, scale } from "./vectors.js";

const least_gap = 0.01; // between the two ends of an axis, as a share

/// A box with one of its six sides moved to a share; the other side stays.
export function with_side(box, side, share) {
    const next = [...box], axis = side % 3;
    next[side] = side < 3 ? Math.min(Math.max(0, share), box[axis + 3] - least_gap) : Math.max(Math.min(1, share), box[axis] + least_gap);
    return next;
}

/// The plane through the volume's centre that looks along a direction; what lies beyond it goes.
const plane_through_centre = (volume, normal) => ({ normal, offset: inner(normal, centre(volume)) });

export class ClipPanel {
    #app;
    #box_sliders = [];

    constructor(app) {
        this.#app = app;
        this.box_on = checkbox("Clip box", (on) => this.#edit("clip_box", on ? [...whole_box] : null));
        this.plane_on = checkbox("Clip plane", (on) => this.#edit("clip_plane", on ? this.#towards_viewer() : null));
        this.sliders = element("div");
        this.handles = checkbox("Show handles in the picture", () => app.redraw());
        this.handles.set(true);
        this.offset_place = element("div");
        this.across = element("span", { class: "row" });
        this.plane_row = row(
            button("Facing me", () => this.#edit("clip_plane", this.#towards_viewer()), { title: "Cuts away the half that is nearer to you" }),
            button("Flip", () => this.#flip(), { title: "Shows the other side" }), this.across);
        this.plane_parts = element("div", {}, this.plane_row, this.offset_place);
        this.root = section("Cut open", false, this.box_on.root, this.sliders, this.plane_on.root, this.plane_parts, this.handles.root,
            note("Drag the dots in the picture. The plane's outer dot tilts it."));
        this.root.addEventListener("toggle", () => app.redraw());
    }

    get shows_handles() {
        return this.root.open && this.handles.root.querySelector("input").checked;
    }

    /// For another volume: its sides have other names.
    load() {
        const { volume } = this.#app;
        this.#box_sliders = [0, 1, 2, 3, 4, 5].map((side) => {
            const ends = ends_of_axis(volume, side % 3), name = ends[side < 3 ? 0 : 1];
            return slider(name[0].toUpperCase() + name.slice(1), { low: 0, high: 100, step: 0.5, unit: "%" },
                (percent) => this.#edit("clip_box", with_side(this.#app.state.scene.clip_box ?? whole_box, side, percent / 100), `clip_box.${side}`));
        });
        this.sliders.replaceChildren(...[0, 3, 1, 4, 2, 5].map((side) => this.#box_sliders[side].root));
        const cut = (axis) => this.#edit("clip_plane", plane_through_centre(volume, axis_direction(volume, axis)));
        const title = "Through the middle of the volume";
        this.across.replaceChildren(...[0, 1, 2].map((axis) => button(name_of_plane(volume, axis), () => cut(axis), { title })));
        const middle = centre(volume), half = diagonal(volume) / 2;
        const help = "Distance of the plane from the volume's centre";
        this.offset = slider("Depth", { low: -half, high: half, step: half / 250, unit: "mm", help },
            (mm) => this.#edit("clip_plane", this.#at_depth(mm), "clip_plane.offset"));
        this.offset_place.replaceChildren(this.offset.root);
        this.middle = middle;
    }

    update() {
        const { clip_box, clip_plane } = this.#app.state.scene;
        this.box_on.set(Boolean(clip_box));
        this.plane_on.set(Boolean(clip_plane));
        this.sliders.hidden = !clip_box;
        this.plane_parts.hidden = !clip_plane;
        this.#box_sliders.forEach((s, side) => s.set((clip_box ?? whole_box)[side] * 100));
        if (clip_plane) this.offset.set((clip_plane.offset - inner(clip_plane.normal, this.middle)) / Math.hypot(...clip_plane.normal));
    }

    #towards_viewer() {
        return plane_through_centre(this.#app.volume, scale(frame(this.#app.camera).forward, -1));
    }

    #at_depth(mm) {
        const { normal } = this.#app.state.scene.clip_plane;
        return { normal, offset: inner(normal, this.middle) + mm * Math.hypot(...normal) };
    }

    #flip() {
        const { normal, offset } = this.#app.state.scene.clip_plane;
        this.#edit("clip_plane", { normal: scale(normal, -1), offset: -offset });
    }

    #edit(member, value, key = null) {
        this.#app.state.edit(key, (scene) => {
            if (value === null) delete scene[member];
            else scene[member] = value;
        });
    }
}

export const box_corners = (volume, scene) => corners(volume, scene.clip_box ?? whole_box);
