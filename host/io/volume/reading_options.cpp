#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/samples.hpp"

namespace clvr {

std::int64_t chosen_channel(const VolumeReadOptions& options, std::int64_t channels, const std::string& path,
                            std::vector<std::string>& notes) {
    const std::int64_t channel = options.channel.value_or(0);
    if (channel < 0 || channel >= channels)
        bad_file(path, "channel {} is not there: the file has {} channel{}, counted from 0", channel, channels, channels == 1 ? "" : "s");
    if (!options.channel && channels > 1)
        notes.push_back(fmt::format("the file has {} channels: the first is taken (--channel 0 to {} chooses)", channels, channels - 1));
    return channel;
}

int say_frame(int frame, std::int64_t frames, const char* axis, std::vector<std::string>& decisions) {
    if (frames > 1) decisions.push_back(fmt::format("frame {} of 0 to {} along {}", frame, frames - 1, axis));
    return static_cast<int>(frames);
}

void set_spacing(Voxels& v, const VolumeReadOptions& options, const std::optional<Double3>& own) {
    v.geometry.spacing = options.spacing ? *options.spacing : own.value_or(Double3{1, 1, 1});
    if (options.spacing && own) v.decisions.push_back("the spacing is that of --spacing, not the file's");
    if (!options.spacing && !own) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed (--spacing sets it)");
}

} // namespace clvr
