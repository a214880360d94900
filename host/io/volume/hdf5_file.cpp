#include "host/io/volume/hdf5_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <hdf5.h>
#include <map>

namespace clvr {

namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));
constexpr std::uint64_t filter_ratio = 1032; // the greatest ratio of the accepted HDF5 filters, but for constant chunks
constexpr std::size_t greatest_attribute = std::size_t{1} << 20;

/// An identifier of the library, closed at the end; negative where opening failed.
class Id {
public:
    Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~Id() {
        if (id_ >= 0) close_(id_);
    }
    Id(const Id&) = delete;
    Id& operator=(const Id&) = delete;
    operator hid_t() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

H5I_type_t kind_of(hid_t file, const std::string& object) {
    const Id id(H5Oopen(file, object.c_str(), H5P_DEFAULT), H5Oclose);
    return id ? H5Iget_type(id) : H5I_BADID;
}

struct ValueType {
    std::optional<SampleType> type;
    std::string name;
};

ValueType integer_type(hid_t type) {
    static const std::map<std::size_t, std::pair<SampleType, SampleType>> types{{1, {SampleType::u8, SampleType::i8}},
                                                                                {2, {SampleType::u16, SampleType::i16}},
                                                                                {4, {SampleType::u32, SampleType::i32}},
                                                                                {8, {SampleType::u64, SampleType::i64}}};
    const auto found = types.lower_bound(H5Tget_size(type));
    if (found == types.end()) return {std::nullopt, "integers of more than 64 bits"};
    const SampleType t = H5Tget_sign(type) == H5T_SGN_NONE ? found->second.first : found->second.second;
    return {t, sample_type_name(t)};
}

ValueType value_type(hid_t type) {
    switch (H5Tget_class(type)) {
    case H5T_INTEGER:
        return integer_type(type);
    case H5T_ENUM: { // booleans of h5py
        const Id base(H5Tget_super(type), H5Tclose);
        return base ? integer_type(base) : ValueType{std::nullopt, "enumerations"};
    }
    case H5T_FLOAT: {
        const SampleType t = H5Tget_size(type) <= 4 ? SampleType::f32 : SampleType::f64;
        return {t, sample_type_name(t)};
    }
    case H5T_STRING:
        return {std::nullopt, "texts"};
    case H5T_COMPOUND:
        return {std::nullopt, "compounds (complex numbers or records)"};
    case H5T_BITFIELD:
        return {std::nullopt, "bit fields"};
    default:
        return {std::nullopt, "no numbers"};
    }
}

hid_t memory_type(SampleType t) {
    switch (t) {
    case SampleType::u8:
        return H5T_NATIVE_UINT8;
    case SampleType::i8:
        return H5T_NATIVE_INT8;
    case SampleType::u16:
        return H5T_NATIVE_UINT16;
    case SampleType::i16:
        return H5T_NATIVE_INT16;
    case SampleType::u32:
        return H5T_NATIVE_UINT32;
    case SampleType::i32:
        return H5T_NATIVE_INT32;
    case SampleType::u64:
        return H5T_NATIVE_UINT64;
    case SampleType::i64:
        return H5T_NATIVE_INT64;
    case SampleType::f64:
        return H5T_NATIVE_DOUBLE;
    default:
        return H5T_NATIVE_FLOAT;
    }
}

std::vector<std::int64_t> dims_of(hid_t space) {
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank <= 0) return {};
    std::vector<hsize_t> dims(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    return {dims.begin(), dims.end()};
}

std::string filter_name(H5Z_filter_t filter, const char* own) {
    static const std::map<H5Z_filter_t, const char*> names{{H5Z_FILTER_DEFLATE, "gzip"},
                                                           {H5Z_FILTER_SZIP, "szip"},
                                                           {307, "bzip2"},
                                                           {32000, "LZF"},
                                                           {32001, "Blosc"},
                                                           {32004, "LZ4"},
                                                           {32008, "bitshuffle"},
                                                           {32013, "ZFP"},
                                                           {32015, "Zstandard"},
                                                           {32017, "SZ"},
                                                           {32026, "Blosc2"}};
    const auto found = names.find(filter);
    return found != names.end() ? found->second : *own ? own : fmt::format("number {}", filter);
}

/// Throws Error{input} naming a filter that is not there.
void check_filters(hid_t properties, const Hdf5Dataset& d, const std::string& path) {
    for (unsigned i = 0, n = static_cast<unsigned>(std::max(0, H5Pget_nfilters(properties))); i < n; ++i) {
        unsigned flags = 0, config = 0;
        std::size_t values = 0;
        char own[64] = {};
        const H5Z_filter_t filter = H5Pget_filter2(properties, i, &flags, &values, nullptr, sizeof own - 1, own, &config);
        if (filter < 0) bad_file(path, "the filters of data set {} cannot be read", d.path);
        if (H5Zfilter_avail(filter) <= 0)
            bad_file(path, "data set {} is compressed with {}, which is not supported here: write it with gzip", d.path,
                     filter_name(filter, own));
    }
}

/// An open attribute with its type and size; `count` is 0 where there is none.
struct Attribute {
    Id object, id, type;
    std::size_t count = 0;

