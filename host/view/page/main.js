// Puts the page together: what the server says goes to the parts, what the user does goes to the server.
import { App } from "./app.js";
import { fitted } from "./camera.js";
import { draw_clip } from "./clip_handles.js";
import { ClipPanel } from "./clip.js";
import { Connection, take_token } from "./connection.js";
import { Help } from "./help.js";
import { listen_to_keys } from "./keys.js";
import { LightPanel } from "./lights.js";
import { Messages } from "./messages.js";
import { draw_overlays } from "./overlays.js";
import { RenderPanel, TimePanel, ViewPanel } from "./panels.js";
import { Picture } from "./picture.js";
import { listen_to_pointer } from "./pointer.js";
import { SavePanel } from "./saves.js";
import { SceneState } from "./scene_state.js";
import { Settings } from "./settings.js";
import { theme_button } from "./theme.js";
import { Toolbar } from "./toolbar.js";
import { listen_to_touch } from "./touch.js";
import { TransferPanel } from "./transfer_panel.js";

const by_id = (id) => document.getElementById(id);
const surface = by_id("overlay");
const token = take_token();
const connection = new Connection(token), state = new SceneState(), messages = new Messages(by_id("messages"));
const picture = new Picture(by_id("picture"), (drawn) => connection.send({ type: "ack", number: drawn.number }), (text) => messages.show(text));
const app = new App({ state, connection, messages, picture, settings: new Settings(), stage: by_id("stage") });

app.help = new Help(by_id("help"));
app.transfer = new TransferPanel(app);
app.clip = new ClipPanel(app);
const save_panel = new SavePanel(app);
const panels = [app.transfer, new TimePanel(app), new RenderPanel(app), new LightPanel(app), app.clip, new ViewPanel(app), save_panel];
app.save = (what) => save_panel.save(what);
const toolbar = new Toolbar(app, by_id("toolbar"), by_id("corner"));
by_id("sections").append(...panels.map((p) => p.root));
by_id("panel-buttons").append(theme_button(() => app.transfer.redraw()));

// ---- what is shown ----

const sent = new Map(); // generation -> {scene, time}: on its way to a picture
let drawn_scene = null; // the last of ours that the server drew
let unsent = false; // edited without a connection

let update_waits = false;
app.changed = () => {
    if (state.scene && app.hello) app.transfer.update(); // at once: its editor goes on from there
    if (!update_waits) requestAnimationFrame(update);
    update_waits = true;
};

function update() {
    update_waits = false;
    by_id("app").classList.toggle("panel-closed", !app.panel_open);
    by_id("sections").inert = !app.can_control;
    by_id("stage").classList.toggle("watching", !app.can_control);
    toolbar.update();
    if (!state.scene || !app.hello) return;
    for (const panel of panels) panel.update();
    app.redraw();
}

let redraw_waits = false;
app.redraw = () => {
    if (!redraw_waits) requestAnimationFrame(draw_over);
    redraw_waits = true;
};

function draw_over() {
    redraw_waits = false;
    const context = surface.getContext("2d");
    context.clearRect(0, 0, surface.width, surface.height);
    if (!app.volume || !picture.shown) return;
    const { ratio } = picture, frame = app.frame();
    const place = { x: frame.x * ratio, y: frame.y * ratio, width: frame.width * ratio, height: frame.height * ratio };
    draw_overlays(context, { ...app.overlay_facts(), ...place, pixel: ratio });
    context.save();
    context.scale(ratio, ratio);
    context.translate(frame.x, frame.y);
    draw_clip(context, app, frame.width, frame.height);
    context.restore();
}

function status_of({ phase, samples, divider, generation }) {
    const began = sent.get(generation)?.time;
    const time = began === undefined ? "" : ` · ${((performance.now() - began) / 1000).toFixed(1)} s`;
    if (phase === "moving") return divider > 1 ? `in motion · 1/${divider} size` : "draft";
    if (state.scene.mode !== "path") return `complete${time}`;
    return phase === "settled" ? `${samples} samples${time}` : `${samples} of ${state.scene.spp} samples${time}`;
}

connection.on("picture", (arrived) => {
    app.status = status_of(arrived);
    const own = sent.get(arrived.generation);
    if (own) drawn_scene = own.scene;
    for (const generation of sent.keys()) if (generation < arrived.generation) sent.delete(generation);
    picture.show(arrived);
    by_id("stage").classList.add("has-picture");
    by_id("stage").dataset.phase = arrived.phase;
    app.redraw();
});

// ---- the scene to the server and back ----

state.subscribe((_, by) => {
    if (by !== "server" && app.can_control) send_scene();
    if (by === "edit") by_id("hint").hidden = true; // the user has found out
    app.changed();
});

function send_scene() {
    unsent ||= !connection.is_open;
    connection.send_scene(state.generation, state.outgoing());
}

connection.on("sent", ({ generation, scene }) => {
    unsent = false;
    sent.set(generation, { scene, time: performance.now() });
});

/// The server's scene with the camera that it resolved; on a window of another shape the view is fitted.
function take_scene({ scene, view, generation }) {
    const framed_by_server = !scene.camera.eye;
    const camera = { ...scene.camera, eye: view.eye, target: view.target, up: view.up, fov: view.fov ?? scene.camera.fov };
    if (camera.orthographic) camera.height = view.height;
    const aspect = scene.width / scene.height;
    keep_home(framed_by_server, { name: app.volume.name, camera, aspect });
    state.adopt({ ...scene, camera }, generation);
    if (app.can_control) state.amend((own) => (own.camera = fitted(own.camera, aspect, app.aspect)));
}

