// The buttons over the picture: tools, undo, reset, help, and the panel's.
import { element } from "./controls.js";
import { icon } from "./icons.js";
import { tools } from "./tools.js";

const icon_button = (name, label, title, onclick, more = {}) =>
    element("button", { type: "button", class: "tool", "aria-label": label, title, onclick, ...more }, icon(name));

export class Toolbar {
    #app;
    #tools;

    constructor(app, root, corner) {
        this.#app = app;
        const tool_button = (name, { text, help }) => icon_button(name, text, `${text}: ${help}`, () => app.choose_tool(name));
        this.#tools = Object.entries(tools).map(([name, tool]) => [name, tool_button(name, tool)]);
        this.undo = icon_button("undo", "Undo", "Undo (Ctrl+Z)", () => app.state.undo());
        this.redo = icon_button("redo", "Redo", "Redo (Shift+Ctrl+Z)", () => app.state.redo());
        const group = (label, ...buttons) => element("div", { class: "group", role: "group", "aria-label": label }, ...buttons);
        this.controls = [group("What a drag does", ...this.#tools.map(([, b]) => b)), group("History", this.undo, this.redo),
            group("View", icon_button("reset", "Reset the view", "Reset the view (R)", () => app.reset_view()))];
        root.append(...this.controls, group("Help", icon_button("help", "Help", "Help (H)", () => app.help.toggle())));
        this.panel = icon_button("panel", "Settings", "Show or hide the settings (P)", () => app.toggle_panel(), { "aria-controls": "panel" });
        corner.append(this.panel);
    }

    update() {
        const app = this.#app;
        for (const [name, b] of this.#tools) b.setAttribute("aria-pressed", String(name === app.tool));
        this.undo.disabled = !app.state.can_undo;
        this.redo.disabled = !app.state.can_redo;
        for (const group of this.controls) group.inert = !app.can_control;
        this.panel.setAttribute("aria-expanded", String(app.panel_open));
    }
}
