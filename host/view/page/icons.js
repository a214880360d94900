// Small line icons, drawn from paths in a box of 24 x 24.

const paths = {
    turn: "M20 12a8 8 0 1 1-2.4-5.7 M20 3v4h-4",
    window: "M12 3a9 9 0 1 0 0 18z M12 3a9 9 0 0 1 0 18",
    light: "M12 8a4 4 0 1 0 0 8a4 4 0 0 0 0-8 M12 2v2 M12 20v2 M2 12h2 M20 12h2 M5 5l1.4 1.4 M17.6 17.6l1.4 1.4 M5 19l1.4-1.4 M17.6 6.4l1.4-1.4",
    undo: "M9 14L4 9l5-5 M4 9h10a6 6 0 0 1 0 12h-3",
    redo: "M15 14l5-5-5-5 M20 9H10a6 6 0 0 0 0 12h3",
    reset: "M4 9V4h5 M20 9V4h-5 M4 15v5h5 M20 15v5h-5",
    help: "M9 9a3 3 0 1 1 4 2.8c-.7.3-1 .8-1 1.7 M12 17.5v.1",
    panel: "M4 4h16v16H4z M15 4v16",
    theme: "M12 3a9 9 0 1 0 9 9a7 7 0 0 1-9-9",
};

export function icon(name) {
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg"), path = document.createElementNS("http://www.w3.org/2000/svg", "path");
    for (const [key, value] of Object.entries({ viewBox: "0 0 24 24", class: "icon", "aria-hidden": "true" })) svg.setAttribute(key, value);
    path.setAttribute("d", paths[name]);
    svg.append(path);
    return svg;
}
