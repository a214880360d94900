#include "host/io/dicom/load.hpp"
#include "host/io/dicom/pixels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace clvr {

namespace {

/// How stored pixels become voxels.
struct VoxelScale {
    bool tables = false;   ///< through each file's modality table, to whole numbers
    bool physical = false; ///< to f32, as slices differ in scale
    SampleType type = SampleType::f32;
    double slope = 1, intercept = 0;
};

VoxelScale scale_of(const std::vector<const DicomFrame*>& used) {
    const DicomFrame& first = *used.front();
    const auto all = [&](auto&& f) { return std::all_of(used.begin(), used.end(), [&](const DicomFrame* s) { return f(*s); }); };
    VoxelScale scale;
    if (all([](const DicomFrame& s) { return s.image->lut.has_value(); })) {
        scale.tables = true;
        scale.type = all([](const DicomFrame& s) { return s.image->lut->bits == 8; }) ? SampleType::u8 : SampleType::u16;
    } else if (all([&](const DicomFrame& s) { return !s.image->lut && s.slope == first.slope && s.intercept == first.intercept; })) {
        scale.type = first.image->pixels.type();
        scale.slope = first.slope;
        scale.intercept = first.intercept;
    } else {
        scale.physical = true; // PET scales each slice by itself
    }
    return scale;
}

void check_scale(const std::vector<const DicomFrame*>& used, Voxels& v) {
    std::set<const DicomFrame*> zero;
    for (const DicomFrame* s : used) {
        if (!std::isfinite(s->slope) || !std::isfinite(s->intercept))
            bad_file(s->image->path, "RescaleSlope {:g}, RescaleIntercept {:g}: both must be finite", s->slope, s->intercept);
        if (s->slope == 0 && !s->image->lut) zero.insert(s);
    }
    if (zero.size() == std::set<const DicomFrame*>(used.begin(), used.end()).size())
        bad_file(used.front()->image->path, "RescaleSlope is 0: every voxel would have the same value");
    if (!zero.empty())
        v.notes.push_back(fmt::format("{} slice{} RescaleSlope 0: all their voxels have the same value", zero.size(),
                                      zero.size() == 1 ? " has" : "s have"));
}

/// Which voxels are padding, until the least of the others is known.
struct PaddingMask {
    std::vector<bool> voxels; ///< empty: none so far
    std::set<std::pair<double, double>> values;

    void add(std::size_t first, const std::vector<bool>& slice, const DicomFrame& f, std::size_t count) {
        if (std::find(slice.begin(), slice.end(), true) == slice.end()) return;
        voxels.resize(count, false);
        for (std::size_t i = 0; i < slice.size(); ++i)
            if (slice[i]) voxels[first + i] = true;
        values.emplace(f.image->padding->low, f.image->padding->high);
    }
};

/// Padding voxels take the least physical value of the others.
void fill_padding(Voxels& v, const PaddingMask& mask) {
    if (mask.voxels.empty()) return;
    const auto& [low, high] = *mask.values.begin();
    std::string text = low == high ? fmt::format("padding {:g}", low) : fmt::format("padding {:g} to {:g}", low, high);
    if (mask.values.size() > 1) text += fmt::format(" and {} other values", mask.values.size() - 1);
    const auto padded = static_cast<std::size_t>(std::count(mask.voxels.begin(), mask.voxels.end(), true));
    if (padded == v.count()) {
        v.notes.push_back(fmt::format("{}: all {} voxels are padding, taken as stored", text, padded));
        return;
    }
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        T* const voxels = reinterpret_cast<T*>(v.bytes.data());
        T least = std::numeric_limits<T>::max(), greatest = std::numeric_limits<T>::lowest(), least_padding = least,
          greatest_padding = greatest;
        for (std::size_t i = 0; i < v.count(); ++i) {
            T& low_end = mask.voxels[i] ? least_padding : least;
            T& high_end = mask.voxels[i] ? greatest_padding : greatest;
            low_end = std::min(low_end, voxels[i]);
            high_end = std::max(high_end, voxels[i]);
        }
        const T fill = v.slope < 0 ? greatest : least;
        for (std::size_t i = 0; i < v.count(); ++i)
            if (mask.voxels[i]) voxels[i] = fill;
        text += fmt::format(": {} voxel{} the minimum, {:g}", padded, padded == 1 ? " takes" : "s take",
                            v.slope * static_cast<double>(fill) + v.intercept);
        if (greatest_padding > least && least_padding < greatest) // the value might be a measured one, too
            v.notes.push_back(text + " (it lies among the values of the other voxels)");
        else
            v.decisions.push_back(text);
    });
}

/// Loads slices into a volume.
class SliceLoader {
public:
    SliceLoader(DicomPixelReader& reader, const VoxelScale& scale) : reader_(reader), scale_(scale) {}

