// The transfer function on a canvas, by pointer and keys. Values on the axis: wheel zooms, drag pans, double click fits. Knots: a click
// adds, a drag moves, right click and Delete remove. The bar below shifts the whole function, its ends stretch it.
import { PlotLayout, draw_plot } from "./transfer_plot.js";
import { at, shifted, span, stretched, with_changed_knot, with_knot, without_knot } from "./transfer_function.js";
import { clamp } from "./vectors.js";

const double_click_ms = 500, scroll_ms = 300;

export class TransferEditor {
    #canvas;
    #host;
    #transfer = null;
    #volume = null;
    #view = [0, 1];
    #drag = null;
    #hovered = null;
    #added_at = -Infinity;
    #scrolled_at = -Infinity;
    selected = 0;
    /// Low opacities get more room.
    spread = false;

    /// host: {edit(key, transfer), held(bool), drop(), selected()}: how edits become the scene's.
    constructor(canvas, host) {
        this.#canvas = canvas;
        this.#host = host;
        const on = (type, handler) => canvas.addEventListener(type, handler.bind(this));
        on("pointerdown", this.#down);
        on("pointermove", this.#move);
        on("pointerup", this.#up);
        on("pointercancel", this.#up);
        on("pointerleave", () => this.#hover(null));
        on("dblclick", this.#double_click);
        on("keydown", this.#key);
        canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
        document.addEventListener("scroll", (event) => (this.#scrolled_at = event.timeStamp), { capture: true, passive: true });
        canvas.addEventListener("contextmenu", (event) => event.preventDefault());
        new ResizeObserver(() => this.draw()).observe(canvas);
    }

    set(transfer, volume) {
        const other_volume = volume !== this.#volume;
        this.#transfer = transfer;
        this.#volume = volume;
        this.selected = clamp(this.selected, 0, transfer.points.length - 1);
        if (other_volume) this.fit();
        else this.draw();
    }

    /// Shows the volume's range, and the function where it goes beyond.
    fit() {
        const [low, high] = this.#volume.range, width = high - low || 1, [first, last] = span(this.#transfer);
        this.#view = [clamp(first, low - width, low), clamp(last, high, high + width)];
        if (!(this.#view[1] > this.#view[0])) this.#view = [low - 0.5, low + 0.5];
        this.draw();
    }

    select(index) {
        this.selected = clamp(index, 0, this.#transfer.points.length - 1);
        const { value } = this.#transfer.points[this.selected], [low, high] = this.#view;
        if (value < low || value > high) this.#view = [value - (high - low) / 2, value + (high - low) / 2];
        this.#host.selected();
        this.draw();
    }

    remove_selected() {
        const index = this.selected;
        this.selected = Math.max(0, index - 1);
        this.#host.edit(null, without_knot(this.#transfer, index));
    }

    draw() {
        if (!this.#transfer) return;
        const { clientWidth: width, clientHeight: height } = this.#canvas;
        if (width === 0) return;
        const ratio = devicePixelRatio;
        this.#canvas.width = Math.round(width * ratio);
        this.#canvas.height = Math.round(height * ratio);
        const context = this.#canvas.getContext("2d"), style = getComputedStyle(this.#canvas);
        context.scale(ratio, ratio);
        const colors = Object.fromEntries(["ink", "faint", "accent", "surface", "bars"].map((name) => [name, style.getPropertyValue(`--${name}`)]));
        const shown = { transfer: this.#transfer, volume: this.#volume, selected: this.selected, hovered: this.#hovered };
        draw_plot(context, this.#layout(), { ...shown, colors });
    }

    #layout() {
        return new PlotLayout(this.#canvas.clientWidth, this.#canvas.clientHeight, this.#view, this.spread);
    }

    /// What lies under the pointer: {part: "knot", index}, "first", "last", "bar", "curve", "plot".
    #under(event, layout) {
        const x = event.offsetX, y = event.offsetY, reach = event.pointerType === "touch" ? 20 : 10;
        if (y > layout.bar - 4) return this.#under_bar(x, layout, reach);
        const { points } = this.#transfer;
        const away = points.map((p, i) => Math.hypot(layout.x(p.value) - x, layout.y(p.opacity) - y) - (i === this.selected ? 0.5 : 0));
        const index = away.indexOf(Math.min(...away));
        if (away[index] <= reach) return { part: "knot", index };
        const curve = layout.y(at(this.#transfer, layout.value(x)).opacity);
        return { part: Math.abs(curve - y) <= reach / 2 ? "curve" : "plot" };
    }

    #under_bar(x, layout, reach) {
        const [first, last] = span(this.#transfer).map((v) => clamp(layout.x(v), layout.left, layout.right));
        if (Math.abs(x - last) <= reach) return { part: "last" };
        if (Math.abs(x - first) <= reach) return { part: "first" };
        return { part: x > first && x < last ? "bar" : "plot" };
    }

    #down(event) {
        const layout = this.#layout(), under = this.#under(event, layout);
        if (event.button === 2) {
            if (under.part !== "knot") return;
            this.selected = under.index;
            this.remove_selected();
            return;
        }
        if (event.button !== 0) return;
        this.#canvas.setPointerCapture(event.pointerId);
        this.#host.held(true);
        this.#drag = { ...under, x: event.offsetX, y: event.offsetY, view: this.#view, transfer: this.#transfer, moved: false };
        if (under.part === "knot") this.select(under.index);
        if (under.part === "curve") this.#add(layout.value(event.offsetX), layout.opacity(event.offsetY));
    }

    #add(value, opacity) {
        const { transfer, index } = with_knot(this.#transfer, value, opacity);
        this.selected = index;
        this.#added_at = performance.now();
        this.#host.edit("transfer.knot", transfer);
        this.#host.selected();
        if (this.#drag) Object.assign(this.#drag, { part: "knot", index });
    }

    #move(event) {
        if (!this.#drag) return this.#hover(this.#under(event, this.#layout()));
        const drag = this.#drag;
        drag.moved ||= Math.hypot(event.offsetX - drag.x, event.offsetY - drag.y) > 3;
        if (drag.moved) this.#dragged(event, drag);
    }

    #dragged(event, drag) {
        const layout = this.#layout(), [first, last] = span(drag.transfer), width = last - first;
        const by = ((event.offsetX - drag.x) * (this.#view[1] - this.#view[0])) / (layout.right - layout.left);
        const stretch = (to, around) => {
            if (width > 0) this.#host.edit("transfer.stretch", stretched(drag.transfer, Math.max(0.01, to / width), around));
        };
        if (drag.part === "knot") {
            const change = { value: layout.value(event.offsetX), opacity: layout.opacity(event.offsetY) };
            this.#host.edit("transfer.knot", with_changed_knot(this.#transfer, drag.index, change));
        } else if (drag.part === "bar") this.#host.edit("transfer.shift", shifted(drag.transfer, by));
        else if (drag.part === "first") stretch(width - by, last);
        else if (drag.part === "last") stretch(width + by, first);
        else {
            this.#view = drag.view.map((v) => v - by);
            this.draw();
        }
    }

    #up(event) {
        const drag = this.#drag;
        this.#drag = null;
        if (!drag) return;
        const layout = this.#layout();
        const clicked = event.type === "pointerup" && drag.part === "plot" && !drag.moved && drag.y < layout.bar - 4;
        if (clicked) this.#add(layout.value(event.offsetX), layout.opacity(event.offsetY));
        this.#host.held(false);
    }

    #hover(under) {
        const cursors = { knot: "grab", first: "ew-resize", last: "ew-resize", bar: "grab", curve: "copy", plot: "crosshair" };
        this.#canvas.style.cursor = cursors[under?.part] ?? "";
        if (JSON.stringify(under) === JSON.stringify(this.#hovered)) return;
        this.#hovered = under;
        this.draw();
    }

    /// The first of its two clicks may have added a knot: that was not meant.
    #double_click() {
        if (performance.now() - this.#added_at < double_click_ms) this.#host.drop();
        this.fit();
    }

    /// While the panel scrolls, the wheel belongs to it.
    #wheel(event) {
        if (event.timeStamp - this.#scrolled_at < scroll_ms) return;
        event.preventDefault();
        this.#zoom(Math.exp(event.deltaY * (event.deltaMode === 1 ? 0.04 : 0.0015)), this.#layout().value(event.offsetX));
    }

    #zoom(factor, around) {
        const whole = this.#volume.range[1] - this.#volume.range[0] || 1, width = this.#view[1] - this.#view[0];
        const by = clamp(width * factor, whole * 1e-4, whole * 8) / width;
        this.#view = this.#view.map((v) => around + (v - around) * by);
        this.draw();
    }

    #key(event) {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const fine = event.shiftKey ? 0.1 : 1, knot = this.#transfer.points[this.selected], width = this.#view[1] - this.#view[0];
        const change = (what) => this.#host.edit("transfer.keys", with_changed_knot(this.#transfer, this.selected, what));
        const actions = {
            ArrowLeft: () => change({ value: knot.value - 0.005 * width * fine }),
            ArrowRight: () => change({ value: knot.value + 0.005 * width * fine }),
            ArrowUp: () => change({ opacity: knot.opacity + 0.02 * fine }),
            ArrowDown: () => change({ opacity: knot.opacity - 0.02 * fine }),
            PageUp: () => this.select(this.selected - 1),
            PageDown: () => this.select(this.selected + 1),
            Delete: () => this.remove_selected(),
            Backspace: () => this.remove_selected(),
            Insert: () => this.#insert(knot),
            "+": () => this.#zoom(0.8, knot.value),
            "-": () => this.#zoom(1.25, knot.value),
            Home: () => this.fit(),
        };
        if (!actions[event.key]) return;
        event.preventDefault();
        event.stopPropagation();
        actions[event.key]();
    }

    /// Halfway to the next knot.
    #insert(knot) {
        const next = this.#transfer.points[this.selected + 1] ?? knot;
        const value = (knot.value + next.value) / 2;
        this.#add(value, at(this.#transfer, value).opacity);
    }
}
