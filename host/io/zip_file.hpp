// ZIP archives.
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace clvr {

/// Writes an archive whose members are stored as they are: pictures are packed already. The same members give the same bytes. It is whole
/// after finish().
class ZipWriter {
public:
    /// Throws Error{input} when no file can be made there.
    explicit ZipWriter(const std::string& path);
    ~ZipWriter();
    ZipWriter(const ZipWriter&) = delete;
    ZipWriter& operator=(const ZipWriter&) = delete;
    /// Throw Error{input} when the disk is full.
    void add(const std::string& name, const std::vector<unsigned char>& bytes);
    void finish();

private:
    struct File;
    std::string path_;
    std::unique_ptr<File> file_;
};

} // namespace clvr