    /// Stores the reader's next slice, which is `f`, as the voxels from `first` on; sets `padding` where the slice has any.
    void operator()(const DicomFrame& f, Voxels& v, std::size_t first, std::vector<bool>& padding) {
        const SampleType type = f.image->pixels.type();
        std::vector<bool>* const marks = f.image->padding ? &padding : nullptr;
        padding.clear();
        if (!scale_.tables && !scale_.physical && is_kept(type)) return reader_.next(v.bytes.data() + first * sample_bytes(type), marks);
        scratch_.resize(f.count() * sample_bytes(type));
        reader_.next(scratch_.data(), marks);
        if (f.image->lut) return look_up(f, v, first);
        store_samples(scratch_.data(), type, f.count(), v, first);
        if (!scale_.physical) return;
        float* const values = reinterpret_cast<float*>(v.bytes.data()) + first;
        for (std::size_t i = 0; i < f.count(); ++i) values[i] = static_cast<float>(f.slope * double{values[i]} + f.intercept);
    }

private:
    void look_up(const DicomFrame& f, Voxels& v, std::size_t first) {
        const DicomLut& lut = *f.image->lut;
        Voxels stored; // a table's index may have 32 bits; f32 holds all that a table tells apart
        stored.type = VoxelType::f32;
        stored.bytes.resize(f.count() * sizeof(float));
        store_samples(scratch_.data(), f.image->pixels.type(), f.count(), stored, 0);
        const double last = static_cast<double>(lut.values.size() - 1);
        with_voxel_type(v.type, [&](auto zero) {
            using T = decltype(zero);
            T* const to = reinterpret_cast<T*>(v.bytes.data()) + first;
            for (std::size_t i = 0; i < f.count(); ++i) {
                const double index = std::clamp(double{stored.data<float>()[i]} - lut.first, 0.0, last);
                to[i] = static_cast<T>(lut.values[static_cast<std::size_t>(index)]);
            }
        });
    }

    DicomPixelReader& reader_;
    const VoxelScale& scale_;
    std::vector<unsigned char> scratch_;
};

/// Voxels first .. first + n - 1 of `v` move by `share` of the way to those of `other`; integers are rounded.
void blend(Voxels& v, std::size_t first, const Voxels& other, std::size_t n, double share) {
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        T* const low = reinterpret_cast<T*>(v.bytes.data()) + first;
        const T* const high = other.data<T>();
        for (std::size_t i = 0; i < n; ++i) {
            const double value = static_cast<double>(low[i]) + share * (static_cast<double>(high[i]) - static_cast<double>(low[i]));
            low[i] = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
        }
    });
}

void read_voxels(const std::vector<DicomFrame>& frames, const Arrangement& a, const std::vector<const DicomFrame*>& order,
                 const VoxelScale& scale, Voxels& v) {
    DicomPixelReader reader(order);
    SliceLoader load(reader, scale);
    allocate(v);
    const std::size_t pixels = order.front()->count();
    Voxels other; // the upper of two slices to blend
    other.type = v.type;
    other.bytes.resize(pixels * voxel_bytes(v.type));
    PaddingMask mask;
    std::vector<bool> padding;
    for (std::size_t k = 0; k < a.slices.size(); ++k) {
        const SlicePlace& p = a.slices[k];
        load(frames[p.low], v, k * pixels, padding);
        mask.add(k * pixels, padding, frames[p.low], v.count());
        if (p.share == 0) continue;
        load(frames[p.high], other, 0, padding);
        mask.add(k * pixels, padding, frames[p.high], v.count());
        blend(v, k * pixels, other, pixels, p.share);
    }
    fill_padding(v, mask);
}

} // namespace

void load_slices(const std::vector<DicomFrame>& frames, const Arrangement& a, Voxels& v, const std::string& path) {
    std::vector<const DicomFrame*> order;
    for (const SlicePlace& p : a.slices) {
        order.push_back(&frames[p.low]);
        if (p.share > 0) order.push_back(&frames[p.high]);
    }
    const DicomFrame& first = *order.front();
    const DicomPixels& pixels = first.image->pixels;
    check_scale(order, v);
    const VoxelScale scale = scale_of(order);
    v.type = kept_type(scale.type);
    if (!is_kept(pixels.type()) && !scale.tables)
        v.notes.push_back(fmt::format("the file's {} voxels are kept as f32 (24 bits of precision)", sample_type_name(pixels.type())));
    if (scale.physical) v.notes.push_back("the slices are scaled differently: kept as f32 physical values");
    if (pixels.inverse) v.notes.push_back("the file shows its smallest values as white (MONOCHROME1): values are taken as stored");
    v.slope = scale.slope;
    v.intercept = scale.intercept;
    v.geometry = a.geometry;
    check_geometry(v.geometry, path);
    v.dims = check_dims({first.columns, first.rows, static_cast<std::int64_t>(a.slices.size())}, 1, scale.type, path).dims;
    for (const DicomFrame* s : order) {
        const DicomImage& image = *s->image;
        if (!image.file.encapsulated && image.file.pixel_bytes < image.frames * image.pixels.bytes())
            bad_file(image.path, "expected {} bytes of pixels, found {}: the file is truncated", image.frames * image.pixels.bytes(),
                     image.file.pixel_bytes);
    }
    read_voxels(frames, a, order, scale, v);
}

} // namespace clvr
