// Files and folders that must not outlive the process, however it ends.
#pragma once
#include <string>

namespace clvr {

/// A file or folder that is removed, with all that is in it, on destruction and by remove_temporaries(), unless it was given up before.
/// Where the file system has locks, it is locked as long as its process lives, so that remove_stale() knows those of processes that were
/// killed.
class Temporary {
public:
    Temporary() = default;
    /// A new empty file `<folder>/.clvr-<process>-<random>-<count>.tmp`; empty, and errno set, where none can be made.
    static Temporary file_in(const std::string& folder);
    /// A new empty folder `<folder>/clvr-<purpose>-XXXXXX`; empty, and errno set, where none can be made.
    static Temporary folder_in(const std::string& folder, const std::string& purpose);
    Temporary(Temporary&& other) noexcept { swap(other); }
    Temporary& operator=(Temporary&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Temporary();

    const std::string& path() const { return path_; } ///< empty: there is none
    /// It has another name now, or is to stay.
    void give_up();

private:
    std::string path_;
    int lock_ = -1; // descriptor

    void swap(Temporary& other) noexcept;
};

/// Removes every Temporary; from then on no new one can be made. For the end of the process.
void remove_temporaries() noexcept;

/// Removes what killed processes left in the folder (what Temporary::file_in or folder_in, with this purpose, makes there). Once a folder
/// in the life of the process; what cannot be removed is left.
void remove_stale_files(const std::string& folder);
void remove_stale_folders(const std::string& folder, const std::string& purpose);

} // namespace clvr
