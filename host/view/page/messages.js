// The bar of messages: what the server says, and how the connection is, in words.
import { button, element } from "./controls.js";

const notice_ms = 12000;

export class Messages {
    #root;
    #shown = new Map(); // text or key -> element

    constructor(root) {
        this.#root = root;
    }

    /// level: "info", "warning" or "error". With a key, the message stays until clear(key) and replaces the former of that key.
    show(text, { level = "error", key = null, action = null } = {}) {
        this.clear(key ?? text);
        const message = element("div", { class: `message ${level}`, role: level === "error" ? "alert" : "status" }, element("span", {}, text));
        if (action) message.append(button(action.text, action.run));
        else message.append(button("×", () => this.clear(key ?? text), { class: "close", "aria-label": "Close this message" }));
        this.#root.append(message);
        this.#shown.set(key ?? text, message);
        if (!key) setTimeout(() => this.#shown.get(text) === message && this.clear(text), notice_ms);
    }

    clear(key) {
        this.#shown.get(key)?.remove();
        this.#shown.delete(key);
    }
}
