// The section of light and material: environment, key light, headlight, shading, phase.
import { button, choice, element, file_input, row, section } from "./controls.js";
import { LightSphere } from "./light_sphere.js";
import { setting_slider } from "./settings.js";

const largest_upload = 64 << 20;

export class LightPanel {
    #app;

    constructor(app) {
        this.#app = app;
        this.sphere = new LightSphere(app);
        const surroundings = [["sky", "Sky"], ["constant", "Even light"], ["image", "Picture…"]];
        this.environment = choice("Surroundings", surroundings, (kind) => this.#choose(kind));
        this.file = file_input("Picture of the surroundings", ".hdr,.exr", (file) => this.#upload(file));
        this.name = element("span", { class: "note" });
        this.upload_row = row(button("Another picture…", () => this.file.open()), this.name);
        this.sliders = element("div");
        this.sources = element("div");
        const shadings = [["auto", "Automatic"], ["gradient", "Like surfaces"], ["phase", "Like fog"]];
        this.shading = choice("Shading", shadings, (value) => app.state.edit(null, (scene) => (scene.shading = value)),
            "Surfaces where values change, fog where they do not; or one of them everywhere");
        this.material = element("div");
        this.root = section("Light and material", false, this.environment.root, this.file.root, this.upload_row,
            element("div", { class: "sphere-row" }, this.sphere.root, this.sliders), this.sources, this.shading.root, this.material);
        this.root.addEventListener("toggle", () => this.root.open && app.state.scene && this.sphere.draw());
    }

    /// After hello: sliders from the server's settings.
    load() {
        const app = this.#app;
        const made = (label, key) => setting_slider(app, label, key);
        this.rotation = made("Turned by", "light.image_rotation");
        this.parts = [made("Brightness", "light.level"), made("Key light", "light.key"), made("Headlight", "light.headlight"), this.rotation];
        this.directions = [made("From the side", "light.key_azimuth"), made("Height", "light.key_elevation"), made("Softness", "light.key_angle")];
        this.sliders.replaceChildren(...this.directions.map((s) => s.root));
        this.phase = made("Scattering", "phase_g");
        this.material.replaceChildren(this.phase.root);
        this.sources.replaceChildren(...this.parts.map((s) => s.root));
    }

    update() {
        const { scene } = this.#app.state;
        this.environment.set(scene.light.environment);
        this.upload_row.hidden = scene.light.environment !== "image";
        this.rotation.root.hidden = scene.light.environment !== "image";
        this.shading.set(scene.shading);
        for (const s of [...this.parts, ...this.directions, this.phase]) s.update(scene);
        if (this.root.open) this.sphere.draw();
    }

    #choose(kind) {
        if (kind === "image") {
            this.environment.set(this.#app.state.scene.light.environment);
            this.file.open();
            return;
        }
        this.#app.state.edit(null, (scene) => Object.assign(scene.light, { environment: kind, image: "" }));
    }

    async #upload(file) {
        try {
            if (file.size > largest_upload) throw new Error(`${file.name} is larger than 64 MiB.`);
            this.#app.messages.show(`Sending ${file.name} …`, { level: "info", key: "upload", stays: true });
            const answer = await this.#app.connection.fetch(`./environment?name=${encodeURIComponent(file.name)}`, { method: "POST", body: file });
            const { environment, name } = await answer.json();
            this.name.textContent = name;
            this.#app.state.edit(null, (scene) => Object.assign(scene.light, { environment: "image", image: environment }));
        } catch (error) {
            this.#app.messages.show(error.message);
        }
        this.#app.messages.clear("upload");
    }
}
