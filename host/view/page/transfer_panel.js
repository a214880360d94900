// The section of the transfer function: presets with words, the editor, the selected knot typed, files.
import { css_of, hex_of, linear_of } from "./color.js";
import { button, checkbox, color_field, element, file_input, number_field, row, section, slider } from "./controls.js";
import { diagonal } from "./geometry.js";
import { TransferEditor } from "./transfer_editor.js";
import { at, physical, shows_something, span, with_changed_knot } from "./transfer_function.js";

const automatic_name = "auto"; // as the server calls it, also in saved scenes
const words_for_editor =
    "Transfer function: opacity over the histogram of values. Arrow keys move the selected knot, Page Up and Page Down select, " +
    "Insert adds, Delete removes.";
const longest_file = 60000; // a message has at most 64 KiB

export class TransferPanel {
    #app;
    #editor;
    #canvas;
    #presets = element("div", { class: "presets", role: "group", "aria-label": "Presets" });
    #buttons = []; // {root, preset}
    #density_place = element("div");
    #set_density = () => {};
    #shown = null; // the transfer function that the editor has

    /// app: {state, connection, messages, hello, volume, automatic, save(what)}
    constructor(app) {
        this.#app = app;
        this.#canvas = element("canvas", { class: "transfer", tabindex: "0", role: "application", "aria-label": words_for_editor });
        this.#editor = new TransferEditor(this.#canvas, {
            edit: (key, transfer) => this.edit(key, transfer),
            held: (is_held) => app.state.held(is_held),
            drop: () => app.state.drop(),
            selected: () => this.#show_knot(),
        });
        this.root = section("Transfer function", true, this.#presets, this.#canvas, this.#density_place, this.#knot_fields(), this.#file_row());
        this.root.addEventListener("toggle", () => this.#editor.draw());
    }

    /// The transfer function of the scene over physical values, for editing.
    current() {
        return physical(this.#app.state.scene.transfer ?? this.#app.automatic, this.#app.volume.range);
    }

    edit(key, transfer) {
        const named = key === null || !transfer.name || transfer.name.endsWith("(changed)") ? transfer.name : `${transfer.name} (changed)`;
        this.#app.state.edit(key, (scene) => (scene.transfer = { ...transfer, name: named }));
    }

    /// After hello, and for another volume: presets that show nothing of this volume come last.
    load() {
        const { presets } = this.#app.hello, { volume, automatic } = this.#app;
        const is_ct = volume.unit === "HU";
        const shows = ({ transfer }) => shows_something(physical(transfer, volume.range), volume.range);
        const fits = (p) => (p.transfer.domain === "normalized" || is_ct) && shows(p);
        const for_this = (p) => is_ct === (p.transfer.domain === "physical");
        const order = (p) => (fits(p) ? (for_this(p) ? 0 : 1) : 2);
        const sorted = presets.map((p) => ({ ...p, fits: fits(p) })).sort((a, b) => order(a) - order(b));
        const all = [{ name: "Automatic", description: "Background vanishes, structure shows", transfer: null, fits: true }, ...sorted];
        this.#buttons = all.map((preset) => ({ preset, root: this.#preset_button(preset, preset.transfer ?? automatic) }));
        this.#presets.replaceChildren(...this.#buttons.map((b) => b.root));
        this.#density_place.replaceChildren(this.#density_slider(512 / diagonal(volume)));
    }

    /// How dense opacity 1 is; 0 in the scene stands for the usual density.
    #density_slider(usual) {
        const { settings, state } = this.#app;
        const options = {
            low: usual / 100, high: usual * 20, logarithmic: true, unit: "1/mm", usual: 0,
            help: settings.help("extinction"), allowed: (value) => settings.allowed("extinction", value),
        };
        const density = slider("Density", options, (value) => state.edit("extinction", (scene) => (scene.extinction = value)));
        this.#set_density = (extinction) => density.set(extinction || usual);
        return density.root;
    }

    #preset_button(preset, transfer) {
        const swatch = element("canvas", { class: "swatch", width: 44, height: 24, "aria-hidden": "true" });
        draw_swatch(swatch, physical(transfer, this.#app.volume.range), this.#app.volume.range);
        const full = preset.fits ? preset.description : `${preset.description} (nothing of this volume lies in its values)`;
        const words = preset.description.replace(/^[^:]*: /, ""); // "CT in Hounsfield units: bone alone, ivory"
        const attributes = { class: preset.fits ? "preset" : "preset misfit", title: full, "aria-pressed": "false" };
        return element("button", { type: "button", onclick: () => this.#choose(preset), ...attributes },
            swatch, element("span", { class: "preset-name" }, preset.name), element("span", { class: "preset-words" }, words));
    }

    #choose(preset) {
        this.#app.state.edit(null, (scene) => {
            if (preset.transfer) scene.transfer = structuredClone(preset.transfer);
            else delete scene.transfer;
        });
        this.#editor.fit();
    }

    #knot_fields() {
        const change = (what) => this.edit("transfer.typed", with_changed_knot(this.current(), this.#editor.selected, what));
        this.value = number_field("Value", (value) => change({ value }));
        this.unit = element("span", { class: "unit" });
        this.value.root.append(this.unit);
        this.opacity = number_field("Opacity", (opacity) => change({ opacity }), { step: "0.01" });
        this.color = color_field("Colour", (hex) => change({ color: linear_of(hex) }));
        this.which = element("output", { class: "which" });
        this.remove = button("Remove", () => this.#editor.remove_selected());
        return element("fieldset", { class: "knot" }, element("legend", {}, "Selected knot"),
            row(button("‹", () => this.#editor.select(this.#editor.selected - 1), { "aria-label": "Previous knot" }), this.which,
                button("›", () => this.#editor.select(this.#editor.selected + 1), { "aria-label": "Next knot" }), this.remove),
            row(this.value.root, this.opacity.root, this.color.root));
    }

    #file_row() {
        const file = file_input("Transfer function file", ".json,application/json", (chosen) => this.#load(chosen));
        const spread = checkbox("More room for low opacities", (on) => {
            this.#editor.spread = on;
            this.#editor.draw();
        });
        const load = button("Load file…", () => file.open(), { title: "A JSON file of clvr or of ParaView" });
        const fit = button("Fit axis", () => this.#editor.fit(), { title: "Shows the whole range of values (double click)" });
        return element("div", {}, spread.root, row(load, button("Save file", () => this.#app.save("transfer")), fit), file.root);
    }

    async #load(file) {
        try {
            if (file.size > longest_file) throw new Error(`${file.name} has ${file.size} bytes; a transfer function has at most ${longest_file}.`);
            const answer = await this.#app.connection.request({ type: "transfer_text", text: await file.text() });
            this.#app.state.edit(null, (scene) => (scene.transfer = { ...answer.transfer, name: file.name.replace(/\.json$/i, "") }));
            this.#editor.fit();
        } catch (error) {
            this.#app.messages.show(error.message);
        }
    }

    /// After each change of the scene.
    update() {
        const { scene } = this.#app.state, { volume } = this.#app;
        this.#set_density(scene.extinction);
        const key = JSON.stringify([scene.transfer ?? null, volume.range]);
        if (key === this.#shown) return;
        this.#shown = key;
        this.#editor.set(this.current(), volume);
        const name = scene.transfer?.name ?? automatic_name;
        for (const { root, preset } of this.#buttons) {
            const holds = name === (preset.transfer ? preset.name : automatic_name);
            root.setAttribute("aria-pressed", String(holds));
        }
        this.#show_knot();
    }

    redraw() {
        this.#editor.draw();
    }

    #show_knot() {
        const { points } = this.current(), knot = points[this.#editor.selected];
        if (!knot) return;
        this.which.textContent = `${this.#editor.selected + 1} of ${points.length}`;
        this.value.set(knot.value);
        this.unit.textContent = this.#app.volume.unit;
        this.opacity.set(knot.opacity);
        this.color.set(hex_of(knot.color));
        this.remove.disabled = points.length < 2;
    }
}

/// A preset at a glance: its colours, as high as they are opaque.
function draw_swatch(canvas, transfer, range) {
    const context = canvas.getContext("2d"), [first, last] = span(transfer);
    const low = Math.max(first, range[0]), high = Math.min(last, range[1]);
    const [from, to] = low < high ? [low, high] : [first, last];
    for (let x = 0; x < canvas.width; ++x) {
        const here = at(transfer, from + ((x + 0.5) / canvas.width) * (to - from));
        const height = canvas.height * (0.15 + 0.85 * here.opacity);
        context.fillStyle = css_of(here.color);
        context.fillRect(x, canvas.height - height, 1, height);
    }
}
