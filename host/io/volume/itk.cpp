#include "host/io/volume/itk.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <iostream>
#include <itkMetaImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVTKImageIO.h>
#include <sstream>

namespace clvr {

namespace {

/// ITK and MetaIO talk on std::cerr and std::cout; what is wrong is said by Error alone.
class QuietStreams {
public:
    QuietStreams() : cerr_(std::cerr.rdbuf(sink_.rdbuf())), cout_(std::cout.rdbuf(sink_.rdbuf())) {
        itk::Object::SetGlobalWarningDisplay(false);
    }
    ~QuietStreams() {
        std::cerr.rdbuf(cerr_);
        std::cout.rdbuf(cout_);
    }
    QuietStreams(const QuietStreams&) = delete;
    QuietStreams& operator=(const QuietStreams&) = delete;

private:
    std::ostringstream sink_;
    std::streambuf *cerr_, *cout_;
};

itk::ImageIOBase::Pointer make_reader(ItkReader reader) {
    switch (reader) {
    case ItkReader::nrrd:
        return itk::NrrdImageIO::New().GetPointer();
    case ItkReader::metaimage:
        return itk::MetaImageIO::New().GetPointer();
    case ItkReader::vtk:
        return itk::VTKImageIO::New().GetPointer();
    }
    throw std::logic_error("ITK reader");
}

std::optional<SampleType> sample_type(itk::IOComponentEnum t) {
    switch (t) {
    case itk::IOComponentEnum::UCHAR:
        return SampleType::u8;
    case itk::IOComponentEnum::CHAR:
        return SampleType::i8;
    case itk::IOComponentEnum::USHORT:
        return SampleType::u16;
    case itk::IOComponentEnum::SHORT:
        return SampleType::i16;
    case itk::IOComponentEnum::UINT:
        return SampleType::u32;
    case itk::IOComponentEnum::INT:
        return SampleType::i32;
    case itk::IOComponentEnum::ULONG:
    case itk::IOComponentEnum::ULONGLONG:
        return SampleType::u64;
    case itk::IOComponentEnum::LONG:
    case itk::IOComponentEnum::LONGLONG:
        return SampleType::i64;
    case itk::IOComponentEnum::FLOAT:
        return SampleType::f32;
    case itk::IOComponentEnum::DOUBLE:
        return SampleType::f64;
    default:
        return std::nullopt;
    }
}

/// Where ITK's understanding of the header and clvr's part, neither can be trusted.
void compare(const itk::ImageIOBase& io, const Container& c, const std::string& path) {
    FileDims dims{1, 1, 1};
    std::int64_t frames = c.frames_interleaved ? io.GetNumberOfComponents() : 1;
    for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i) (i < 3 ? dims[i] : frames) = static_cast<std::int64_t>(io.GetDimensions(i));
    const bool scalar = c.frames_interleaved || io.GetNumberOfComponents() == 1;
    if (dims != c.dims || frames != c.frames || !scalar || sample_type(io.GetComponentType()) != c.type)
        bad_file(path, "the header is ambiguous: clvr reads {} x {} x {} x {} {}, ITK {} x {} x {} x {} {} of {} components", c.dims[0],
                 c.dims[1], c.dims[2], c.frames, sample_type_name(c.type), dims[0], dims[1], dims[2], frames,
                 io.GetComponentTypeAsString(io.GetComponentType()), io.GetNumberOfComponents());
}

Geometry geometry(const itk::ImageIOBase& io, double unit_mm) {
    Geometry g;
    for (unsigned j = 0; j < 3 && j < io.GetNumberOfDimensions(); ++j) {
        g.spacing[j] = io.GetSpacing(j) * unit_mm;
        g.origin[j] = io.GetOrigin(j) * unit_mm;
        const std::vector<double> axis = io.GetDirection(j);
        for (std::size_t i = 0; i < 3; ++i) g.direction.row[i][j] = i < axis.size() ? axis[i] : 0.0;
        // A negative spacing points the axis the other way.
        if (g.spacing[j] < 0) {
            g.spacing[j] = -g.spacing[j];
            for (auto& row : g.direction.row) row[j] = -row[j];
        }
        // Some files keep their scale in the matrix.
        if (const double length = norm(g.direction.column(static_cast<int>(j)));
            length > 0 && std::isfinite(length) && std::abs(length - 1) > 1e-6) {
            g.spacing[j] *= length;
            for (auto& row : g.direction.row) row[j] /= length;
        }
    }
    return g;
}

/// Keeps one frame of all, at the front of the buffer.
void keep_frame(std::vector<unsigned char>& bytes, const Container& c, std::size_t frame_bytes, std::size_t frame) {
    if (c.frames == 1) return;
    const std::size_t size = sample_bytes(c.type), stride = size * static_cast<std::size_t>(c.frames);
    if (c.frames_interleaved)
        for (std::size_t i = 0; i < frame_bytes / size; ++i)
            std::memmove(bytes.data() + i * size, bytes.data() + i * stride + frame * size, size);
    else
        std::memmove(bytes.data(), bytes.data() + frame * frame_bytes, frame_bytes);
    bytes.resize(frame_bytes);
    bytes.shrink_to_fit();
}

std::string first_line(std::string text) {
    const auto mark = text.rfind("ERROR: ");
    if (mark != std::string::npos) text.erase(0, mark + 7);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// Counts numbers until `expected`; another kind of word is an error.
std::uint64_t count_numbers(ByteStream& stream, std::uint64_t expected, bool may_be_nan, const std::string& path) {
    std::vector<char> piece(1 << 16);
    std::string word;
    std::uint64_t count = 0;
    const auto end_word = [&] {
        if (word.empty()) return;
        const auto value = parse_numbers(word);
        if (!value || value->size() != 1 || (!std::isfinite(value->front()) && !may_be_nan))
            bad_file(path, "voxel {} is \"{:.20}\": expected a finite number", count, word);
        word.clear();
        ++count;
    };
    while (count < expected) {
        const std::size_t n = stream.read(piece.data(), piece.size());
        for (std::size_t i = 0; i < n && count < expected; ++i) {
            if (std::isspace(static_cast<unsigned char>(piece[i])))
                end_word();
            else if (word.size() < 64)
                word += piece[i];
        }
        if (n == 0) {
            end_word();
            break;
        }
    }
    return count;
}

} // namespace

void check_payload(const Container& c, const std::string& path) {
    const CheckedDims dims = check_dims(c.dims, c.frames, c.type, path);
    const bool deflated = c.coding == Container::Coding::deflated;
    ByteStream stream(c.data_path, deflated ? ByteStream::Coding::deflated : ByteStream::Coding::plain, c.offset);
    if (c.coding == Container::Coding::text) {
        const std::uint64_t expected = dims.bytes / sample_bytes(c.type);
        check_capacity(expected, (stream.capacity() + 1) / 2, c.data_path); // a digit and a blank each
        if (const auto found = count_numbers(stream, expected, c.text_may_be_nan, c.data_path); found < expected)
            bad_file(c.data_path, "expected {} voxels as text, found {}: the file is truncated", expected, found);
        return;
    }
    check_capacity(dims.bytes, stream.capacity(), c.data_path);
    if (deflated && stream.drain() != dims.bytes)
        bad_file(c.data_path, "expected {} bytes of voxels, found {} after decompression: the file is damaged or its header is wrong",
                 dims.bytes, stream.position());
}

Voxels decode_with_itk(ItkReader reader, const Container& c, const std::string& path, const std::string& format, int frame) {
    check_frame(frame, c.frames, path);
    check_payload(c, path);
    Voxels v;
    describe(v, path, format, c.type);
    v.notes.insert(v.notes.end(), c.notes.begin(), c.notes.end());
    v.slope = c.slope;
    v.intercept = c.intercept;
    v.modality = c.modality;
    const CheckedDims dims = check_dims(c.dims, c.frames, c.type, path);
    try {
        const QuietStreams quiet;
        const auto io = make_reader(reader);
        io->SetFileName(path);
        io->ReadImageInformation();
        compare(*io, c, path);
        v.geometry = geometry(*io, c.unit_mm);
        check_geometry(v.geometry, path);

        itk::ImageIORegion all(io->GetNumberOfDimensions());
        for (unsigned i = 0; i < io->GetNumberOfDimensions(); ++i) all.SetSize(i, io->GetDimensions(i));
        io->SetIORegion(all);
        v.dims = dims.dims;
        std::vector<unsigned char> bytes;
        allocate_bytes(bytes, dims.bytes, path);
        io->Read(bytes.data());
        keep_frame(bytes, c, dims.frame_bytes, static_cast<std::size_t>(frame));
        if (sample_bytes(c.type) == voxel_bytes(v.type)) { // widened, if at all, in place
            v.bytes = std::move(bytes);
            if (!is_kept(c.type)) store_samples(v.bytes.data(), c.type, v.count(), v, 0);
        } else {
            allocate(v);
            store_samples(bytes.data(), c.type, v.count(), v, 0);
        }
    } catch (const itk::ExceptionObject& e) {
        bad_file(path, "ITK cannot decode it: {}", first_line(e.GetDescription()));
    }
    return v;
}

} // namespace clvr
