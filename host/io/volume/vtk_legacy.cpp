#include "host/io/volume/vtk_legacy.hpp"
#include "host/io/volume/axes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/text_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace clvr {

namespace {

/// "a%20b" as "a b": VTK writes names so.
std::string decoded_name(const std::string& name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto code = name[i] == '%' && i + 2 < name.size() ? name.substr(i + 1, 2) : std::string();
        if (code.size() == 2 && std::isxdigit(static_cast<unsigned char>(code[0])) && std::isxdigit(static_cast<unsigned char>(code[1]))) {
            text += static_cast<char>(std::stoi(code, nullptr, 16));
            i += 2;
        } else {
            text += name[i];
        }
    }
    return text;
}

class LegacyParser {
public:
    LegacyParser(const std::string& path, std::vector<std::string>& notes)
        : path_(path), notes_(notes), size_(std::filesystem::file_size(path)), file_(path, ByteStream::Coding::plain), lines_(file_, path) {
    }

    LegacyVtk parse() {
        if (next_line().rfind("# vtk DataFile", 0) != 0) bad_file(path_, "not a legacy VTK file: expected \"# vtk DataFile Version ...\"");
        if (!lines_.line()) ends_early(); // the title may be empty
        const std::string coding = lower_case(next_line());
        if (coding != "ascii" && coding != "binary")
            bad_file(path_, "expected ASCII or BINARY in the third line, found \"{:.40}\"", coding);
        vtk_.text = coding == "ascii";
        while (const std::optional<std::string> line = line_or_end())
            if (!take_line(*line)) break;
        if (!sized_) bad_file(path_, "the VTK header has no DIMENSIONS");
        if (vtk_.arrays.empty())
            bad_file(path_, "the VTK file holds no data array of points or cells: it is truncated or has nothing to show");
        return std::move(vtk_);
    }

private:
    [[noreturn]] void ends_early() const { bad_file(path_, "the VTK header ends too early: the file is truncated"); }
    /// The next line that is not empty.
    std::optional<std::string> line_or_end() {
        while (const std::optional<std::string> line = lines_.line())
            if (!trimmed(*line).empty()) return std::string(trimmed(*line));
        return std::nullopt;
    }
    std::string next_line() {
        const auto line = line_or_end();
        if (!line) ends_early();
        return *line;
    }

    /// Returns whether more follows.
    bool take_line(const std::string& line) {
        std::istringstream words(line);
        std::string key, rest;
        words >> key;
        std::getline(words, rest);
        key = lower_case(key);
        if (key == "metadata") {
            pass_metadata();
        } else if (key == "field") {
            take_field(rest);
        } else if (in_data_) {
            return take_attribute(key, rest, line);
        } else {
            take_grid(key, rest, line);
        }
        return true;
    }

    void take_grid(const std::string& key, const std::string& rest, const std::string& line) {
        Geometry& g = vtk_.grid.geometry;
        if (key == "dataset") {
            const std::string kind = lower_case(trimmed(rest));
            if (kind != "structured_points" && kind != "rectilinear_grid")
                bad_file(
                    path_,
                    "the data set is {:.40}: clvr reads STRUCTURED_POINTS (an image) and even RECTILINEAR_GRID, resample it in ParaView",
                    trimmed(rest));
            rectilinear_ = kind == "rectilinear_grid";
        } else if (key == "dimensions") {
            const auto sizes = parse_integers(rest, 3, 1, "DIMENSIONS", path_);
            std::copy_n(sizes.begin(), 3, vtk_.grid.points.begin());
            sized_ = true;
        } else if (key == "extent") {
            take_extent(rest);
        } else if (key == "spacing" || key == "aspect_ratio") {
            const auto spacing = parse_spacing(rest, 3, "SPACING", path_);
            std::copy_n(spacing.begin(), 3, g.spacing.begin());
            vtk_.spaced = true;
        } else if (key == "origin") {
            const auto origin = parse_finite(rest, 3, "ORIGIN", path_);
            std::copy_n(origin.begin(), 3, g.origin.begin());
        } else if (rectilinear_ && (key == "x_coordinates" || key == "y_coordinates" || key == "z_coordinates")) {
            take_coordinates(static_cast<std::size_t>(key[0] - 'x'), rest);
        } else if (key == "point_data" || key == "cell_data") {
            enter_data(key == "cell_data", rest);
        } else {
            bad_file(path_, "the VTK header holds \"{:.40}\": clvr reads images, POINT_DATA or CELL_DATA of STRUCTURED_POINTS", line);
        }
    }

    void take_extent(const std::string& rest) {
        const auto e = parse_integers(rest, 6, -(std::int64_t{1} << 31), "EXTENT", path_);
        for (std::size_t i = 0; i < 3; ++i) {
            vtk_.grid.points[i] = e[2 * i + 1] - e[2 * i] + 1;
            first_[i] = static_cast<double>(e[2 * i]);
        }
        sized_ = true;
    }

