#include "host/io/volume/slice_stack.hpp"

#include <filesystem>

namespace clvr {

void store_slice(Voxels& v, std::size_t slice, SampleType type, const std::function<void(unsigned char*)>& decode) {
    const std::size_t samples = static_cast<std::size_t>(v.dims[0]) * static_cast<std::size_t>(v.dims[1]);
    if (is_kept(type)) return decode(v.bytes.data() + slice * samples * sample_bytes(type));
    std::vector<unsigned char> scratch(samples * sample_bytes(type));
    decode(scratch.data());
    store_samples(scratch.data(), type, samples, v, slice * samples);
}

void stack_slices(Voxels& v, const std::string& path, const std::string& format, const std::vector<std::string>& files,
                  const OpenSlice& open) {
    std::string form;
    for (std::size_t slice = 0; slice < files.size(); ++slice) {
        const auto image = open(files[slice]);
        if (slice == 0) {
            form = image->form;
            describe(v, path, format, image->type);
            v.dims = check_dims({image->width, image->height, static_cast<std::int64_t>(files.size())}, 1, image->type, path).dims;
            std::uint64_t stored = 0;
            for (const std::string& f : files) stored += std::filesystem::file_size(f);
            constexpr std::uint64_t greatest_ratio = 40000; // no codec of pictures packs tighter
            check_capacity(static_cast<std::uint64_t>(v.count()) * sample_bytes(image->type), stored * greatest_ratio, path);
            allocate(v);
        } else if (image->form != form) {
            bad_file(files[slice], "it is {}, {} is {}: all slices must be alike", image->form,
                     std::filesystem::path(files.front()).filename().string(), form);
        }
        store_slice(v, slice, image->type, [&](unsigned char* to) { image->decode(to); });
    }
}

Voxels read_pictures(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options,
                     const std::string& kind, const OpenSlice& open) {
    check_frame(options.frame, 1, path);
    if (options.channel.value_or(0) != 0)
        bad_file(path, "channel {} is not there: {} slices have 1 channel, counted from 0", *options.channel, kind);
    Voxels v;
    bool alpha = false, colour = false;
    stack_slices(v, path, files.size() == 1 ? kind : kind + " slices", files, [&](const std::string& name) {
        auto slice = open(name);
        alpha |= slice->has_alpha, colour |= slice->grey_of_colour;
        return slice;
    });
    if (alpha) v.notes.push_back("the pictures' alpha is left out");
    if (colour) v.decisions.push_back("red, green and blue are equal in every pixel: read as grey");
    v.geometry.spacing = options.spacing.value_or(Double3{1, 1, 1});
    check_geometry(v.geometry, path);
    if (!options.spacing) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed (--spacing sets it)");
    return v;
}

} // namespace clvr
