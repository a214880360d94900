// The picture: decodes what arrives, shows the newest at device pixels, and says when each was drawn.

export class Picture {
    #canvas;
    #context;
    #bitmap = null;
    #decoding = false;
    #waiting = null;
    /// Header of what is shown (see connection.js), or null.
    shown = null;

    /// drawn(picture) is called for each picture that arrived, in order, also for those that a newer one replaced.
    constructor(canvas, drawn, failed) {
        this.#canvas = canvas;
        this.#context = canvas.getContext("2d");
        this.drawn = drawn;
        this.failed = failed;
    }

    /// While one is decoded, only the newest waits.
    show(picture) {
        if (this.#decoding) {
            if (this.#waiting) this.drawn(this.#waiting);
            this.#waiting = picture;
            return;
        }
        this.#decode(picture);
    }

    /// The canvas in device pixels.
    resize(width, height) {
        if (this.#canvas.width === width && this.#canvas.height === height) return;
        this.#canvas.width = width;
        this.#canvas.height = height;
        this.#draw();
    }

    /// Where a picture of this aspect lies on the canvas: as large as fits, in the middle [device pixels].
    place(full_width, full_height) {
        const { width, height } = this.#canvas;
        const s = Math.min(width / full_width, height / full_height);
        const whole = (length, most) => (Math.abs(length - most) < 1 ? most : length); // a rounded size is no reason to scale
        const w = whole(full_width * s, width), h = whole(full_height * s, height);
        return { x: (width - w) / 2, y: (height - h) / 2, width: w, height: h };
    }

    async #decode(picture) {
        this.#decoding = true;
        try {
            const bitmap = await createImageBitmap(picture.blob);
            this.#bitmap?.close();
            this.#bitmap = bitmap;
            this.shown = picture;
            this.#draw();
        } catch {
            this.failed("A picture arrived that this browser cannot decode.");
        }
        this.#decoding = false;
        this.drawn(picture);
        const next = this.#waiting;
        this.#waiting = null;
        if (next) this.#decode(next);
    }

    #draw() {
        const { width, height } = this.#canvas;
        this.#context.clearRect(0, 0, width, height);
        if (!this.#bitmap) return;
        const at = this.place(this.shown.full_width, this.shown.full_height);
        this.#context.imageSmoothingEnabled = this.#bitmap.width !== at.width;
        this.#context.imageSmoothingQuality = "high";
        this.#context.drawImage(this.#bitmap, at.x, at.y, at.width, at.height);
    }
}