    /// Coordinates of a rectilinear grid: even ones make an image.
    void take_coordinates(std::size_t axis, const std::string& rest) {
        std::string count, type_name;
        std::istringstream(rest) >> count >> type_name;
        const auto n = parse_integers(count, 1, 1, "the number of coordinates", path_).front();
        const auto type = type_of(type_name);
        if (!sized_ || n != vtk_.grid.points[axis]) bad_file(path_, "axis {} has {} coordinates, which do not fit its DIMENSIONS", axis, n);
        if (type != SampleType::f32 && type != SampleType::f64)
            bad_file(path_, "the coordinates along axis {} have the type \"{:.40}\": expected float or double", axis, type_name);
        check_left(static_cast<std::uint64_t>(n), *type);
        const std::vector<double> at = coordinates(static_cast<std::size_t>(n), *type);
        const double step = n > 1 ? (at.back() - at.front()) / static_cast<double>(n - 1) : 1;
        for (std::size_t i = 0; i < at.size(); ++i)
            if (!(std::abs(at[i] - (at.front() + static_cast<double>(i) * step)) <= 1e-3 * std::abs(step)))
                bad_file(path_, "the grid is uneven along axis {} (point {} at {:g}): resample it to an image (STRUCTURED_POINTS)", axis, i,
                         at[i]);
        if (step == 0) bad_file(path_, "the coordinates along axis {} are all {:g}", axis, at.front());
        vtk_.grid.geometry.spacing[axis] = step;
        vtk_.grid.geometry.origin[axis] = at.front();
        vtk_.spaced = vtk_.spaced || n > 1;
    }

    std::vector<double> coordinates(std::size_t n, SampleType type) {
        std::vector<double> at(n);
        if (vtk_.text) {
            TextSamples(lines_, SampleType::f64, n, path_).read(at.data(), n * sizeof(double));
            return at;
        }
        std::vector<unsigned char> bytes(n * sample_bytes(type));
        if (lines_.read(bytes.data(), bytes.size()) < bytes.size()) ends_early();
        if (must_swap(true)) swap_samples(bytes.data(), type, n);
        if (type == SampleType::f64) std::memcpy(at.data(), bytes.data(), bytes.size());
        for (std::size_t i = 0; type == SampleType::f32 && i < n; ++i) {
            float x;
            std::memcpy(&x, bytes.data() + i * sizeof(float), sizeof(float));
            at[i] = static_cast<double>(x);
        }
        return at;
    }

    void enter_data(bool cells, const std::string& rest) {
        if (!sized_) bad_file(path_, "the VTK header has no DIMENSIONS");
        if (!in_data_) { // an extent that does not start at 0 moves the first point
            Geometry& g = vtk_.grid.geometry;
            settle_axes(g);
            g.origin = g.to_world(first_);
        }
        const auto n = vtk_.grid.samples(cells);
        tuples_ = static_cast<std::uint64_t>(parse_integers(rest, 1, 1, cells ? "CELL_DATA" : "POINT_DATA", path_).front());
        if (check_dims(n, 1, SampleType::u8, path_).bytes != tuples_)
            bad_file(path_, "{} {} does not fit DIMENSIONS {} x {} x {}", cells ? "CELL_DATA" : "POINT_DATA", tuples_, vtk_.grid.points[0],
                     vtk_.grid.points[1], vtk_.grid.points[2]);
        in_data_ = true;
        cells_ = cells;
    }

    bool take_attribute(const std::string& key, const std::string& rest, const std::string& line) {
        std::string name, second, third;
        std::istringstream(rest) >> name >> second >> third;
        const auto components = [&](const std::string& text) {
            return parse_integers(text, 1, 1, "the number of components", path_).front();
        };
        if (key == "point_data" || key == "cell_data") {
            enter_data(key == "cell_data", rest);
        } else if (key == "scalars") {
            const auto n = third.empty() ? 1 : components(third);
            if (lower_case(next_line()).rfind("lookup_table", 0) != 0) bad_file(path_, "expected LOOKUP_TABLE after SCALARS");
            take_array(name, second, n, tuples_, true);
        } else if (key == "color_scalars") {
            const auto n = components(second);
            take_array(name, "unsigned_char", n, tuples_, true, vtk_.text);
        } else if (key == "lookup_table") {
            pass_values(vtk_.text ? SampleType::f32 : SampleType::u8, 4 * static_cast<std::uint64_t>(components(second)));
        } else if (key == "vectors" || key == "normals") {
            take_array(name, second, 3, tuples_, false);
        } else if (key == "tensors" || key == "tensors6") {
            take_array(name, second, key == "tensors" ? 9 : 6, tuples_, false);
        } else if (key == "texture_coordinates") {
            take_array(name, third, components(second), tuples_, false);
        } else if (key == "global_ids" || key == "pedigree_ids" || key == "edge_flags") {
            take_array(name, second, 1, tuples_, false);
        } else if (vtk_.arrays.empty()) {
            bad_file(path_, "the VTK data are {:.40}: expected SCALARS, VECTORS, FIELD, ...", line);
        } else {
            notes_.push_back(
                fmt::format("{} bytes after the voxels were ignored: is the header right?", size_ - lines_.position() + line.size()));
            return false;
        }
        return true;
    }

