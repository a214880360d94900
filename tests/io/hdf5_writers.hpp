// HDF5 files through libhdf5's C API.
#pragma once
#include "tests/io/volume_writers.hpp"

#include <hdf5.h>

namespace clvr::test {

template <class T>
hid_t hdf5_type() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
    if constexpr (std::is_same_v<T, std::int16_t>) return H5T_NATIVE_INT16;
    if constexpr (std::is_same_v<T, std::uint16_t>) return H5T_NATIVE_UINT16;
    if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
    if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
    if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
}

/// A file that is written until the end of the object's life. Groups on the way to an object are made.
class Hdf5Writer {
public:
    explicit Hdf5Writer(const std::string& path, std::uint64_t user_block = 0) {
        std::filesystem::create_directories(std::filesystem::path(path).parent_path());
        const hid_t create = H5Pcreate(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
        if (user_block) H5Pset_userblock(create, user_block);
        H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST); // the smallest files
        file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create, access);
        H5Pclose(access), H5Pclose(create);
        links_ = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(links_, 1);
    }
    ~Hdf5Writer() { H5Pclose(links_), H5Fclose(file_); }
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;

    hid_t file() const { return file_; }
    void group(const std::string& path) { H5Gclose(H5Gcreate2(file_, path.c_str(), links_, H5P_DEFAULT, H5P_DEFAULT)); }
    /// dims: slowest first. `chunk`: empty for contiguous values; gzip, shuffle on chunks. `stored`: the type in the file, or T's own.
    template <class T>
    void dataset(const std::string& path, const std::vector<hsize_t>& dims, const std::vector<T>& values,
                 const std::vector<hsize_t>& chunk = {}, bool packed = false, hid_t stored = -1) {
        const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr), create = H5Pcreate(H5P_DATASET_CREATE);
        if (!chunk.empty()) H5Pset_chunk(create, static_cast<int>(chunk.size()), chunk.data());
        if (packed) H5Pset_shuffle(create), H5Pset_deflate(create, 6);
        const hid_t set = H5Dcreate2(file_, path.c_str(), stored < 0 ? hdf5_type<T>() : stored, space, links_, create, H5P_DEFAULT);
        if (!values.empty()) H5Dwrite(set, hdf5_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Dclose(set), H5Pclose(create), H5Sclose(space);
    }
    void numbers(const std::string& object, const std::string& name, const std::vector<double>& values) {
        attribute(object, name, H5T_NATIVE_DOUBLE, values.size(), values.data());
    }
    void text(const std::string& object, const std::string& name, const std::string& value) {
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, value.size());
        attribute(object, name, type, 1, value.data());
        H5Tclose(type);
    }
    /// As Imaris writes: an array of one letter each.
    void letters(const std::string& object, const std::string& name, const std::string& value) {
        attribute(object, name, H5T_C_S1, value.size(), value.data());
    }
    /// Texts of any length, as h5py writes labels of axes.
    void texts(const std::string& object, const std::string& name, const std::vector<std::string>& values) {
        std::vector<const char*> pointers;
        for (const std::string& v : values) pointers.push_back(v.c_str());
        const hid_t type = H5Tcopy(H5T_C_S1);
        H5Tset_size(type, H5T_VARIABLE);
        attribute(object, name, type, pointers.size(), pointers.data());
        H5Tclose(type);
    }

private:
    void attribute(const std::string& object, const std::string& name, hid_t type, std::size_t count, const void* values) {
        const hsize_t n = count;
        const hid_t owner = H5Oopen(file_, object.c_str(), H5P_DEFAULT), space = H5Screate_simple(1, &n, nullptr);
        const hid_t id = H5Acreate2(owner, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(id, type, values);
        H5Aclose(id), H5Sclose(space), H5Oclose(owner);
    }

    hid_t file_, links_;
};

inline std::vector<hsize_t> hdf5_dims(const Sample& s) {
    return {static_cast<hsize_t>(s.dims[2]), static_cast<hsize_t>(s.dims[1]), static_cast<hsize_t>(s.dims[0])};
}

