// The parts of the panel: real buttons, labelled fields, sections that fold. Everything that is shown is set as text, never as HTML.

/// element("button", {class: "x", onclick: f, "aria-label": "y"}, ...children): text or nodes.
export function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (value === undefined || value === null || value === false) continue;
        if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
        else if (typeof value !== "string") made[key] = value; // numbers and switches are properties
        else made.setAttribute(key, value);
    }
    made.append(...children.filter((c) => c !== null && c !== undefined));
    return made;
}

let last_id = 0;
const new_id = (prefix) => `${prefix}-${++last_id}`;

/// A number for people: at most four digits that count.
export function readable(value) {
    if (!Number.isFinite(value)) return "";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e6 || size < 1e-4) return value.toExponential(2).replace("e+", "e");
    if (size >= 1000) return String(Math.round(value));
    return String(Number(value.toPrecision(4)));
}

/// A part of the panel that folds; it remembers whether it was open.
export function section(title, open, ...children) {
    const key = `clvr.open.${title}`;
    const summary = element("summary", {}, element("h2", {}, title));
    const details = element("details", { class: "section" }, summary, element("div", { class: "body" }, ...children));
    details.open = JSON.parse(localStorage.getItem(key) ?? String(open));
    details.addEventListener("toggle", () => localStorage.setItem(key, String(details.open)));
    return details;
}

export const button = (text, onclick, attributes = {}) => element("button", { type: "button", onclick, ...attributes }, text);
export const row = (...children) => element("div", { class: "row" }, ...children);
export const note = (text) => element("p", { class: "note" }, text);

/// A switch. changed(value) is called when the user changes it; the result has `set(value)`.
export function checkbox(label, changed, title = "") {
    const input = element("input", { type: "checkbox", onchange: () => changed(input.checked) });
    const root = element("label", { class: "check", title }, input, element("span", {}, label));
    return { root, set: (value) => (input.checked = value) };
}

/// A list to choose from: options are [value, text].
export function choice(label, options, changed, title = "") {
    const id = new_id("choice");
    const entries = options.map(([value, text]) => element("option", { value }, text));
    const select = element("select", { id, onchange: () => changed(select.value) }, ...entries);
    const root = element("div", { class: "field", title }, element("label", { for: id }, label), select);
    return { root, set: (value) => (select.value = value) };
}

/// A few choices side by side, one of which holds.
export function segments(label, options, changed) {
    const name = new_id("segment");
    const inputs = options.map(([value]) => element("input", { type: "radio", name, value, id: `${name}-${value}`, onchange: () => changed(value) }));
    const labels = options.map(([value, text, title]) => element("label", { for: `${name}-${value}`, title: title ?? "" }, text));
    const parts = inputs.map((input, i) => element("span", {}, input, labels[i]));
    const root = element("fieldset", { class: "segments" }, element("legend", { class: "hidden" }, label), ...parts);
    return { root, set: (value) => inputs.forEach((i) => (i.checked = i.value === value)) };
}

/// A colour; values are "#rrggbb".
export function color_field(label, changed) {
    const id = new_id("color");
    const input = element("input", { type: "color", id, oninput: () => changed(input.value) });
    return { root: element("div", { class: "field" }, element("label", { for: id }, label), input), set: (value) => (input.value = value) };
}

/// A field for a file, hidden: open() asks for one, and taken(file) is called with it.
export function file_input(label, accept, taken) {
    const root = element("input", { type: "file", accept, class: "hidden", tabindex: "-1", "aria-label": label });
    root.addEventListener("change", () => {
        const [file] = root.files;
        root.value = ""; // the same file may be chosen again
        if (file) taken(file);
    });
    return { root, open: () => root.click() };
}

/// Tells while a number is being typed, so that nothing overwrites it, and takes it when it is finite.
function when_typed(input, typing, changed) {
    input.addEventListener("input", () => typing(true));
    input.addEventListener("blur", () => typing(false));
    input.addEventListener("change", () => {
        typing(false);
        if (Number.isFinite(input.valueAsNumber)) changed(input.valueAsNumber);
    });
}

/// A typed number, taken when it is finite; unit is shown behind it.
export function number_field(label, changed, { unit = "", step = "any", title = "" } = {}) {
    const id = new_id("number");
    const input = element("input", { type: "number", step, id, inputmode: "decimal" });
    let typing = false;
    when_typed(input, (is_typing) => (typing = is_typing), changed);
    const unit_text = unit ? element("span", { class: "unit" }, unit) : null;
    const root = element("div", { class: "field", title }, element("label", { for: id }, label), input, unit_text);
    return { root, input, set: (value) => !typing && (input.value = value === null ? "" : readable(value)) };
}

/// A slider with a field beside it, in which any allowed value may be typed.
/// options: {low, high, step, allowed(value), unit, help, logarithmic, usual}; a double click brings the usual value back.
export function slider(label, options, changed) {
    const id = new_id("slider"), help = options.help ? new_id("help") : null;
    const to = options.logarithmic ? Math.log : (x) => x, from = options.logarithmic ? Math.exp : (x) => x;
    const allowed = options.allowed ?? ((x) => x);
    const step = options.logarithmic ? (to(options.high) - to(options.low)) / 500 : options.step;
    const range = element("input", { type: "range", id, min: String(to(options.low)), max: String(to(options.high)), step: String(step) });
    if (help) range.setAttribute("aria-describedby", help);
    const typed = element("input", { type: "number", step: "any", inputmode: "decimal", "aria-label": `${label}, typed` });
    let typing = false;
    const show = (value) => {
        range.value = String(to(Math.max(value, options.logarithmic ? options.low : -Infinity)));
        if (!typing) typed.value = readable(value);
        range.setAttribute("aria-valuetext", readable(value) + (options.unit ? ` ${options.unit}` : ""));
    };
    range.addEventListener("input", () => changed(allowed(from(range.valueAsNumber))));
    if (options.usual !== undefined) range.addEventListener("dblclick", () => changed(options.usual));
    when_typed(typed, (is_typing) => (typing = is_typing), (value) => changed(allowed(value)));
    const root = element("div", { class: "slider", title: options.help ?? "" },
        element("label", { for: id }, label, options.unit ? element("span", { class: "unit" }, ` ${options.unit}`) : null),
        range, typed,
        help ? element("span", { id: help, class: "hidden" }, options.help) : null);
    return { root, set: show };
}