    /// "FIELD name n", then n arrays: "name components tuples type" and their values. Outside of POINT_DATA and CELL_DATA they are passed
    /// over.
    void take_field(const std::string& rest) {
        std::string field, count;
        std::istringstream(rest) >> field >> count;
        const auto n = parse_integers(count, 1, 0, "the number of arrays of a FIELD", path_).front();
        for (std::int64_t i = 0; i < n;) {
            const std::string line = next_line();
            std::string name, components, tuples, type;
            std::istringstream(line) >> name >> components >> tuples >> type;
            if (lower_case(name) == "metadata") {
                pass_metadata();
                continue;
            }
            take_array(name, type, parse_integers(components, 1, 0, "the number of components", path_).front(),
                       static_cast<std::uint64_t>(parse_integers(tuples, 1, 0, "the number of tuples", path_).front()), false);
            ++i;
        }
    }

    std::optional<SampleType> type_of(const std::string& name) const {
        const std::string type = lower_case(name);
        if (type == "vtkidtype") return vtk_.text ? SampleType::i64 : SampleType::i32; // VTK writes 32 bits
        return parse_sample_type(type);
    }

    void take_array(const std::string& name, const std::string& type_name, std::int64_t components, std::uint64_t tuples, bool active,
                    bool unit_colors = false) {
        const auto type = type_of(type_name);
        if (components > std::int64_t{1} << 31) bad_file(path_, "the array \"{:.60}\" has {} components", name, components);
        if (in_data_ && tuples == tuples_ && components > 0) {
            const bool first =
                std::none_of(vtk_.arrays.begin(), vtk_.arrays.end(), [&](const VtkArray& a) { return a.active && a.of_cells == cells_; });
            vtk_.arrays.push_back({decoded_name(name), type_name, type, components, cells_, active && first});
            vtk_.places.push_back({lines_.position(), unit_colors});
        }
        if (tuples > 0 && static_cast<std::uint64_t>(components) > (std::uint64_t{1} << 60) / tuples)
            bad_file(path_, "the array \"{:.60}\" has {} x {} values: impossible", name, tuples, components);
        const std::uint64_t values = tuples * static_cast<std::uint64_t>(components);
        if (type)
            pass_values(unit_colors ? SampleType::f32 : *type, values);
        else if (lower_case(type_name) == "bit")
            vtk_.text ? pass_values(SampleType::u8, values) : pass_values(SampleType::u8, (values + 7) / 8);
        else if (lower_case(type_name) == "string")
            pass_strings(values);
        else
            bad_file(path_, "the array \"{:.60}\" has the type \"{:.40}\": expected unsigned_char, short, float, ...", name, type_name);
    }

    /// Throws Error{input} unless what is left of the file can hold so many values.
    void check_left(std::uint64_t values, SampleType type) const {
        const std::uint64_t left = size_ - std::min(size_, lines_.position());
        if (vtk_.text)
            check_capacity(values, (left + 1) / 2, path_);
        else
            check_capacity(values * sample_bytes(type), left, path_);
    }

    void pass_values(SampleType type, std::uint64_t values) {
        check_left(values, type);
        if (!vtk_.text) {
            lines_.skip(values * sample_bytes(type));
            return;
        }
        TextSamples(lines_, type, values, path_).skip(values * sample_bytes(type));
    }

    /// Strings: a line each as text; else a big-endian length, whose first two bits say its size, and the bytes.
    void pass_strings(std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) {
            if (vtk_.text) {
                if (!lines_.line()) ends_early();
                continue;
            }
            unsigned char byte = 0;
            if (lines_.read(&byte, 1) < 1) ends_early();
            std::uint64_t length = byte & 63;
            const int more = (byte >> 6) == 3 ? 0 : (byte >> 6) == 2 ? 1 : (byte >> 6) == 1 ? 3 : 7;
            for (int k = 0; k < more; ++k) {
                if (lines_.read(&byte, 1) < 1) ends_early();
                length = length << 8 | byte;
            }
            if (lines_.skip(length) < length) ends_early();
        }
    }

    /// Up to an empty line.
    void pass_metadata() {
        while (const std::optional<std::string> line = lines_.line())
            if (trimmed(*line).empty()) break;
    }

    std::string path_;
    std::vector<std::string>& notes_;
    std::uint64_t size_;
    FileBytes file_;
    TextLines lines_;
    LegacyVtk vtk_;
    Double3 first_{0, 0, 0}; ///< index of the first point
    bool sized_ = false, rectilinear_ = false, in_data_ = false, cells_ = false;
    std::uint64_t tuples_ = 0;
};

} // namespace

LegacyVtk parse_legacy_vtk(const std::string& path, std::vector<std::string>& notes) { return LegacyParser(path, notes).parse(); }

} // namespace clvr
