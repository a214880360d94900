// The WebSocket to `clvr view`: says hello with the token, reconnects with back-off, and sends at most one scene per animation frame.

const first_wait_ms = 500, longest_wait_ms = 10000;
const policy_violation = 1008; // the close code of a server that does not want this client
const header_bytes = 32, magic = 0x52564c43;
const phases = ["moving", "accumulating", "settled"], formats = ["image/jpeg", "image/png"];

/// Takes the token out of the address, so that it is neither seen nor bookmarked, and keeps it for reloads of this tab.
export function take_token() {
    const found = new URLSearchParams(location.hash.slice(1)).get("token");
    if (found) {
        sessionStorage.setItem("clvr.token", found);
        history.replaceState(null, "", location.pathname + location.search);
    }
    return found ?? sessionStorage.getItem("clvr.token") ?? "";
}

/// A binary message as {number, generation, samples, width, height, full_width, full_height, divider, phase, blob}; null if it is none.
export function parse_picture(buffer) {
    if (buffer.byteLength <= header_bytes) return null;
    const view = new DataView(buffer);
    if (view.getUint32(0, true) !== magic) return null;
    return {
        number: view.getUint32(4, true),
        generation: Number(view.getBigUint64(8, true)),
        samples: view.getUint32(16, true),
        width: view.getUint16(20, true),
        height: view.getUint16(22, true),
        full_width: view.getUint16(24, true),
        full_height: view.getUint16(26, true),
        divider: view.getUint8(28),
        phase: phases[view.getUint8(30)] ?? "moving",
        blob: new Blob([new Uint8Array(buffer, header_bytes)], { type: formats[view.getUint8(29)] ?? "" }),
    };
}

export class Connection {
    #token;
    #socket = null;
    #handlers = new Map();
    #waiting = new Map(); // id of a request -> {resolve, reject}
    #next_id = 1;
    #wait_ms = first_wait_ms;
    #timer = 0;
    #scene = null; // {generation, scene} that waits for the next animation frame
    #ended = false;

    constructor(token) {
        this.#token = token;
        addEventListener("online", () => this.open());
        document.addEventListener("visibilitychange", () => this.send({ type: "pause", paused: document.hidden }));
    }

    /// Handlers of a message's type; and of "picture", "open" and "lost" ({message, retry_ms, ended, refused}; retry_ms is null
    /// when it does not try again).
    on(type, handler) {
        this.#handlers.set(type, [...(this.#handlers.get(type) ?? []), handler]);
    }

    get is_open() {
        return this.#socket?.readyState === WebSocket.OPEN;
    }

    open() {
        clearTimeout(this.#timer);
        if (this.#socket) return;
        this.#ended = false;
        const address = new URL("./socket", document.baseURI);
        address.protocol = address.protocol === "https:" ? "wss:" : "ws:";
        const socket = new WebSocket(address);
        socket.binaryType = "arraybuffer";
        socket.onopen = () => this.#opened();
        socket.onmessage = (event) => this.#received(event.data);
        socket.onclose = (event) => this.#closed(event);
        this.#socket = socket;
    }

    send(message) {
        if (this.is_open) this.#socket.send(JSON.stringify(message));
    }

    /// Gives the message a new id, by which a refusal names it.
    send_with_id(message) {
        const id = this.#next_id++;
        this.send({ ...message, id });
        return id;
    }

    /// A message that the server answers by its id: a promise of the answer.
    request(message) {
        if (!this.is_open) return Promise.reject(new Error("There is no connection to clvr at the moment."));
        const id = this.send_with_id(message);
        return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
    }

    /// Only the newest scene of an animation frame is sent.
    send_scene(generation, scene) {
        if (!this.#scene) requestAnimationFrame(() => this.#flush_scene());
        this.#scene = { generation, scene };
    }

    /// GET or POST of another address of the server, with the token.
    async fetch(path, options = {}) {
        const answer = await fetch(new URL(path, document.baseURI), { ...options, headers: { Authorization: `Bearer ${this.#token}` } });
        if (!answer.ok) throw new Error((await answer.text()).slice(0, 500) || `clvr answered ${answer.status}.`);
        return answer;
    }

    #flush_scene() {
        const waiting = this.#scene;
        this.#scene = null;
        if (!waiting || !this.is_open) return;
        const text = JSON.stringify({ type: "scene", ...waiting });
        this.#socket.send(text);
        this.#tell("sent", waiting);
    }

    #opened() {
        this.send({ type: "hello", token: this.#token, role: "control" });
        if (document.hidden) this.send({ type: "pause", paused: true });
        this.#tell("open");
    }

    #received(data) {
        if (typeof data !== "string") {
            const picture = parse_picture(data);
            if (picture) this.#tell("picture", picture);
            return;
        }
        const message = JSON.parse(data);
        if (message.type === "hello") this.#wait_ms = first_wait_ms;
        if (message.type === "bye") this.#ended = true;
        const waiting = this.#waiting.get(message.id);
        if (waiting) {
            this.#waiting.delete(message.id);
            if (message.type === "refused") waiting.reject(new Error(message.message));
            else waiting.resolve(message);
            return;
        }
        this.#tell(message.type, message);
    }

    #closed(event) {
        this.#socket = null;
        for (const { reject } of this.#waiting.values()) reject(new Error("The connection to clvr was lost."));
        this.#waiting.clear();
        const refused = event.code === policy_violation;
        const retry_ms = refused || this.#ended ? null : this.#wait_ms;
        this.#wait_ms = Math.min(longest_wait_ms, this.#wait_ms * 2);
        if (retry_ms !== null) this.#timer = setTimeout(() => this.open(), retry_ms);
        this.#tell("lost", { message: event.reason, retry_ms, ended: this.#ended, refused });
    }

    #tell(type, message) {
        for (const handler of this.#handlers.get(type) ?? []) handler(message);
    }
}
