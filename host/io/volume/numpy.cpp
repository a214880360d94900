// NumPy .npy files, versions 1 to 3 (numpy.org, "numpy.lib.format").
#include "host/io/volume/header_bytes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <map>

namespace clvr {

namespace {

constexpr std::size_t greatest_header = std::size_t{1} << 20;

/// What the header's text says.
struct NumpyHeader {
    std::string descr; ///< the type as "<i2"
    bool fortran = false;
    std::vector<std::int64_t> shape;
    std::uint64_t bytes = 0; ///< of the header: voxels follow
};

/// The values of a Python dictionary of texts, booleans and tuples, as text each: {'a': (1, 2), } gives a -> "(1, 2)".
std::map<std::string, std::string> dictionary(std::string_view text, const std::string& path) {
    const auto broken = [&]() { bad_file(path, "its NumPy header is no dictionary: \"{:.60}\"", trimmed(text)); };
    std::string_view rest = trimmed(text);
    if (rest.size() < 2 || rest.front() != '{' || rest.back() != '}') broken();
    rest = rest.substr(1, rest.size() - 2);
    std::map<std::string, std::string> values;
    while (!(rest = trimmed(rest)).empty()) {
        const char quote = rest.front();
        const auto key_end = quote == '\'' || quote == '"' ? rest.find(quote, 1) : std::string_view::npos;
        const auto colon = key_end == std::string_view::npos ? key_end : rest.find(':', key_end);
        if (colon == std::string_view::npos) broken();
        const std::string key(rest.substr(1, key_end - 1));
        rest = rest.substr(colon + 1);
        std::size_t end = 0;
        int depth = 0;
        char quoted = 0;
        for (; end < rest.size() && (depth > 0 || quoted || rest[end] != ','); ++end) {
            const char c = rest[end];
            if (quoted) {
                if (c == quoted) quoted = 0;
            } else if (c == '\'' || c == '"') {
                quoted = c;
            } else {
                depth += (c == '(' || c == '[' || c == '{') - (c == ')' || c == ']' || c == '}');
            }
        }
        if (depth != 0 || quoted) broken();
        values[key] = trimmed(rest.substr(0, end));
        rest = rest.substr(std::min(end + 1, rest.size()));
    }
    for (const char* key : {"descr", "fortran_order", "shape"})
        if (values.count(key) == 0) bad_file(path, "its NumPy header has no '{}'", key);
    return values;
}

NumpyHeader read_numpy_header(ByteStream& stream, const std::string& path) {
    std::string start(8, '\0');
    if (stream.read(start.data(), 8) < 8 || start.compare(0, 6, "\x93NUMPY") != 0)
        bad_file(path, "not a NumPy file: it does not start with \\x93NUMPY, or is truncated");
    const int version = start[6];
    if (version < 1 || version > 3) bad_file(path, "version {} of the NumPy format is not known: expected 1, 2 or 3", version);
    std::string size(version == 1 ? 2 : 4, '\0');
    if (stream.read(size.data(), size.size()) < size.size()) bad_file(path, "the NumPy header is truncated");
    const HeaderBytes number(size, must_swap(false));
    const std::size_t length = version == 1 ? number.at<std::uint16_t>(0) : number.at<std::uint32_t>(0);
    if (length > greatest_header) bad_file(path, "its NumPy header claims {} bytes: the file is damaged", length);
    std::string text(length, '\0');
    if (const std::size_t got = stream.read(text.data(), length); got < length)
        bad_file(path, "expected a NumPy header of {} bytes, found {}: the file is truncated", length, got);

    const auto values = dictionary(text, path);
    NumpyHeader h;
    h.bytes = stream.position();
    h.descr = values.at("descr");
    const std::string& order = values.at("fortran_order");
    if (order != "True" && order != "False") bad_file(path, "fortran_order is \"{:.20}\": expected True or False", order);
    h.fortran = order == "True";
    std::string text_of_shape = values.at("shape");
    text_of_shape.erase(std::remove(text_of_shape.begin(), text_of_shape.end(), 'L'), text_of_shape.end()); // Python 2 wrote (3L, 4L)
    const auto numbers = parse_numbers(text_of_shape);
    if (!numbers || numbers->size() > 32) bad_file(path, "the shape is \"{:.60}\": expected whole numbers", text_of_shape);
    h.shape = parse_integers(text_of_shape, numbers->size(), 1, "the shape", path);
    return h;
}

/// The type of "'<i2'"; `big` says the byte order.
SampleType sample_type(const std::string& descr, bool& big, const std::string& path) {
    static const std::map<std::string, SampleType> types{{"b1", SampleType::u8},  {"u1", SampleType::u8},  {"i1", SampleType::i8},
                                                         {"u2", SampleType::u16}, {"i2", SampleType::i16}, {"u4", SampleType::u32},
                                                         {"i4", SampleType::i32}, {"u8", SampleType::u64}, {"i8", SampleType::i64},
                                                         {"f2", SampleType::f16}, {"f4", SampleType::f32}, {"f8", SampleType::f64}};
    static const std::map<char, const char*> others{{'c', "complex numbers: store the magnitude, numpy.abs(array)"},
                                                    {'O', "Python objects: store an array of numbers"},
                                                    {'M', "dates: store an array of numbers"},
                                                    {'m', "time differences: store an array of numbers"},
                                                    {'U', "texts: store an array of numbers"},
                                                    {'S', "texts: store an array of numbers"},
                                                    {'V', "records: store one field of them"},
                                                    {'f', "floats of more than 64 bits: store array.astype('f4')"}};
    if (!descr.empty() && descr.front() == '[') bad_file(path, "its items are records (a structured type): store one field, array['name']");
    if (descr.size() < 4 || (descr.front() != '\'' && descr.front() != '"') || descr.back() != descr.front())
        bad_file(path, "its type is \"{:.40}\": expected one such as '<i2'", descr);
    const char order = descr[1];
    const std::string name = descr.substr(2, descr.size() - 3);
    big = order == '>';
    const auto type = types.find(name);
    if (type != types.end() && (order == '<' || order == '>' || order == '=' || order == '|')) return type->second;
    const auto other = others.find(name.front());
    if (other != others.end()) bad_file(path, "its items ('{}') are {}", name, other->second);
    bad_file(path, "its type is {:.40}: expected integers of 8 to 64 bits, booleans, or floats of 16, 32 or 64 bits", descr);
}

} // namespace

Voxels read_numpy(const std::string& path, const VolumeReadOptions& options) {
    ByteStream stream = open_inside(path);
    const NumpyHeader h = read_numpy_header(stream, path);
    bool big = false;
    const SampleType type = sample_type(h.descr, big, path);
    const std::string shape = fmt::format("({})", fmt::join(h.shape, ", "));

    // Axes of one entry in front say nothing; the last three are z, y, x.
    std::vector<std::int64_t> axes = h.shape;
    while (axes.size() > 3 && axes.front() == 1) axes.erase(axes.begin());
    while (axes.size() > 3 && axes.back() == 1) axes.pop_back();
    if (axes.size() < 2 || axes.size() > 4)
        bad_file(path, "the array has the shape {}: expected (z, y, x), (y, x), or (time, z, y, x)", shape);
    if (axes.size() == 4 && axes[3] <= 4 && std::min({axes[0], axes[1], axes[2]}) > 4)
        bad_file(path, "the array has the shape {}, whose last axis looks like channels: store one channel, array[..., 0]", shape);
    if (axes.size() == 2) axes.insert(axes.begin(), 1);
    if (axes.size() == 3) axes.insert(axes.begin(), 1);

    Voxels v;
    describe(v, path, "NumPy", type);
    const CheckedDims dims = check_dims({axes[3], axes[2], axes[1]}, axes[0], type, path);
    v.dims = dims.dims;
    check_frame(options.frame, axes[0], path);
    v.decisions.push_back(fmt::format("the array of shape {} is ({}z, y, x)", shape, axes[0] > 1 ? "time, " : ""));
    v.frames = say_frame(options.frame, axes[0], "the first axis", v.decisions);
    if (type == SampleType::u8 && h.descr.find("b1") != std::string::npos) v.decisions.push_back("booleans are 0 and 1");
    if (type == SampleType::u8 && axes[0] == 1 && (axes[3] == 3 || axes[3] == 4) && std::min(axes[1], axes[2]) > 16)
        v.notes.push_back(fmt::format("the array of shape {} is taken as (z, y, x): is it a colour picture?", shape));
    set_spacing(v, options, std::nullopt);
    check_geometry(v.geometry, path);

    check_capacity(dims.bytes, stream.capacity() - std::min(stream.capacity(), h.bytes), path);
    const auto frame = static_cast<std::uint64_t>(options.frame);
    const bool swapped = must_swap(big);
    if (!h.fortran) {
        stream.skip(dims.frame_bytes * frame);
        read_samples(stream, type, swapped, v);
    } else { // the first axis is the fastest
        const auto n = [&](std::size_t axis) { return static_cast<std::uint64_t>(axes[axis]); };
        const SampleOrder order{frame, {n(0) * n(1) * n(2), n(0) * n(1), n(0)}};
        read_reordered([&](void* to, std::size_t bytes) { return stream.read(to, bytes); }, type, swapped, dims.bytes / sample_bytes(type),
                       order, v);
    }
    stream.drain();
    if (stream.position() < h.bytes + dims.bytes)
        bad_file(path, "expected {} bytes of voxels, found {}: the file is truncated", dims.bytes, stream.position() - h.bytes);
    if (stream.position() > h.bytes + dims.bytes)
        v.notes.push_back(fmt::format("{} bytes after the voxels were ignored", stream.position() - h.bytes - dims.bytes));
    return v;
}

} // namespace clvr
