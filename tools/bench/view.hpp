// What `clvr view` takes, by its real protocol: a viewer with its server, and a client at the other end of a socket.
#pragma once
#include "host/denoise/model.hpp"
#include "host/render/session.hpp"

#include <memory>
#include <string>
#include <vector>

namespace clvr::bench {

/// A window while the camera turns: medians over its pictures.
struct ViewRow {
    int width = 0, height = 0, divider = 1, pictures = 0;
    double per_second = 0;
    double session_ms = 0;  ///< scene and picture, without server and encoder
    double frame_ms = 0;    ///< from one received picture to the next
    double delivery_ms = 0; ///< from a picture made to its last byte received
    double bytes = 0;
};

struct ViewTimes {
    double first_full_ms = 0;                             ///< at 640x640, from the last scene to the first picture in full size
    double edit_ms = 0, moving_ms = 0;                    ///< at 320x320, from a scene to its picture
    double interrupt_ms = 0, greatest_interrupt = 0;      ///< at 640x640, from a scene during a settling picture to the next picture [ms]
    double cancel_ms = 0, greatest_cancel = 0;            ///< of that, until the next picture is begun [ms]
    double soak_s = 0, rss_first_mb = 0, rss_last_mb = 0; ///< after 5 minutes or a tenth of the time, whichever comes first; at the end
    int soak_pictures = 0;
};

struct ViewReport {
    std::vector<ViewRow> rows;
    ViewTimes times;
};

/// Turns at three sizes, `seconds` each; lets go, edits and interrupts `rounds` times; turns and edits for `soak_seconds` (0: not at all).
/// Sides of the windows are divided by `divider`. Throws Error.
ViewReport measure_view(Device& device, std::shared_ptr<const PreparedVolume> volume, const Scene& scene, const Model& model,
                        double seconds, int rounds, double soak_seconds, int divider = 1);

std::string view_table(const ViewReport& report);

} // namespace clvr::bench
