// A little sphere, lit as the key light lights the scene; dragging on it moves the light. Keys do the same by the sliders beside it.
import { angles, frame } from "./camera.js";
import { element } from "./controls.js";
import { add, clamp, direction, inner, radian, scale, unit } from "./vectors.js";

const side = 92; // [CSS pixels]

/// Unit direction to the key light in the world; its azimuth is relative to the camera's.
const key_direction = (camera, light) => direction(angles(camera).azimuth + light.key_azimuth, light.key_elevation);

/// key_azimuth and key_elevation of a direction in the world [degrees].
function key_angles(camera, to_light) {
    const azimuth = Math.atan2(to_light[0], -to_light[1]) / radian - angles(camera).azimuth;
    return { key_azimuth: ((((azimuth + 180) % 360) + 360) % 360) - 180, key_elevation: Math.asin(clamp(to_light[2], -1, 1)) / radian };
}

export class LightSphere {
    #app;
    #canvas;

    constructor(app) {
        this.#app = app;
        this.#canvas = element("canvas", { class: "sphere", "aria-hidden": "true", title: "Drag: where the key light comes from" });
        this.#canvas.addEventListener("pointerdown", (event) => {
            this.#canvas.setPointerCapture(event.pointerId);
            app.state.held(true);
            this.#take(event);
        });
        this.#canvas.addEventListener("pointermove", (event) => event.buttons && this.#take(event));
        this.#canvas.addEventListener("pointerup", () => app.state.held(false));
        this.root = this.#canvas;
    }

    #take(event) {
        const radius = side / 2 - 4, x = (event.offsetX - side / 2) / radius, y = -(event.offsetY - side / 2) / radius;
        const far = Math.hypot(x, y), rim = far > 0.999 ? 0.999 / far : 1;
        const { right, up, forward } = frame(this.#app.camera), z = Math.sqrt(Math.max(0, 1 - (x * rim) ** 2 - (y * rim) ** 2));
        const to_light = unit(add(add(scale(right, x * rim), scale(up, y * rim)), scale(forward, -z)));
        this.#app.state.edit("light.sphere", (scene) => Object.assign(scene.light, key_angles(this.#app.camera, to_light)));
    }

    draw() {
        const canvas = this.#canvas, pixels = Math.round(side * devicePixelRatio);
        canvas.width = canvas.height = pixels;
        const context = canvas.getContext("2d"), { right, up, forward } = frame(this.#app.camera);
        const d = key_direction(this.#app.camera, this.#app.state.scene.light);
        const light = [inner(d, right), inner(d, up), -inner(d, forward)];
        context.putImageData(shaded(pixels, 4 * devicePixelRatio, light), 0, 0);
        this.#draw_dot(context, light);
    }

    #draw_dot(context, light) {
        const radius = side / 2 - 4;
        context.scale(devicePixelRatio, devicePixelRatio);
        context.beginPath();
        context.arc(side / 2 + light[0] * radius, side / 2 - light[1] * radius, 5, 0, 2 * Math.PI);
        context.fillStyle = light[2] >= 0 ? "#ffd166" : "transparent"; // hollow: behind
        context.fill();
        context.lineWidth = 2;
        context.strokeStyle = light[2] >= 0 ? "#4a3500" : "#ffd166";
        context.stroke();
    }
}

/// A white Lambert sphere in the light of a direction {right, up, to the viewer}.
function shaded(pixels, rim, light) {
    const image = new ImageData(pixels, pixels), radius = pixels / 2 - rim;
    for (let j = 0; j < pixels; ++j)
        for (let i = 0; i < pixels; ++i) {
            const x = (i + 0.5 - pixels / 2) / radius, y = (pixels / 2 - j - 0.5) / radius, square = x * x + y * y;
            const facing = x * light[0] + y * light[1] + Math.sqrt(Math.max(0, 1 - square)) * light[2], o = 4 * (j * pixels + i);
            const shade = 0.16 + 0.84 * Math.max(0, facing);
            image.data.fill(255 * Math.sqrt(shade) * 0.95, o, o + 3);
            image.data[o + 3] = 255 * clamp((1 - Math.sqrt(square)) * radius + 0.5, 0, 1);
        }
    return image;
}
