// Saving: stills, turntables, scenes and transfer functions are rendered by the server at their own size and samples, and then downloaded.
import { button, checkbox, choice, element, file_input, number_field, row, section, segments } from "./controls.js";
import { draw_overlays } from "./overlays.js";
import { clamp } from "./vectors.js";

const longest_scene = 60000; // a message has at most 64 KiB
const finished = new Set(["done", "failed", "cancelled"]);
const words = { waiting: "waiting", running: "rendering", done: "ready", failed: "failed", cancelled: "cancelled" };

export class SavePanel {
    #app;
    #rows = new Map(); // job -> {root, words, bar, actions}
    #expected = []; // what this page asked for and the server has not named yet: {what, overlays, id}
    #own = new Map(); // job -> overlays to draw, or null
    #chosen = { what: "still", width: null, height: null, samples: null, views: 72, format: "png", overlays: false };

    constructor(app) {
        this.#app = app;
        const chosen = this.#chosen;
        const change = (key) => (value) => {
            chosen[key] = value;
            this.update();
        };
        this.what = segments("What to save", [["still", "Picture"], ["turntable", "Turntable"]], change("what"));
        this.width = number_field("Width", change("width"), { unit: "px", step: "1" });
        this.height = number_field("Height", change("height"), { unit: "px", step: "1" });
        this.samples = number_field("Samples", change("samples"), { step: "1" });
        this.views = number_field("Views", change("views"), { step: "1", title: "Pictures around the volume" });
        this.format = choice("Format", [["png", "PNG"], ["jpg", "JPEG"], ["exr", "OpenEXR, all channels"]], change("format"));
        this.overlays = checkbox("With scale bar, orientation, …", change("overlays"), "What is shown over the picture, drawn into it");
        this.jobs = element("ul", { class: "jobs", "aria-label": "Saves" });
        this.file = file_input("Scene file", ".json,application/json", (file) => this.#load_scene(file));
        this.go = button("Save picture", () => this.save(chosen.what), { class: "primary" });
        this.load_button = button("Load scene…", () => this.file.open());
        const save_scene = button("Save scene", () => this.save("scene"), { title: "Everything that makes this picture, for clvr render" });
        this.root = section("Save", false, this.what.root, row(this.width.root, this.height.root), row(this.samples.root, this.views.root),
            this.format.root, this.overlays.root,
            row(this.go, button("Use window size", () => this.#as_window(), { title: "Size and samples of the picture on screen" })), this.jobs,
            row(save_scene, this.load_button), this.file.root);
    }

    load() {
        for (const job of this.#app.hello.jobs ?? []) this.job(job);
    }

    update() {
        const chosen = this.#chosen, { state, hello } = this.#app, side = hello.limits?.side ?? 4096;
        const whole = (value, most) => clamp(Math.round(value), 1, most);
        this.wanted = {
            width: whole(chosen.width ?? state.size.width, side),
            height: whole(chosen.height ?? state.size.height, side),
            samples: whole(chosen.samples ?? state.scene.spp, hello.limits?.samples ?? 1 << 20),
            views: whole(chosen.views, hello.limits?.views ?? 720),
        };
        for (const key of ["width", "height", "samples", "views"]) this[key].set(this.wanted[key]);
        this.what.set(chosen.what);
        const still = chosen.what === "still";
        this.views.root.hidden = still;
        this.format.root.hidden = !still;
        this.format.set(chosen.format);
        this.overlays.root.hidden = !still || chosen.format === "exr";
        this.overlays.set(chosen.overlays);
        this.go.textContent = still ? "Save picture" : "Save turntable";
    }

    #as_window() {
        Object.assign(this.#chosen, { width: null, height: null, samples: null });
        this.update();
    }

    /// Asks the server for a still, turntable, scene or transfer function.
    save(what) {
        const { app, chosen } = { app: this.#app, chosen: this.#chosen }, { width, height, samples, views } = this.wanted;
        const picture = what === "still" || what === "turntable";
        const asked = { type: "save", what };
        if (picture) Object.assign(asked, { format: what === "still" ? chosen.format : "png", width, height, samples });
        if (what === "turntable") asked.views = views;
        const drawn_over = what === "still" && chosen.overlays && chosen.format !== "exr";
        const overlays = drawn_over ? { ...app.overlay_facts(), status: `${samples} samples` } : null;
        if (!app.connection.is_open) app.messages.show("Nothing can be saved without a connection to clvr.");
        else this.#expected.push({ what, overlays, id: app.connection.send_with_id(asked) });
    }

    /// The server does not do what the message of this id asked for.
    refused(id) {
        this.#expected = this.#expected.filter((e) => e.id !== id);
    }

    /// A job's news from the server. What this page asked for is downloaded when it is ready.
    job(job) {
        if (!this.#rows.has(job.job)) this.#add(job);
        this.#take(job);
        const shown = this.#rows.get(job.job), before = shown.state;
        shown.state = job.state;
        shown.words.textContent = `${job.name || job.what}: ${words[job.state] ?? job.state}${describe(job)}`;
        shown.bar.hidden = finished.has(job.state);
        shown.bar.value = job.progress ?? 0;
        if (before === job.state) return;
        shown.actions.replaceChildren(...this.#actions(job, shown.root));
        if (job.state === "failed" && this.#own.has(job.job)) this.#app.messages.show(`${job.name || job.what} could not be saved: ${job.message}`);
        if (job.state === "done" && this.#own.has(job.job)) this.#download(job);
    }

    #actions(job, root) {
        if (!finished.has(job.state)) return [button("Cancel", () => this.#app.connection.send({ type: "cancel", job: job.job }))];
        const remove = button("×", () => root.remove(), { "aria-label": "Remove from the list" });
        return job.state === "done" ? [button("Download", () => this.#download(job)), remove] : [remove];
    }

    #add(job) {
        const bar = element("progress", { max: 1, "aria-label": "Progress" });
        const parts = { words: element("span", { role: "status" }), bar, actions: element("span", { class: "actions" }) };
        const root = element("li", {}, parts.words, parts.bar, parts.actions);
        this.#rows.set(job.job, { root, ...parts, state: null });
        this.jobs.prepend(root);
    }

    /// The first news of what this page asked for has the id of its message.
    #take(job) {
        const asked = this.#expected.find((e) => e.id === job.id);
        if (!asked) return;
        this.#expected = this.#expected.filter((e) => e !== asked);
        this.#own.set(job.job, asked.overlays);
        if (asked.what !== "transfer") this.root.open = true;
    }

    async #download(job) {
        try {
            const answer = await this.#app.connection.fetch(job.url);
            let blob = await answer.blob();
            const overlays = this.#own.get(job.job);
            if (overlays) blob = await with_overlays(blob, job.name.endsWith(".png") ? "image/png" : "image/jpeg", overlays);
            const url = URL.createObjectURL(blob);
            element("a", { href: url, download: job.name || job.url.split("/").pop() }).click();
            setTimeout(() => URL.revokeObjectURL(url), 60000);
        } catch (error) {
            this.#app.messages.show(`The download failed: ${error.message}`);
        }
    }

    async #load_scene(file) {
        try {
            if (file.size > longest_scene) throw new Error(`${file.name} has ${file.size} bytes; a scene has at most ${longest_scene}.`);
            this.#app.load_scene(await file.text());
        } catch (error) {
            this.#app.messages.show(error.message);
        }
    }
}

const describe = ({ state, samples, message }) => (message ? `, ${message}` : state === "running" && samples > 0 ? `, ${samples} samples` : "");

/// A still with the overlays drawn into it, as large as they would be in a window 800 pixels high.
async function with_overlays(blob, type, facts) {
    const bitmap = await createImageBitmap(blob), { width, height } = bitmap;
    const canvas = new OffscreenCanvas(width, height), context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    draw_overlays(context, { ...facts, x: 0, y: 0, width, height, pixel: Math.max(0.5, Math.min(width, height) / 800) });
    return canvas.convertToBlob({ type, quality: 0.95 });
}
