// The sections of the panel about the picture itself: how it is drawn, the camera, what is drawn over it, the time of a series.
import { with_fov } from "./camera.js";
import { hex_of, linear_of } from "./color.js";
import { button, checkbox, choice, color_field, element, row, section, segments, slider } from "./controls.js";
import { show_standard_view } from "./keys.js";
import { overlay_names } from "./overlays.js";
import { setting_slider, slider_options } from "./settings.js";
import { clamp } from "./vectors.js";

const usual_most_samples = 4096;
const modes = [
    ["path", "Path traced", "Light as it travels, denoised"],
    ["dvr", "Direct", "Emission and absorption, without shadows"],
    ["mip", "Maximum", "The greatest value along each ray"],
];
const backgrounds = [["transparent", "None"], ["environment", "Surroundings"], ["color", "Colour"]];
const tone_curves = [["filmic", "Filmic"], ["aces", "ACES"], ["reinhard", "Reinhard"], ["none", "None"]];
const details = [["1", "Every pixel"], ["0.5", "Half (faster)"], ["0.25", "Quarter (fastest)"]];

/// Mode, samples, bounces, tone.
export class RenderPanel {
    #app;

    constructor(app) {
        this.#app = app;
        const edit = (change) => app.state.edit(null, change);
        this.mode = segments("How the picture is made", modes, (mode) => edit((s) => (s.mode = mode)));
        this.background = choice("Background", backgrounds, (kind) => edit((s) => (s.background.kind = kind)));
        this.color = color_field("Background colour", (hex) => app.state.edit("background.color", (s) => (s.background.color = linear_of(hex))));
        this.tone = choice("Tone curve", tone_curves, (curve) => edit((s) => (s.tonemap = curve)));
        this.detail = choice("Detail", details, (share) => app.set_detail(Number(share)),
            "Fewer pixels come sooner; saved pictures are not changed by it");
        this.sliders = element("div");
        this.root = section("Picture", true, this.mode.root, this.sliders, this.background.root, this.color.root, this.tone.root, this.detail.root);
    }

    load() {
        const app = this.#app, most = Math.min(app.hello.limits?.samples ?? usual_most_samples, usual_most_samples);
        const samples = setting_slider(app, "Samples", "spp", { logarithmic: true, most });
        const exposure = setting_slider(app, "Exposure", "exposure", { unit: "stops" });
        this.parts = [samples, exposure, setting_slider(app, "Bounces", "bounces"), setting_seed(app)];
        this.sliders.replaceChildren(...this.parts.map((p) => p.root));
    }

    update() {
        const { scene } = this.#app.state;
        this.mode.set(scene.mode);
        for (const part of this.parts) part.update(scene);
        this.background.set(scene.background.kind);
        this.color.root.hidden = scene.background.kind !== "color";
        this.color.set(hex_of(scene.background.color));
        this.tone.set(scene.tonemap);
        this.detail.set(String(this.#app.detail));
    }
}

/// The seed: a number without a slider, as neighbours have nothing in common.
function setting_seed(app) {
    const made = slider("Seed", { low: 0, high: 100, step: 1, help: app.settings.help("seed"), allowed: (v) => Math.max(0, Math.round(v)) },
        (value) => app.state.edit("seed", (scene) => (scene.seed = value)));
    return { root: made.root, update: (scene) => made.set(scene.seed ?? 0) };
}

/// Standard views, projection, trackball, and what is drawn over the picture.
export class ViewPanel {
    #app;

    constructor(app) {
        this.#app = app;
        this.views = row();
        this.orthographic = checkbox("Parallel projection (5)", (on) => app.set_orthographic(on));
        this.trackball = checkbox("Free trackball (K)", (on) => app.set_trackball(on), "Off keeps the horizon level");
        this.fov_place = element("div");
        this.overlays = Object.entries(overlay_names).map(([name, label]) => [name, checkbox(label, (on) => app.show_overlay(name, on))]);
        this.root = section("View", false, this.views, this.orthographic.root, this.trackball.root, this.fov_place,
            element("fieldset", { class: "checks" }, element("legend", {}, "Over the picture"), ...this.overlays.map(([, c]) => c.root)));
    }

    load() {
        const app = this.#app, anatomical = app.volume.anatomical;
        const views = [["1", "Front"], ["3", anatomical ? "Left" : "Side"], ["7", "Top"], ["9", "Opposite"]];
        this.views.replaceChildren(...views.map(([key, text]) => button(text, () => show_standard_view(app, key), { title: `Key ${key}` })),
            button("Reset", () => app.reset_view(), { title: "Key R" }));
        const options = slider_options(app.settings, "camera.fov", { unit: "°" });
        this.fov = slider("Field of view", options, (fov) => app.move_camera("camera.fov", (camera) => with_fov(camera, fov)));
        this.fov_place.replaceChildren(this.fov.root);
    }

    update() {
        const { camera, trackball } = this.#app;
        this.orthographic.set(camera.orthographic);
        this.trackball.set(trackball);
        this.fov.set(camera.fov);
        this.fov.root.hidden = camera.orthographic;
        for (const [name, box] of this.overlays) box.set(this.#app.overlays[name]);
    }
}

/// The time step of a 4-D volume; hidden for others. The server reads the newest that was asked for, which may take a while.
export class TimePanel {
    #app;
    #steps = 0;

    constructor(app) {
        this.#app = app;
        this.place = element("div");
        this.root = section("Time", true, this.place);
    }

    load() {
        const { time_steps, time_step } = this.#app.volume;
        this.root.hidden = !(time_steps > 1);
        if (this.root.hidden) return;
        if (this.#steps !== time_steps) this.#build(time_steps);
        if (!this.step.root.matches(":active")) this.step.set(time_step); // a dragged slider stays where it is
    }

    update() {}

    #build(steps) {
        const last = steps - 1, allowed = (step) => clamp(Math.round(step), 0, last);
        const go = (step) => this.#app.connection.send({ type: "time_step", step });
        const by = (count) => () => go(allowed(this.#app.volume.time_step + count));
        this.#steps = steps;
        this.step = slider("Step", { low: 0, high: last, step: 1, allowed, help: `0 to ${last}` }, go);
        this.place.replaceChildren(this.step.root, row(button("‹ Before", by(-1)), button("Next ›", by(1))));
    }
}
