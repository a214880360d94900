// Legacy VTK files with structured points (examples.vtk.org, "VTK File Formats").
#include "host/io/volume/itk.hpp"
#include "host/io/volume/readers.hpp"

#include <filesystem>
#include <sstream>

namespace clvr {

namespace {

constexpr std::size_t greatest_header = std::size_t{1} << 16;

/// The lines of the header one by one; voxels follow the line after "LOOKUP_TABLE".
class Lines {
public:
    explicit Lines(const std::string& path) : path_(path), text_(read_head(path, greatest_header)) {}
    /// The next line, as ITK counts: empty ones do not count.
    std::string next() {
        while (true) {
            const auto end = text_.find('\n', at_);
            if (end == std::string::npos) bad_file(path_, "the VTK header ends too early: the file is truncated or holds no SCALARS");
            const std::string_view line = std::string_view(text_).substr(at_, end - at_);
            at_ = end + 1;
            if (line.size() > 256) bad_file(path_, "a line of the VTK header has {} characters: the file is damaged", line.size());
            if (!trimmed(line).empty()) return std::string(trimmed(line));
        }
    }
    std::size_t position() const { return at_; }

private:
    std::string path_, text_;
    std::size_t at_ = 0;
};

} // namespace

Voxels read_vtk(const std::string& path, const VolumeReadOptions& options) {
    Lines lines(path);
    if (lines.next().rfind("# vtk DataFile", 0) != 0) bad_file(path, "not a legacy VTK file: expected \"# vtk DataFile Version ...\"");
    lines.next(); // the title
    Container c;
    c.data_path = path;
    const std::string coding = lower_case(lines.next());
    if (coding == "ascii")
        c.coding = Container::Coding::text;
    else if (coding != "binary")
        bad_file(path, "expected ASCII or BINARY in the third line, found \"{:.40}\"", coding);

    bool sized = false, spaced = false;
    std::uint64_t points = 0;
    while (true) {
        const std::string line = lines.next();
        std::istringstream words(line);
        std::string key, rest;
        words >> key;
        std::getline(words, rest);
        key = lower_case(key);
        if (key == "dataset") {
            if (lower_case(trimmed(rest)) != "structured_points")
                bad_file(path, "the data set is {:.40}: clvr reads STRUCTURED_POINTS (an image), resample it in ParaView", trimmed(rest));
        } else if (key == "dimensions") {
            const auto sizes = parse_integers(rest, 3, 1, "DIMENSIONS", path);
            c.dims = {sizes[0], sizes[1], sizes[2]};
            sized = true;
        } else if (key == "spacing" || key == "aspect_ratio") {
            check_spacing(rest, 3, "SPACING", path);
            spaced = true;
        } else if (key == "origin") {
            if (const auto o = parse_numbers(rest); !o || o->size() != 3) bad_file(path, "ORIGIN is \"{:.60}\": expected 3 numbers", rest);
        } else if (key == "point_data") {
            points = static_cast<std::uint64_t>(parse_integers(rest, 1, 1, "POINT_DATA", path).front());
        } else if (key == "scalars") {
            std::string name, type, channels = "1";
            std::istringstream(rest) >> name >> type >> channels;
            const auto sample = parse_sample_type(lower_case(type));
            if (!sample) bad_file(path, "the voxels have the type \"{:.40}\": expected unsigned_char, short, float, ...", type);
            if (parse_integers(channels, 1, 1, "the number of components", path).front() != 1)
                bad_file(path, "each voxel has {} values: clvr renders scalar volumes, extract one", channels);
            c.type = *sample;
            if (lower_case(lines.next()).rfind("lookup_table", 0) != 0) bad_file(path, "expected LOOKUP_TABLE after SCALARS");
            break;
        } else {
            bad_file(path, "the VTK data are {:.40}: clvr reads SCALARS of POINT_DATA in STRUCTURED_POINTS", line);
        }
    }
    if (!sized) bad_file(path, "the VTK header has no DIMENSIONS");
    const CheckedDims dims = check_dims(c.dims, 1, c.type, path);
    if (points != dims.bytes / sample_bytes(c.type))
        bad_file(path, "POINT_DATA {} does not fit DIMENSIONS {} x {} x {}", points, c.dims[0], c.dims[1], c.dims[2]);
    if (!spaced) c.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    c.offset = lines.position();
    return decode_with_itk(ItkReader::vtk, c, path, "VTK image", options.frame);
}

} // namespace clvr
