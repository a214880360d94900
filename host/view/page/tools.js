// What a drag in the picture does. A drag is {step(dx, dy, event)} for movements since the last event, or {total(dx, dy)} for those since
// its start, in CSS pixels.
import { orbit, pan } from "./camera.js";
import { clip_drag } from "./clip_handles.js";
import { window_step } from "./window_level.js";

const turn_per_height = 220; // degrees

/// The tools, by name: {text, key, help}.
export const tools = {
    turn: { text: "Turn", help: "Drag turns the volume" },
    window: {
        text: "Window and level (W)",
        help: "Drag up or down shifts the transfer function, left or right widens it; with Ctrl its opacity; with Shift finely",
    },
    light: { text: "Light (L)", help: "Drag moves the key light" },
};

/// A drag of one kind: a tool's name or "pan".
export function drag_of(app, kind) {
    const height = app.frame().height, degrees = (pixels) => (pixels / height) * turn_per_height;
    const kinds = {
        turn: (dx, dy) => app.move_camera("orbit", (camera) => orbit(camera, degrees(dx), degrees(dy), app.trackball)),
        pan: (dx, dy) => app.move_camera("pan", (camera) => pan(camera, dx / height, dy / height)),
        light: (dx, dy) => app.turn_light(degrees(dx), degrees(-dy)),
        window: (dx, dy, event) => window_step(app, dx, dy, height, event),
    };
    return { step: kinds[kind] };
}

/// What one finger, or the left button, drags at a place of the stage: a handle there, else what the tool says.
export function drag_at(app, x, y, pointer_type) {
    const frame = app.frame();
    return clip_drag(app, x - frame.x, y - frame.y, frame.width, frame.height, pointer_type) ?? drag_of(app, app.tool);
}

/// Follows a drag from a place of the stage; move(x, y, event) continues it.
export function follow(drag, x, y) {
    let last = [x, y];
    return (to_x, to_y, event) => {
        if (drag.total) drag.total(to_x - x, to_y - y);
        else drag.step(to_x - last[0], to_y - last[1], event);
        last = [to_x, to_y];
    };
}
