// From the parts, views and channels of an OpenEXR file to the channels of one frame.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// A part as its header describes it.
struct ExrPart {
    std::string name, view;            ///< empty: none
    std::vector<std::string> channels; ///< as the part calls them
    bool deep = false;                 ///< samples at several depths a pixel: left out
};

/// Which channels the frame takes.
struct ExrNames {
    std::vector<std::vector<std::string>> parts; ///< for each channel of each part its name in the frame; empty: left out
    std::vector<std::string> notes;              ///< what was left out or chosen, a sentence each
};

/// A file of one part keeps its names. In a file of several parts, a channel with a dot in its name (of a layer) keeps it, and so do the
/// channels of the beauty: the part with a usual name (rgba, beauty, Combined ...), else the first part with R G B that is no known pass. A
/// plain channel of any other part becomes PART.channel. Of several views (of parts, or in the file's `multi_view`) the first is taken,
/// without its name. Of channels that would get the same name the first stays.
ExrNames frame_names(const std::vector<ExrPart>& parts, const std::vector<std::string>& multi_view);

} // namespace clvr
