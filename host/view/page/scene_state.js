// The scene that the page shows and edits: a small value, replaced as a whole, with undo and redo over whole scenes.

const undo_steps = 200;
const same_gesture_ms = 1000; // edits of one kind that follow each other so fast are one step

/// What a scene file says about the volume's file: the server's business.
const of_the_volume = ["volume", "volume_sha256", "frame", "series", "allow_gaps", "raw", "channel", "array", "recursive"];

export class SceneState {
    #past = [];
    #future = [];
    #listeners = new Set();
    #gesture = { key: null, time: 0, held: false };

    /// null until the server told the first one.
    scene = null;
    /// Grows with each change that the server shall draw.
    generation = 0;
    /// Of the picture [device pixels]: not part of what is undone.
    size = { width: 640, height: 640 };

    /// Calls listener(scene, by) after each change; `by` is "edit" (also undo and redo), "amend", "size" or "server".
    subscribe(listener) {
        this.#listeners.add(listener);
    }

    /// Takes the server's scene. Undo then leads back to what was there before, unless it was the first.
    adopt(scene, generation) {
        const own = structuredClone(scene);
        for (const key of of_the_volume) delete own[key];
        const but_size = (s) => JSON.stringify({ ...s, width: 0, height: 0 });
        if (this.scene && but_size(own) !== but_size(this.scene)) this.#remember(null);
        this.scene = own;
        this.generation = Math.max(this.generation, generation);
        this.#tell("server");
    }

    /// change(scene) edits a copy. Edits with the same key that follow each other, or happen while held(true), are one step of undo.
    edit(key, change) {
        if (!this.scene) return;
        const next = structuredClone(this.scene);
        change(next);
        this.#remember(key);
        this.#replace(next);
    }

    /// As an edit that nobody made: no step of undo.
    amend(change) {
        if (!this.scene) return;
        const next = structuredClone(this.scene);
        change(next);
        this.#replace(next, "amend");
    }

    /// While a pointer is down, all edits of one key are one step.
    held(is_held) {
        this.#gesture = { key: null, time: 0, held: is_held };
    }

    resize(width, height) {
        if (this.size.width === width && this.size.height === height) return;
        this.size = { width, height };
        if (!this.scene) return;
        ++this.generation;
        this.#tell("size");
    }

    get can_undo() {
        return this.#past.length > 0;
    }
    get can_redo() {
        return this.#future.length > 0;
    }

    undo() {
        this.#step(this.#past, this.#future);
    }
    redo() {
        this.#step(this.#future, this.#past);
    }
    /// Takes the last edit back as if it had not been.
    drop() {
        if (!this.can_undo) return;
        this.undo();
        this.#future.pop();
        this.#tell("edit");
    }

    /// Goes back to a scene that the server drew, after it refused the present one.
    fall_back(scene) {
        this.scene = scene;
        this.#gesture.key = null;
        this.#tell("server");
    }

    /// What to send: the scene at the window's size.
    outgoing() {
        return { ...this.scene, width: this.size.width, height: this.size.height };
    }

    #remember(key) {
        const now = performance.now(), g = this.#gesture;
        const goes_on = key !== null && key === g.key && (g.held || now - g.time < same_gesture_ms);
        this.#gesture = { key, time: now, held: g.held };
        this.#future.length = 0;
        if (goes_on) return;
        this.#past.push(this.scene);
        if (this.#past.length > undo_steps) this.#past.shift();
    }

    #step(from, to) {
        if (from.length === 0) return;
        to.push(this.scene);
        this.#gesture.key = null;
        this.#replace(from.pop());
    }

    #replace(scene, by = "edit") {
        this.scene = scene;
        ++this.generation;
        this.#tell(by);
    }

    #tell(by) {
        for (const listener of this.#listeners) listener(this.scene, by);
    }
}
