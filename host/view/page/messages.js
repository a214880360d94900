// The bar of messages: what the server says, and how the connection is, in words.
import { button, element } from "./controls.js";

const notice_ms = { info: 4000, warning: 15000, error: 15000 };

export class Messages {
    #root;
    #shown = new Map(); // text or key -> element

    constructor(root) {
        this.#root = root;
    }

    /// level: "info", "warning" or "error". With a key, the message replaces the former of that key; when it `stays`, until clear(key).
    show(text, { level = "error", key = text, stays = false, action = null } = {}) {
        this.clear(key);
        const message = element("div", { class: `message ${level}`, role: level === "error" ? "alert" : "status" }, element("span", {}, text));
        if (action) message.append(button(action.text, action.run));
        else message.append(button("×", () => this.clear(key), { class: "close", "aria-label": "Close this message" }));
        this.#root.append(message);
        this.#shown.set(key, message);
        if (!stays) setTimeout(() => this.#shown.get(key) === message && this.clear(key), notice_ms[level]);
    }

    clear(key) {
        this.#shown.get(key)?.remove();
        this.#shown.delete(key);
    }
}