    Attribute(hid_t file, const std::string& name, const std::string& attribute)
        : object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose),
          id(object ? H5Aopen(object, attribute.c_str(), H5P_DEFAULT) : -1, H5Aclose), type(id ? H5Aget_type(id) : -1, H5Tclose) {
        if (!id || !type) return;
        const Id space(H5Aget_space(id), H5Sclose);
        const hssize_t points = space ? H5Sget_simple_extent_npoints(space) : 0;
        const std::size_t size = H5Tget_size(type);
        if (points > 0 && size > 0 && static_cast<std::size_t>(points) <= greatest_attribute / size)
            count = static_cast<std::size_t>(points);
    }
};

} // namespace

Hdf5File::Hdf5File(std::string path) : path_(std::move(path)) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    if (access) H5Pset_file_locking(access, false, true); // locks fail on read-only and network disks
    id_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, access ? static_cast<hid_t>(access) : H5P_DEFAULT);
    if (id_ < 0) bad_file(path_, "libhdf5 cannot open it: the HDF5 file is truncated or damaged, or open for writing elsewhere");
}

Hdf5File::~Hdf5File() { H5Fclose(id_); }

bool Hdf5File::is_group(const std::string& object) const { return kind_of(id_, object) == H5I_GROUP; }
bool Hdf5File::is_dataset(const std::string& object) const { return kind_of(id_, object) == H5I_DATASET; }

