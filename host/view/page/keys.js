// Keys that work anywhere on the page, except while something is typed.
import { orbit, pan } from "./camera.js";

const standard_views = { 1: [0, 0], 3: [90, 0], 7: [0, 90] };

/// Looks from a standard direction: 1 front, 3 left side, 7 top, 9 the side opposite to the present one.
export function show_standard_view(app, key) {
    const now = app.angles();
    const [azimuth, elevation] = standard_views[key] ?? [now.azimuth + 180, -now.elevation];
    app.look_from(azimuth, elevation);
}

export function listen_to_keys(app, surface) {
    document.addEventListener("keydown", (event) => {
        if (document.querySelector("dialog[open]") || typing(event.target)) return;
        const control = event.ctrlKey || event.metaKey, of_picture = event.target === surface ? in_picture : () => null;
        const action = control ? with_control(app, event) : plain(app, event) ?? of_picture(app, event);
        if (!action) return;
        event.preventDefault();
        action();
    });
}

/// The target takes letters and digits itself.
const typing = (target) => target.matches?.("input:not([type=checkbox]):not([type=range]):not([type=radio]):not([type=color]), select, textarea");

function with_control(app, event) {
    const key = event.key.toLowerCase();
    if (!app.can_control) return null;
    if (key === "z") return () => (event.shiftKey ? app.state.redo() : app.state.undo());
    if (key === "y") return () => app.state.redo();
    return null;
}

function plain(app, event) {
    if (event.altKey) return null;
    const key = event.key.toLowerCase();
    const anybody = { h: () => app.help.toggle(), "?": () => app.help.toggle(), p: () => app.toggle_panel() };
    if (anybody[key]) return anybody[key];
    if (!app.can_control) return null;
    if ("1379".includes(key)) return () => show_standard_view(app, key);
    return {
        5: () => app.set_orthographic(!app.camera.orthographic),
        r: () => app.reset_view(),
        k: () => app.set_trackball(!app.trackball),
        w: () => app.choose_tool(app.tool === "window" ? "turn" : "window"),
        l: () => app.choose_tool(app.tool === "light" ? "turn" : "light"),
        escape: () => app.choose_tool("turn"),
    }[key];
}

/// Arrow keys turn, with Shift they pan; + and - zoom.
function in_picture(app, event) {
    if (!app.can_control) return null;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (arrows && event.shiftKey) return () => app.move_camera("pan.keys", (camera) => pan(camera, arrows[0] * 0.04, arrows[1] * 0.04));
    if (arrows) return () => app.move_camera("orbit.keys", (camera) => orbit(camera, arrows[0] * 5, arrows[1] * 5, app.trackball));
    return { "+": () => app.zoom(0.9), "=": () => app.zoom(0.9), "-": () => app.zoom(1 / 0.9) }[event.key];
}
