#include "host/io/zip_file.hpp"
#include "runtime/error.hpp"

#include <minizip/zip.h>
#include <utility>

namespace clvr {

struct ZipWriter::File {
    zipFile zip;
};

ZipWriter::ZipWriter(const std::string& path)
    : path_(path), file_(std::make_unique<File>(File{zipOpen64(path.c_str(), APPEND_STATUS_CREATE)})) {
    if (!file_->zip) throw Error(ErrorKind::input, "cannot be written", path_);
}

ZipWriter::~ZipWriter() {
    if (file_->zip) zipClose(file_->zip, nullptr);
}

void ZipWriter::add(const std::string& name, const std::vector<unsigned char>& bytes) {
    zip_fileinfo info{};
    info.tmz_date.tm_year = 1980, info.tmz_date.tm_mday = 1; // the first day that the format knows
    const bool written = zipOpenNewFileInZip64(file_->zip, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, 0, 0, 0) == ZIP_OK &&
                         zipWriteInFileInZip(file_->zip, bytes.data(), static_cast<unsigned>(bytes.size())) == ZIP_OK &&
                         zipCloseFileInZip(file_->zip) == ZIP_OK;
    if (!written) throw Error(ErrorKind::input, "cannot be written; is the disk full?", path_);
}

void ZipWriter::finish() {
    if (zipClose(std::exchange(file_->zip, nullptr), nullptr) != ZIP_OK)
        throw Error(ErrorKind::input, "cannot be written; is the disk full?", path_);
}

} // namespace clvr