void Hdf5File::find_datasets(const std::string& group, int depth, std::vector<Hdf5Dataset>& found, int& visited) const {
    constexpr int deepest = 12, most = 4000; // groups may hold themselves
    const Id id(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
    H5G_info_t info{};
    if (!id || depth > deepest || H5Gget_info(id, &info) < 0) return;
    for (hsize_t i = 0; i < info.nlinks && visited < most; ++i, ++visited) {
        char name[1024] = {};
        if (H5Lget_name_by_idx(id, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT) < 0) continue;
        const std::string object = group + (group.back() == '/' ? "" : "/") + name;
        const H5I_type_t kind = kind_of(id_, object);
        if (kind == H5I_DATASET) found.push_back(dataset(object));
        if (kind == H5I_GROUP) find_datasets(object, depth + 1, found, visited);
    }
}

std::vector<Hdf5Dataset> Hdf5File::datasets(const std::string& group) const {
    std::vector<Hdf5Dataset> found;
    int visited = 0;
    find_datasets(group, 0, found, visited);
    return found;
}

Hdf5Dataset Hdf5File::dataset(const std::string& path) const {
    Hdf5Dataset d;
    d.path = path;
    const Id id(H5Dopen2(id_, path.c_str(), H5P_DEFAULT), H5Dclose);
    const Id space(id ? H5Dget_space(id) : -1, H5Sclose), type(id ? H5Dget_type(id) : -1, H5Tclose);
    if (!id || !space || !type) bad_file(path_, "data set {} cannot be opened", path);
    d.dims = dims_of(space);
    const ValueType value = value_type(type);
    d.type = value.type;
    d.type_name = value.name;
    const Id properties(H5Dget_create_plist(id), H5Pclose);
    if (properties && H5Pget_layout(properties) == H5D_CHUNKED && !d.dims.empty()) {
        std::vector<hsize_t> chunk(d.dims.size());
        if (H5Pget_chunk(properties, static_cast<int>(chunk.size()), chunk.data()) == static_cast<int>(chunk.size()))
            d.chunk_dims.assign(chunk.begin(), chunk.end());
    }
    return d;
}

std::vector<double> Hdf5File::numbers(const std::string& object, const std::string& attribute) const {
    const Attribute a(id_, object, attribute);
    if (a.count == 0 || !value_type(a.type).type) return {};
    std::vector<double> values(a.count);
    if (H5Aread(a.id, H5T_NATIVE_DOUBLE, values.data()) < 0) return {};
    return values;
}

std::vector<std::string> Hdf5File::texts(const std::string& object, const std::string& attribute) const {
    const Attribute a(id_, object, attribute);
    if (a.count == 0 || H5Tget_class(a.type) != H5T_STRING) return {};
    std::vector<std::string> values(a.count);
    if (H5Tis_variable_str(a.type) > 0) {
        std::vector<char*> pointers(a.count, nullptr);
        if (H5Aread(a.id, a.type, pointers.data()) < 0) return {};
        for (std::size_t i = 0; i < a.count; ++i)
            if (pointers[i]) values[i] = pointers[i];
        return values; // the library's copies end with the child
    }
    const std::size_t size = H5Tget_size(a.type);
    std::string all(a.count * size, '\0');
    if (H5Aread(a.id, a.type, all.data()) < 0) return {};
    for (std::size_t i = 0; i < a.count; ++i) {
        values[i] = all.substr(i * size, size);
        values[i].resize(std::min(values[i].size(), values[i].find('\0')));
    }
    return values;
}

std::string Hdf5File::text(const std::string& object, const std::string& attribute) const {
    std::string all;
    for (const std::string& part : texts(object, attribute)) all += part;
    return all;
}

std::vector<double> Hdf5File::values(const std::string& dataset) const {
    const Id id(H5Dopen2(id_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
    const Id space(id ? H5Dget_space(id) : -1, H5Sclose), type(id ? H5Dget_type(id) : -1, H5Tclose);
    const hssize_t count = space ? H5Sget_simple_extent_npoints(space) : 0;
    if (!type || count < 1 || count > 1000000 || !value_type(type).type) return {};
    std::vector<double> values(static_cast<std::size_t>(count));
    if (H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) return {};
    return values;
}

void Hdf5File::check_readable(const Hdf5Dataset& d) const {
    const Id id(H5Dopen2(id_, d.path.c_str(), H5P_DEFAULT), H5Dclose);
    const Id properties(id ? H5Dget_create_plist(id) : -1, H5Pclose);
    if (!properties) bad_file(path_, "data set {} cannot be opened", d.path);
    if (!d.type) bad_file(path_, "the values of data set {} are {}: clvr reads integers and floats", d.path, d.type_name);
    std::uint64_t bytes = sample_bytes(*d.type), chunk_bytes = bytes;
    const auto grow = [&](std::uint64_t& to, std::int64_t n) {
        if (n < 1 || to > (std::uint64_t{1} << 62) / static_cast<std::uint64_t>(n))
            bad_file(path_, "data set {} has the impossible size {}", d.path, fmt::join(d.dims, " x "));
        to *= static_cast<std::uint64_t>(n);
    };
    for (const auto n : d.dims) grow(bytes, n);
    for (const auto n : d.chunk_dims) grow(chunk_bytes, n);

    const H5D_layout_t layout = H5Pget_layout(properties);
    if (layout == H5D_VIRTUAL || H5Pget_external_count(properties) > 0)
        bad_file(path_, "the values of data set {} are in other files (a virtual or external data set): name the file that holds them",
                 d.path);
    check_filters(properties, d, path_);
    const std::uint64_t file_bytes = std::filesystem::file_size(path_),
                        stored = std::min<std::uint64_t>(H5Dget_storage_size(id), file_bytes);
    // What the file stores may be of another size than the samples: whole bytes of any number of bits.
    const Id type(H5Dget_type(id), H5Tclose);
    const std::uint64_t values = bytes / sample_bytes(*d.type), size = std::clamp<std::uint64_t>(H5Tget_size(type), 1, 64);
    if (stored == 0) bad_file(path_, "data set {} is empty: no values were written to it", d.path);
    if (values * size > (layout == H5D_CHUNKED ? stored * filter_ratio : stored))
        bad_file(path_, "data set {} has {} bytes of values, of which {} bytes are stored: most of it is empty, or the file is truncated",
                 d.path, values * size, stored);
    if (layout == H5D_CHUNKED) check_capacity(chunk_bytes, file_bytes * filter_ratio, path_);
}

void Hdf5File::read(const Hdf5Dataset& d, const std::vector<std::uint64_t>& start, const std::vector<std::uint64_t>& count,
                    const Receive& receive) const {
    constexpr std::uint64_t piece_bytes = std::uint64_t{16} << 20;
    const Id id(H5Dopen2(id_, d.path.c_str(), H5P_DEFAULT), H5Dclose);
    const Id space(id ? H5Dget_space(id) : -1, H5Sclose);
    if (!space || !d.type) bad_file(path_, "data set {} cannot be opened", d.path);
    // Pieces of whole chunks along the slowest axis that has an extent: each chunk is decoded once.
    std::size_t axis = 0;
    while (axis + 1 < count.size() && count[axis] == 1) ++axis;
    std::uint64_t row_bytes = sample_bytes(*d.type);
    for (std::size_t i = axis + 1; i < count.size(); ++i) row_bytes *= count[i];
    const std::uint64_t chunk = d.chunk_dims.empty() ? 1 : static_cast<std::uint64_t>(d.chunk_dims[axis]);
    const std::uint64_t rows = std::min(count[axis], chunk * std::max<std::uint64_t>(1, piece_bytes / (row_bytes * chunk)));
    std::vector<unsigned char> piece(static_cast<std::size_t>(rows * row_bytes));
    std::vector<hsize_t> from(start.begin(), start.end()), size(count.begin(), count.end());
    for (std::uint64_t done = 0; done < count[axis]; done += rows) {
        size[axis] = std::min(rows, count[axis] - done);
        from[axis] = start[axis] + done;
        const Id memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
        if (!memory || H5Sselect_hyperslab(space, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr) < 0 ||
            H5Dread(id, memory_type(*d.type), memory, space, H5P_DEFAULT, piece.data()) < 0)
            bad_file(path_, "libhdf5 cannot read data set {}: its values are truncated or damaged", d.path);
        receive(piece.data(), static_cast<std::size_t>(size[axis] * row_bytes));
    }
}

} // namespace clvr
