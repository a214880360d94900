// Fingers in the picture: one uses the tool (turns, at first), two pan and pinch, a double tap focuses.
import { drag_at, drag_of, follow } from "./tools.js";

const tap_px = 10, tap_ms = 300, double_tap_px = 40, double_tap_ms = 400;

export function listen_to_touch(app, surface) {
    const fingers = new Map(); // pointerId -> {x, y}
    let drag = null, pinch = null, tap = null, last_tap = null;
    const only_touch = (handler) => (event) => event.pointerType === "touch" && app.can_control && handler(event);

    surface.addEventListener("pointerdown", only_touch((event) => {
        event.preventDefault();
        surface.setPointerCapture(event.pointerId);
        fingers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
        app.state.held(true);
        if (fingers.size === 1) {
            tap = { x: event.offsetX, y: event.offsetY, time: event.timeStamp };
            drag = follow(drag_at(app, event.offsetX, event.offsetY, "touch"), event.offsetX, event.offsetY);
        } else {
            drag = tap = null;
            pinch = begin_pinch();
        }
    }));

    surface.addEventListener("pointermove", only_touch((event) => {
        const finger = fingers.get(event.pointerId);
        if (!finger) return;
        if (tap && Math.hypot(event.offsetX - tap.x, event.offsetY - tap.y) > tap_px) tap = null;
        Object.assign(finger, { x: event.offsetX, y: event.offsetY });
        if (pinch) move_pinch();
        else if (drag && !tap) drag(event.offsetX, event.offsetY, event);
    }));

    const lift = only_touch((event) => {
        if (!fingers.delete(event.pointerId)) return;
        pinch = drag = null; // a finger that stays does not jump into another gesture
        if (fingers.size > 0) return;
        app.state.held(false);
        if (event.type === "pointerup" && tap && event.timeStamp - tap.time < tap_ms) tapped(event);
        tap = null;
    });
    surface.addEventListener("pointerup", lift);
    surface.addEventListener("pointercancel", lift);

    function tapped(event) {
        const near = (tap) => Math.hypot(event.offsetX - tap.x, event.offsetY - tap.y) < double_tap_px;
        const second = last_tap && event.timeStamp - last_tap.time < double_tap_ms && near(last_tap);
        last_tap = second ? null : { x: event.offsetX, y: event.offsetY, time: event.timeStamp };
        if (second) app.focus_at(event.offsetX, event.offsetY);
    }

    function two() {
        const [a, b] = [...fingers.values()];
        return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.max(1, Math.hypot(a.x - b.x, a.y - b.y)) };
    }

    function begin_pinch() {
        const now = two();
        return { pan: follow(drag_of(app, "pan"), now.x, now.y), apart: now.apart };
    }

    function move_pinch() {
        if (fingers.size < 2) return;
        const now = two();
        pinch.pan(now.x, now.y);
        app.zoom_at(pinch.apart / now.apart, now.x, now.y);
        pinch.apart = now.apart;
    }
}
