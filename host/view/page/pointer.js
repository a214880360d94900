// Mouse and pen in the picture: left drag uses the tool, Shift+left or middle drag pans, Shift+right drag moves the light, the wheel zooms
// (with Ctrl to the cursor), double and middle click focus.
import { drag_at, drag_of, follow } from "./tools.js";

const click_px = 4; // a movement below it is a click

export function listen_to_pointer(app, surface) {
    let drag = null;

    surface.addEventListener("pointerdown", (event) => {
        if (event.pointerType === "touch" || drag || !app.can_control) return;
        const begun = begin(event);
        if (!begun) return;
        if (event.button === 1) event.preventDefault(); // browsers scroll by it
        surface.setPointerCapture(event.pointerId);
        app.state.held(true);
        drag = { move: follow(begun, event.offsetX, event.offsetY), x: event.offsetX, y: event.offsetY, button: event.button, moved: false };
    });
    surface.addEventListener("pointermove", (event) => {
        if (event.pointerType === "touch" || !drag) return;
        drag.moved ||= Math.hypot(event.offsetX - drag.x, event.offsetY - drag.y) >= click_px;
        if (drag.moved) drag.move(event.offsetX, event.offsetY, event);
    });
    const end = (event) => {
        if (event.pointerType === "touch" || !drag) return;
        if (event.type === "pointerup" && drag.button === 1 && !drag.moved) app.focus_at(event.offsetX, event.offsetY);
        drag = null;
        app.state.held(false);
    };
    surface.addEventListener("pointerup", end);
    surface.addEventListener("pointercancel", end);
    surface.addEventListener("dblclick", (event) => app.can_control && app.focus_at(event.offsetX, event.offsetY));
    surface.addEventListener("contextmenu", (event) => event.preventDefault());
    surface.addEventListener("wheel", (event) => wheel(app, event), { passive: false });

    function begin(event) {
        if (event.button === 1) return drag_of(app, "pan");
        if (event.button === 2) return event.shiftKey ? drag_of(app, "light") : null;
        if (event.button !== 0) return null;
        return event.shiftKey && app.tool !== "window" ? drag_of(app, "pan") : drag_at(app, event.offsetX, event.offsetY, event.pointerType);
    }
}

/// Lines and pages count as pixels; a pinch on a touchpad arrives as small steps with Ctrl.
function wheel(app, event) {
    event.preventDefault();
    if (!app.can_control) return;
    const pixels = event.deltaY * [1, 30, 400][event.deltaMode];
    const pinch = event.ctrlKey && Math.abs(pixels) < 40;
    const factor = Math.exp(pixels * (pinch ? 0.01 : 0.0012));
    if (event.ctrlKey) app.zoom_at(factor, event.offsetX, event.offsetY);
    else app.zoom(factor);
}
