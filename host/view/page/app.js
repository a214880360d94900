// What the parts of the page share: the scene and its camera, the server's facts, the picture's place on the stage, and the actions that
// several of them offer.
import { angles, fitted, framed, look_from, orbit, point_at_target, with_projection, zoom_around } from "./camera.js";
import { corners, diagonal, whole_box } from "./geometry.js";
import { add, clamp, subtract } from "./vectors.js";

const remembered = (key, otherwise) => JSON.parse(localStorage.getItem(`clvr.${key}`) ?? JSON.stringify(otherwise));
const remember = (key, value) => localStorage.setItem(`clvr.${key}`, JSON.stringify(value));

export class App {
    hello = null;
    volume = null;
    automatic = null;
    can_control = false;
    trackball = false;
    tool = "turn";
    status = "";
    home = null; // {camera, aspect}: the view that the server framed, or null
    overlays = remembered("overlays", { scale: true, axes: true, colors: true, samples: true });
    detail = remembered("detail", 1);
    panel_open = remembered("panel", true);

    constructor(parts) {
        Object.assign(this, parts); // state, connection, messages, settings, picture, stage
        this.changed = () => {}; // set by main.js: shows the state of buttons and fields again
        this.redraw = () => {};
    }

    get camera() {
        return this.state.scene.camera;
    }
    get aspect() {
        return this.state.size.width / this.state.size.height;
    }

    /// Where the picture lies on the stage [CSS pixels].
    frame() {
        const { shown, ratio } = this.picture, { size } = this.state;
        const at = this.picture.place(shown?.full_width ?? size.width, shown?.full_height ?? size.height);
        return { x: at.x / ratio, y: at.y / ratio, width: at.width / ratio, height: at.height / ratio };
    }

    /// Changes the camera by move(camera). Azimuth and elevation follow, as lights turn with them where the view is vertical.
    move_camera(key, move) {
        this.state.edit(key, (scene) => {
            const camera = move(scene.camera), { azimuth, elevation } = angles(camera);
            scene.camera = { ...camera, azimuth, elevation };
        });
    }

    angles() {
        return angles(this.camera);
    }

    look_from(azimuth, elevation) {
        this.move_camera(null, (camera) => look_from(camera, azimuth, elevation));
    }

    zoom(factor) {
        this.move_camera("zoom", (camera) => zoom_around(camera, factor, camera.target, this.#zoom_limits()));
    }

    /// Towards a place of the stage.
    zoom_at(factor, x, y) {
        const at = this.#shares(x, y);
        this.move_camera("zoom", (camera) => zoom_around(camera, factor, point_at_target(camera, at.x, at.y, this.aspect), this.#zoom_limits()));
    }

    #zoom_limits() {
        const size = diagonal(this.volume);
        return [size * 1e-4, size * 20];
    }

    #shares(x, y) {
        const frame = this.frame();
        return { x: (x - frame.x) / frame.width, y: (y - frame.y) / frame.height };
    }

    /// What lies there becomes the target, in the middle of the picture.
    async focus_at(x, y) {
        const at = this.#shares(x, y);
        if (at.x < 0 || at.x > 1 || at.y < 0 || at.y > 1) return;
        try {
            const { position } = await this.connection.request({ type: "pick", x: at.x, y: at.y });
            if (!position) return;
            this.move_camera(null, (camera) => {
                const by = subtract(position, camera.target);
                return { ...camera, target: position, eye: add(camera.eye, by) };
            });
        } catch (error) {
            this.messages.show(error.message);
        }
    }

    /// The server's framing of what is visible, else all of the volume.
    reset_view() {
        const { home, aspect, volume } = this;
        const whole = (camera) => framed(camera, corners(volume, whole_box), aspect, 30, 12);
        this.move_camera(null, home ? () => fitted(home.camera, home.aspect, aspect) : whole);
    }

    set_orthographic(on) {
        this.move_camera(null, (camera) => with_projection(camera, on, diagonal(this.volume)));
    }

    set_trackball(on) {
        this.trackball = on;
        this.messages.show(on ? "Free trackball: K levels the horizon again." : "The horizon stays level.", { level: "info", key: "trackball" });
        if (!on) this.move_camera(null, (camera) => orbit(camera, 0, 0, false));
        this.changed();
    }

    turn_light(to_right, upwards) {
        this.state.edit("light.drag", ({ light }) => {
            light.key_azimuth = ((((light.key_azimuth + to_right + 180) % 360) + 360) % 360) - 180;
            light.key_elevation = clamp(light.key_elevation + upwards, -90, 90);
        });
    }

    choose_tool(tool) {
        this.tool = tool;
        this.stage.dataset.tool = tool;
        this.changed();
    }

    show_overlay(name, on) {
        this.overlays = { ...this.overlays, [name]: on };
        remember("overlays", this.overlays);
        this.redraw();
    }

    /// The picture's size as a share of the screen's pixels.
    set_detail(share) {
        this.detail = share;
        remember("detail", share);
        this.fit_window();
    }

    toggle_panel() {
        this.panel_open = !this.panel_open;
        remember("panel", this.panel_open);
        this.changed();
    }

    /// What draw_overlays needs to know.
    overlay_facts() {
        const { camera, volume, automatic, status, overlays } = this;
        return { camera, scene: this.state.scene, volume, automatic, status, shown: overlays };
    }

    /// The server answers all with the scene, or refuses.
    load_scene(text) {
        this.connection.send_with_id({ type: "scene_text", text });
    }
}
