// The help sheet.
import { button, element } from "./controls.js";

const sheet = [
    ["Look", [
        ["Drag", "Turn"],
        ["Shift + drag, middle drag", "Move sideways"],
        ["Wheel", "Zoom; with Ctrl towards the cursor"],
        ["Double click, middle click", "Focus on what is there"],
        ["1  3  7  9", "From the front, the left, the top, the opposite side"],
        ["5", "Parallel projection on or off"],
        ["K", "Free trackball on or off; off keeps the horizon level"],
        ["R", "Reset the view"],
        ["Arrows, + and −", "Turn and zoom; with Shift move (in the picture)"],
        ["One finger, two fingers", "Turn; move and zoom"],
    ]],
    ["Values and light", [
        ["W", "Window and level: drag up or down shifts, left or right widens; Ctrl changes the opacity, Shift moves finely"],
        ["L, or Shift + right drag", "Move the key light"],
        ["Esc", "Back to turning"],
    ]],
    ["Transfer function", [
        ["Click, drag a dot", "Add a knot, move it"],
        ["Right click, Delete", "Remove a knot"],
        ["Wheel, drag, double click", "Zoom the axis of values, move it, show all of it"],
        ["Bar below", "Shift the whole function; its ends stretch it"],
        ["Arrows, Page Up and Down, Insert", "Move the selected knot, select another, add one"],
    ]],
    ["Everything", [
        ["Ctrl + Z, Shift + Ctrl + Z", "Undo, redo"],
        ["P", "Show or hide the settings"],
        ["H", "This help"],
    ]],
];

export class Help {
    #dialog;

    constructor(dialog) {
        this.#dialog = dialog;
        const parts = sheet.map(([title, lines]) => element("section", {}, element("h3", {}, title),
            element("dl", {}, ...lines.flatMap(([keys, words]) => [element("dt", {}, keys), element("dd", {}, words)]))));
        const header = element("header", {}, element("h2", {}, "Help"), button("Close", () => dialog.close()));
        dialog.append(header, element("div", { class: "sheet" }, ...parts));
        dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
        dialog.addEventListener("keydown", (event) => {
            event.stopPropagation(); // the page's own keys rest
            if (event.key.toLowerCase() === "h") dialog.close();
        });
    }

    toggle() {
        if (this.#dialog.open) this.#dialog.close();
        else this.#dialog.showModal();
    }
}