/// Where Reset leads: the server's own framing, also after a reload of the page; null where it is not known.
function keep_home(framed_by_server, home) {
    if (framed_by_server) sessionStorage.setItem("clvr.home", JSON.stringify(home));
    const stored = JSON.parse(sessionStorage.getItem("clvr.home") ?? "null");
    app.home = stored?.name === home.name ? stored : null;
}

connection.on("hello", (hello) => {
    const had_control = app.can_control, keeps_own = unsent && had_control;
    app.hello = hello;
    app.settings.load(hello.settings);
    app.can_control = hello.role === "control";
    take_volume(hello);
    messages.clear("connection");
    by_id("device").textContent = `${hello.device} · clvr ${hello.version}`;
    for (const panel of panels) panel.load();
    app.fit_window();
    if (keeps_own) {
        state.generation = Math.max(state.generation, hello.generation);
        state.amend(() => {}); // is sent, now or when control comes back
    } else take_scene(hello);
    if (had_control && !app.can_control) connection.send({ type: "take_control" }); // it was ours when the connection was lost
    show_role();
});

function take_volume({ volume, automatic }) {
    app.volume = volume;
    app.automatic = automatic;
    by_id("name").textContent = volume.name;
    document.title = `${volume.name} · clvr`;
    const [x, y, z] = volume.size;
    by_id("facts").textContent = `${x} × ${y} × ${z} ${volume.type}`;
}

connection.on("volume", (message) => {
    take_volume(message);
    for (const panel of panels) panel.load();
    app.changed();
});

connection.on("scene", take_scene);

connection.on("refused", ({ generation, id, message }) => {
    messages.show(message);
    if (id !== undefined) save_panel.refused(id);
    if (generation !== undefined && generation >= state.generation && drawn_scene) state.fall_back(drawn_scene);
});

connection.on("notice", ({ level, message }) => messages.show(message, { level }));
connection.on("job", (job) => save_panel.job(job));

connection.on("role", ({ role }) => {
    app.can_control = role === "control";
    if (app.can_control) state.amend(() => {}); // the scene at the size of this window
    show_role();
});

function show_role() {
    const take = { text: "Take control", run: () => connection.send({ type: "take_control" }) };
    if (app.can_control) messages.clear("role");
    else messages.show("You watch; somebody else controls the view.", { level: "info", key: "role", stays: true, action: take });
    app.changed();
}

connection.on("clients", ({ count }) => (by_id("clients").textContent = count > 1 ? ` · ${count} windows` : ""));

// ---- the connection in words ----

let last_words = "";
connection.on("bye", ({ message }) => (last_words = message));
connection.on("open", () => (last_words = ""));
connection.on("lost", ({ message, retry_ms, ended, refused }) => {
    const otherwise = ended ? "clvr view has ended." : "The connection to clvr was lost.";
    const why = refused ? `clvr refused this window (${message}). Open the address that clvr view printed last.` : last_words || message || otherwise;
    const then = retry_ms === null ? "" : ` Trying again in ${Math.max(1, Math.round(retry_ms / 1000))} s.`;
    const connect = { text: "Connect now", run: () => connection.open() };
    messages.show(why + then, { level: ended ? "info" : "error", key: "connection", stays: true, action: connect });
});

// ---- the window ----

let window_pixels = [640, 640];
app.fit_window = () => {
    const [width, height] = window_pixels, side = app.hello?.limits?.side ?? 4096;
    const share = Math.min(app.detail, side / Math.max(width, height)), before = app.aspect;
    state.resize(Math.max(1, Math.round(width * share)), Math.max(1, Math.round(height * share)));
    if (app.can_control && state.scene && app.aspect !== before) state.amend((scene) => (scene.camera = fitted(scene.camera, before, app.aspect)));
};

function resized([entry]) {
    const exact = entry.devicePixelContentBoxSize?.[0], css = entry.contentBoxSize[0];
    const pixels = (length, of_device) => {
        const about = length * devicePixelRatio; // emulated ratios are not in what the device says
        return Math.max(1, Math.round(Math.abs(of_device - about) < 2 ? of_device : about));
    };
    window_pixels = [pixels(css.inlineSize, exact?.inlineSize), pixels(css.blockSize, exact?.blockSize)];
    picture.ratio = window_pixels[0] / Math.max(1, css.inlineSize);
    picture.resize(...window_pixels);
    [surface.width, surface.height] = window_pixels;
    app.fit_window();
    draw_over();
}

const observer = new ResizeObserver(resized);
try {
    observer.observe(surface, { box: "device-pixel-content-box" });
} catch {
    observer.observe(surface); // a browser that does not know the exact size
}

if (matchMedia("(pointer: coarse)").matches) by_id("hint").textContent = "Drag to turn, pinch to zoom, ? for help";
listen_to_pointer(app, surface);
listen_to_touch(app, surface);
listen_to_keys(app, surface);
by_id("sheet-toggle").addEventListener("click", () => app.toggle_panel());

app.changed();
if (token) connection.open();
else messages.show("This page needs the whole address that clvr view printed, with the token behind the #.", { stays: true });
