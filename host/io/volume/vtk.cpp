// Legacy VTK files with a regular grid.
#include "host/io/volume/axes.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/text_lines.hpp"
#include "host/io/volume/vtk_legacy.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

/// Bytes that the file holds as numbers from 0 to 1.
class UnitColors final : public ByteSource {
public:
    explicit UnitColors(ByteSource& numbers) : numbers_(numbers) {}
    std::size_t read(void* to, std::size_t bytes) override {
        std::vector<float> numbers(bytes);
        const std::size_t n = numbers_.read(numbers.data(), bytes * sizeof(float)) / sizeof(float);
        for (std::size_t i = 0; i < n; ++i) {
            const float x = std::isfinite(numbers[i]) ? std::clamp(numbers[i], 0.0f, 1.0f) : 0.0f;
            static_cast<unsigned char*>(to)[i] = static_cast<unsigned char>(x * 255.0f + 0.5f);
        }
        return n;
    }

private:
    ByteSource& numbers_;
};

} // namespace

Voxels read_vtk(const std::string& path, const VolumeReadOptions& options) {
    Voxels v;
    v.source = path;
    const LegacyVtk vtk = parse_legacy_vtk(path, v.notes);
    const std::size_t index = choose_array(vtk.arrays, options, v);
    const VtkArray& array = vtk.arrays[index];
    const SampleType type = *array.type;
    describe(v, path, "VTK image", type);
    if (!vtk.spaced) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    check_frame(options.frame, 1, path);
    const FileDims dims = vtk.grid.samples(array.of_cells);
    v.dims = check_dims(dims, array.components, type, path).dims;
    v.geometry = vtk.grid.placed(array.of_cells);
    check_geometry(v.geometry, path);

    const auto channel = static_cast<std::uint64_t>(chosen_channel(options, array.components, path, v.notes));
    const auto components = static_cast<std::uint64_t>(array.components);
    const LegacyVtkArray& place = vtk.places[index];
    FileBytes file(path, ByteStream::Coding::plain, place.position);
    TextLines lines(file, path);
    TextSamples numbers(lines, place.unit_colors ? SampleType::f32 : type, v.count() * components, path);
    UnitColors colors(numbers);
    ByteSource& values = place.unit_colors ? static_cast<ByteSource&>(colors) : vtk.text ? static_cast<ByteSource&>(numbers) : file;
    PickedBytes picked(values, sample_bytes(type), components, channel);
    read_samples(components > 1 ? static_cast<ByteSource&>(picked) : values, type, !vtk.text && must_swap(true), v);
    return v;
}

} // namespace clvr
