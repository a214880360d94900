// Window and level in the picture: up and down shifts the transfer function, left and right widens it, with Ctrl up and down changes its
// opacity; Shift moves finely. All relative to the function as it is.
import { shifted, span, stretched, with_opacities_times } from "./transfer_function.js";

/// One step of a drag, by CSS pixels in a picture of `height`.
export function window_step(app, dx, dy, height, event) {
    const fine = event.shiftKey ? 0.1 : 1, right = (dx / height) * fine, upwards = (-dy / height) * fine;
    const transfer = app.transfer.current(), [first, last] = span(transfer);
    if (event.ctrlKey || event.metaKey) {
        app.transfer.edit("window.opacity", with_opacities_times(transfer, Math.exp(upwards * 3)));
        return;
    }
    const wide = stretched(transfer, Math.exp(right * 2), (first + last) / 2);
    app.transfer.edit("window", shifted(wide, upwards * (last - first)));
}
