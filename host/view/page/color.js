// Colours: linear RGB in scenes, sRGB on the screen.
import { clamp } from "./vectors.js";

const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const decode = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);

const bytes = (linear) => linear.map((c) => Math.round(255 * encode(clamp(c, 0, 1))));

export const css_of = (linear, alpha = 1) => `rgb(${bytes(linear).join(" ")} / ${alpha})`;
/// "#rrggbb", as colour fields have it.
export const hex_of = (linear) => "#" + bytes(linear).map((b) => b.toString(16).padStart(2, "0")).join("");
export const linear_of = (hex) => [1, 3, 5].map((i) => decode(parseInt(hex.slice(i, i + 2), 16) / 255));
export const from_srgb = (srgb) => srgb.map(decode);
