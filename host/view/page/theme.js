// Dark or light: as the system has it, until the user chooses.
import { element } from "./controls.js";
import { icon } from "./icons.js";

const prefers_dark = matchMedia("(prefers-color-scheme: dark)");
const chosen = () => localStorage.getItem("clvr.theme");
const is_dark = () => (chosen() ?? (prefers_dark.matches ? "dark" : "light")) === "dark";

export function theme_button(changed) {
    const show = () => {
        document.documentElement.dataset.theme = is_dark() ? "dark" : "light";
        changed();
    };
    prefers_dark.addEventListener("change", show);
    const toggle = () => {
        localStorage.setItem("clvr.theme", is_dark() ? "light" : "dark");
        show();
    };
    show();
    const label = "Dark or light";
    return element("button", { type: "button", class: "tool plain", "aria-label": label, title: label, onclick: toggle }, icon("theme"));
}