/// One data set "/volume": contiguous, or in chunks of 2 x 3 x 4 with shuffle and gzip.
inline void write_hdf5(const std::string& path, const Sample& s, bool packed) {
    Hdf5Writer h(path);
    std::vector<hsize_t> chunk;
    if (packed)
        chunk = {std::min<hsize_t>(2, hdf5_dims(s)[0]), std::min<hsize_t>(3, hdf5_dims(s)[1]), std::min<hsize_t>(4, hdf5_dims(s)[2])};
    h.dataset("/volume", hdf5_dims(s), s.voxels, chunk, packed);
}

/// Imaris: the voxels of time t and channel c are those of `s` plus 10 t + c, padded by 2, 1 and 3 along z, y and x with -9.
inline void write_imaris(const std::string& path, const Sample& s, int times = 1, int channels = 1) {
    Hdf5Writer h(path);
    h.group("/DataSetInfo/Image");
    for (std::size_t i = 0; i < 3; ++i) {
        const double low = s.geometry.origin[i] - s.geometry.spacing[i] / 2;
        h.letters("/DataSetInfo/Image", std::string(1, "XYZ"[i]), std::to_string(s.dims[i]));
        h.letters("/DataSetInfo/Image", fmt::format("ExtMin{}", i), fmt::format("{}", 1e3 * low));
        h.letters("/DataSetInfo/Image", fmt::format("ExtMax{}", i), fmt::format("{}", 1e3 * (low + s.geometry.spacing[i] * s.dims[i])));
    }
    h.letters("/DataSetInfo/Image", "Unit", "um");
    const Int3 padded{s.dims[0] + 3, s.dims[1] + 1, s.dims[2] + 2};
    for (int t = 0; t < times; ++t)
        for (int c = 0; c < channels; ++c) {
            std::vector<std::int16_t> values(static_cast<std::size_t>(padded[0]) * padded[1] * padded[2], -9);
            for (int k = 0; k < s.dims[2]; ++k)
                for (int j = 0; j < s.dims[1]; ++j)
                    for (int i = 0; i < s.dims[0]; ++i)
                        values[(static_cast<std::size_t>(k) * padded[1] + j) * padded[0] + i] =
                            static_cast<std::int16_t>(s.voxels[(static_cast<std::size_t>(k) * s.dims[1] + j) * s.dims[0] + i] + 10 * t + c);
            const auto size = [&](int i) { return static_cast<hsize_t>(padded[i]); };
            h.dataset(fmt::format("/DataSet/ResolutionLevel 0/TimePoint {}/Channel {}/Data", t, c), {size(2), size(1), size(0)}, values,
                      {size(2), size(1), size(0)}, true);
        }
}

/// MINC 2: axes z, y, x with the geometry of `s`, RAS; x runs the other way, so its step is negative. Real values are the stored ones
/// times 2 minus 5; with `slicewise`, slice k's are times 2 + k.
inline void write_minc(const std::string& path, const Sample& s, bool slicewise = false) {
    Hdf5Writer h(path);
    const std::string image = "/minc-2.0/image/0/image", low = image + "-min", high = image + "-max";
    h.dataset(image, hdf5_dims(s), s.voxels);
    h.text(image, "dimorder", "zspace,yspace,xspace");
    h.numbers(image, "valid_range", {-1000, 2000});
    std::vector<double> least, greatest;
    for (int k = 0; k < (slicewise ? s.dims[2] : 1); ++k) least.push_back((2 + k) * -1000.0 - 5), greatest.push_back((2 + k) * 2000.0 - 5);
    h.dataset(low, {least.size()}, least);
    h.dataset(high, {greatest.size()}, greatest);
    const Double3 to_ras{-1, -1, 1};
    Matrix3 axes; // columns: unit steps in RAS
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes.row[i][j] = to_ras[i] * s.geometry.direction.row[i][j] * (j == 0 ? -1 : 1);
    const Double3 o = s.geometry.origin, start = axes.inverse() * Double3{-o[0], -o[1], o[2]};
    for (int j = 0; j < 3; ++j) {
        const std::string dimension = fmt::format("/minc-2.0/dimensions/{}space", "xyz"[j]);
        h.dataset(dimension, {1}, std::vector<std::int32_t>{0});
        h.numbers(dimension, "start", {start[j]});
        h.numbers(dimension, "step", {s.geometry.spacing[j] * (j == 0 ? -1 : 1)});
        h.numbers(dimension, "direction_cosines", {axes.row[0][j], axes.row[1][j], axes.row[2][j]});
    }
}

} // namespace clvr::test
