#include "host/io/dicom/functional_groups.hpp"
#include "host/io/dicom/place.hpp"
#include "host/io/dicom/tags.hpp"

#include <cmath>

namespace clvr {

namespace {

using namespace dicom_tag;

/// Where the values of one frame stand: in its own groups, else in the shared ones, else in the data set itself.
class FrameGroups {
public:
    FrameGroups(const DicomElements* own, const DicomElements* shared, const DicomElements& data)
        : own_(own), shared_(shared), data_(data) {}

    /// The group's first item that holds the element; the data set where none does.
    const DicomElements& with(DicomTag group, DicomTag element) const {
        for (const DicomElements* groups : {own_, shared_})
            if (const DicomElements* item = groups ? groups->item(group) : nullptr; item && item->bytes(element)) return *item;
        return data_;
    }

private:
    const DicomElements *own_, *shared_;
    const DicomElements& data_;
};

/// What frames at one place may differ in.
void read_labels(const FrameGroups& groups, DicomFrame& frame) {
    const auto keep = [&](const char* name, const std::string& value) {
        if (!value.empty()) frame.labels[name] = value;
    };
    const auto keep_real = [&](const char* name, DicomTag group, DicomTag element) {
        if (const auto x = groups.with(group, element).real(element)) keep(name, fmt::format("{:g}", *x));
    };
    keep_real("EchoTime", mr_echo, effective_echo_time);
    keep_real("DiffusionBValue", mr_diffusion, b_value);
    for (const DicomTag group : {mr_frame_type, ct_frame_type, pet_frame_type})
        if (const std::string type = groups.with(group, frame_type).text(frame_type); !type.empty()) keep("ImageType", type);
    const DicomElements& content = groups.with(frame_content, temporal_index);
    if (const auto index = content.words(temporal_index, 4); !index.empty())
        frame.time = index.front();
    else if (const auto offset = groups.with(temporal_sequence, temporal_offset).real(temporal_offset))
        frame.time = *offset;
    else
        frame.time = groups.with(cardiac_synchronization, trigger_delay).real(trigger_delay).value_or(0);
    if (!std::isfinite(frame.time)) frame.time = 0;
    frame.stack = groups.with(frame_content, stack_id).text(stack_id);
}

/// Slope and intercept, where the groups have them. A parametric map has its scale elsewhere; its rescale is 1 and 0.
void read_scale(const FrameGroups& groups, bool is_map, DicomFrame& frame) {
    const std::string& path = frame.image->path;
    const auto set = [](double& to, std::optional<double> value) { to = value.value_or(to); };
    set(frame.slope, groups.with(value_transformation, rescale_slope).decimal(rescale_slope, "RescaleSlope", path));
    set(frame.intercept, groups.with(value_transformation, rescale_intercept).decimal(rescale_intercept, "RescaleIntercept", path));
    if (!is_map) return;
    set(frame.slope, groups.with(real_world_map, real_world_slope).real(real_world_slope));
    set(frame.intercept, groups.with(real_world_map, real_world_intercept).real(real_world_intercept));
}

} // namespace

std::vector<DicomFrame> functional_group_frames(const DicomElements& data, const DicomFrame& common) {
    const DicomImage& image = *common.image;
    const auto own = data.sequences.find(frame_groups);
    const std::size_t items = own == data.sequences.end() ? 0 : own->second.size();
    if (items != image.frames && !(items == 0 && image.frames == 1))
        bad_file(image.path, "PerFrameFunctionalGroupsSequence has {} items for {} frames", items, image.frames);
    const bool is_map = data.text(sop_class) == "1.2.840.10008.5.1.4.1.1.30";
    std::vector<DicomFrame> all;
    for (std::size_t f = 0; f < image.frames; ++f) {
        const FrameGroups groups(items > 0 ? &own->second[f] : nullptr, data.item(shared_groups), data);
        DicomFrame frame = common;
        frame.number = f;
        const DicomElements& measures = groups.with(pixel_measures, pixel_spacing);
        frame.place = place_of(groups.with(plane_position, position), groups.with(plane_orientation, orientation), measures, image.path);
        read_scale(groups, is_map, frame);
        read_labels(groups, frame);
        all.push_back(std::move(frame));
    }
    return all;
}

} // namespace clvr
