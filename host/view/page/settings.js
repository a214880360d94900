// The plain settings of a scene as the server lists them: ranges, defaults and help. Sliders also need a comfortable span where a setting
// has no bounds, or bounds that nobody uses.
import { slider } from "./controls.js";
import { clamp } from "./vectors.js";

const spans = {
    "camera.fov": [5, 100],
    "light.level": [0, 4],
    "light.image_rotation": [-180, 180],
    "light.key": [0, 4],
    "light.key_azimuth": [-180, 180],
    "light.headlight": [0, 4],
    "phase_g": [-0.95, 0.95],
    "bounces": [0, 32],
    "exposure": [-5, 5],
};
const whole_numbers = new Set(["width", "height", "spp", "bounces", "seed", "view", "feature_samples"]);

const finite = (x) => (typeof x === "number" && Math.abs(x) < 1e300 ? x : null);

export class Settings {
    #by_key = new Map();

    /// list: the member `settings` of the server's hello.
    load(list) {
        this.#by_key = new Map(list.map((s) => [s.key, s]));
    }

    help(key) {
        return this.#by_key.get(key)?.help ?? "";
    }

    default_of(key) {
        return this.#by_key.get(key)?.default;
    }

    /// {low, high, step, whole}: what a slider covers.
    span(key) {
        const { least, most } = this.range(key), whole = whole_numbers.has(key);
        const [low, high] = spans[key] ?? [least, most];
        const inside = [Math.max(low, least), Math.min(high, most)];
        return { low: inside[0], high: inside[1], whole, step: whole ? 1 : (inside[1] - inside[0]) / 500 };
    }

    /// {least, most, outside}: what may be typed; infinite where there is no bound. `outside`: the ends themselves may not.
    range(key) {
        const setting = this.#by_key.get(key);
        return { least: finite(setting?.low) ?? -Infinity, most: finite(setting?.high) ?? Infinity, outside: setting?.ends === "outside" };
    }

    /// The nearest value that the server takes.
    allowed(key, value) {
        const { least, most, outside } = this.range(key);
        const gap = outside ? 1e-3 : 0;
        const inside = clamp(value, least + gap, most - gap);
        return whole_numbers.has(key) ? Math.round(inside) : inside;
    }
}

/// The value of "camera.fov" in a scene, and its setter.
function get(scene, key) {
    return key.split(".").reduce((from, name) => from?.[name], scene);
}
function set(scene, key, value) {
    const names = key.split("."), last = names.pop();
    names.reduce((from, name) => (from[name] ??= {}), scene)[last] = value;
}

/// What a slider of a setting needs to know (controls.js).
export function slider_options(settings, key, { logarithmic = false, unit = "", most = Infinity } = {}) {
    const { low, high, step } = settings.span(key), usual = settings.default_of(key);
    const allowed = (value) => settings.allowed(key, value);
    return { low, high: Math.min(high, most), step, logarithmic, unit, usual, allowed, help: settings.help(key) };
}

/// A slider of a plain setting of the scene: {root, update(scene)}.
export function setting_slider(app, label, key, shape = {}) {
    const options = slider_options(app.settings, key, shape);
    const made = slider(label, options, (value) => app.state.edit(key, (scene) => set(scene, key, value)));
    return { root: made.root, update: (scene) => made.set(get(scene, key) ?? app.settings.default_of(key)) };
}
