#include "host/io/model/safetensors.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_fields.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <fstream>

namespace clvr {
using nlohmann::json;
using nlohmann::ordered_json;

namespace {

constexpr std::size_t largest_header = std::size_t{16} << 20;
const std::map<std::string, std::size_t> type_bytes{{"F32", 4}, {"F64", 8}, {"I32", 4}, {"I64", 8}, {"U8", 1}};

template <class T>
std::vector<T> values_of(const Tensor& t, const char* type) {
    if (t.type != type) throw Error(ErrorKind::input, fmt::format("a tensor holds {} values; expected {}", t.type, type));
    std::vector<T> values(t.bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), t.bytes.data(), values.size() * sizeof(T));
    return values;
}

template <class T>
Tensor tensor_of(const char* type, std::vector<std::int64_t> shape, const std::vector<T>& values) {
    Tensor t{type, std::move(shape), {}};
    t.bytes.resize(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(t.bytes.data(), values.data(), t.bytes.size());
    return t;
}

/// Bytes that a tensor of the type and shape takes; refuses what overflows or is negative.
std::size_t checked_bytes(const std::string& name, const std::string& type, const std::vector<std::int64_t>& shape, std::size_t available) {
    const auto size = type_bytes.find(type);
    if (size == type_bytes.end())
        throw Error(ErrorKind::input, fmt::format("tensor {} is of type {}; known are F32 F64 I32 I64 U8", name, type));
    std::size_t bytes = size->second;
    bool empty = false;
    for (const std::int64_t n : shape) {
        if (n < 0) throw Error(ErrorKind::input, fmt::format("tensor {} has a negative size", name));
        empty |= n == 0;
        if (!empty && static_cast<std::size_t>(n) > available / bytes)
            throw Error(ErrorKind::input, fmt::format("tensor {} is larger than the file", name));
        if (!empty) bytes *= static_cast<std::size_t>(n);
    }
    return empty ? 0 : bytes;
}

/// An entry of the header: {"dtype": ..., "shape": [...], "data_offsets": [begin, end]}.
struct Entry {
    std::string name, type;
    std::vector<std::int64_t> shape;
    std::size_t begin = 0, end = 0;

    Entry(const std::string& tensor, const json& object, const std::string& where) : name(tensor) {
        JsonFields fields(object, where, tensor);
        fields.required("dtype");
        fields.get("dtype", type);
        const json &sizes = fields.required("shape"), &offsets = fields.required("data_offsets");
        if (!sizes.is_array() || sizes.size() > 8) fields.fail("shape", "a list of at most 8 sizes");
        for (const auto& n : sizes) {
            if (!n.is_number_integer()) fields.fail("shape", "a list of sizes");
            shape.push_back(n.get<std::int64_t>());
        }
        if (!offsets.is_array() || offsets.size() != 2 || !offsets[0].is_number_unsigned() || !offsets[1].is_number_unsigned())
            fields.fail("data_offsets", "two byte offsets");
        begin = offsets[0].get<std::size_t>(), end = offsets[1].get<std::size_t>();
        fields.done();
    }
};

std::map<std::string, std::string> metadata_of(const json& object, const std::string& where) {
    std::map<std::string, std::string> metadata;
    if (!object.is_object()) throw Error(ErrorKind::input, "__metadata__ is no object", where);
    for (const auto& [key, value] : object.items()) {
        if (!value.is_string()) throw Error(ErrorKind::input, fmt::format("__metadata__: {} is no string", key), where);
        metadata[key] = value.get<std::string>();
    }
    return metadata;
}

} // namespace

std::size_t Tensor::count() const { return bytes.size() / type_bytes.at(type); }
std::vector<float> Tensor::floats() const { return values_of<float>(*this, "F32"); }
std::vector<double> Tensor::doubles() const { return values_of<double>(*this, "F64"); }
std::vector<std::int64_t> Tensor::integers() const { return values_of<std::int64_t>(*this, "I64"); }

Tensor float_tensor(std::vector<std::int64_t> shape, const std::vector<float>& values) {
    return tensor_of("F32", std::move(shape), values);
}
Tensor integer_tensor(std::vector<std::int64_t> shape, const std::vector<std::int64_t>& values) {
    return tensor_of("I64", std::move(shape), values);
}

const Tensor* TensorFile::find(const std::string& name) const {
    const auto at = std::find_if(tensors.begin(), tensors.end(), [&](const auto& t) { return t.first == name; });
    return at == tensors.end() ? nullptr : &at->second;
}

const Tensor& TensorFile::at(const std::string& name) const {
    if (const Tensor* t = find(name)) return *t;
    std::string has;
    for (const auto& [other, t] : tensors) has += " " + other;
    throw Error(ErrorKind::input, fmt::format("lacks the tensor {}; it has{}", name, has.empty() ? " none" : has));
}

TensorFile read_tensors(const std::string& path) {
    check_readable(path);
    std::ifstream in(path, std::ios::binary);
    return parse_tensors({std::istreambuf_iterator<char>(in), {}}, path);
}

TensorFile parse_tensors(const std::string& bytes, const std::string& path) {
    const std::size_t size = bytes.size();
    if (size < 8)
        throw Error(ErrorKind::input, fmt::format("has {} bytes; a safetensors file begins with 8 that say how long its header is", size),
                    path);
    std::uint64_t header_bytes = 0;
    for (int k = 7; k >= 0; --k) header_bytes = header_bytes << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(k)]);
    if (header_bytes > size - 8 || header_bytes > largest_header)
        throw Error(
            ErrorKind::input,
            fmt::format("says its header has {} bytes; the file has {} after it (no safetensors file, or cut off)", header_bytes, size - 8),
            path);
    const std::string text = bytes.substr(8, header_bytes);
    const json header = parse_json(text, path);
    if (!header.is_object()) throw Error(ErrorKind::input, "its header is no JSON object", path);

    TensorFile file;
    std::vector<Entry> entries;
    for (const auto& [name, value] : header.items()) {
        if (name == "__metadata__")
            file.metadata = metadata_of(value, path);
        else
            entries.emplace_back(name, value, path);
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return std::pair(a.begin, a.end) < std::pair(b.begin, b.end); });
    const std::size_t available = size - 8 - header_bytes;
    std::size_t at = 0;
    try {
        for (const Entry& e : entries) {
            const std::size_t expected = checked_bytes(e.name, e.type, e.shape, available);
            if (e.begin != at || e.end < e.begin || e.end - e.begin != expected || e.end > available)
                throw Error(ErrorKind::input, fmt::format("tensor {} lies at bytes {} to {} of {}; expected {} bytes from {} on", e.name,
                                                          e.begin, e.end, available, expected, at));
            at = e.end;
        }
        if (at != available)
            throw Error(ErrorKind::input, fmt::format("holds {} bytes of tensors; its header accounts for {}", available, at));
    } catch (const Error& e) {
        throw Error(ErrorKind::input, e.line(), path);
    }
    for (const Entry& e : entries) {
        const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(8 + header_bytes + e.begin);
        file.tensors.emplace_back(e.name, Tensor{e.type, e.shape, {from, from + static_cast<std::ptrdiff_t>(e.end - e.begin)}});
    }
    return file;
}

void write_tensors(const TensorFile& file, const std::string& path) {
    ordered_json header = ordered_json::object();
    if (!file.metadata.empty()) header["__metadata__"] = file.metadata;
    std::size_t at = 0;
    for (const auto& [name, t] : file.tensors) {
        header[name] = {{"dtype", t.type}, {"shape", t.shape}, {"data_offsets", {at, at + t.bytes.size()}}};
        at += t.bytes.size();
    }
    std::string text = header.dump(-1, ' ', false, json::error_handler_t::replace);
    text.resize((text.size() + 7) / 8 * 8, ' ');
    std::string bytes;
    for (int k = 0; k < 8; ++k) bytes += static_cast<char>(static_cast<std::uint64_t>(text.size()) >> (8 * k) & 0xff);
    bytes += text;
    for (const auto& [name, t] : file.tensors) bytes.append(t.bytes.begin(), t.bytes.end());
    write_atomically(path, bytes.data(), bytes.size());
}

} // namespace clvr
