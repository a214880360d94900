// Files and folders that must not outlive the process, however it ends.
#pragma once
#include <string>

namespace clvr {

/// A file or folder that is removed, with everything in it, on destruction and by remove_temporaries(), unless it was given up before.
/// Where the file system has locks, it is locked as long as its process lives: so remove_stale() can tell which ones killed processes left
/// behind.
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

/// Removes every Temporary; after that no new one can be made. Called at the end of the process.
void remove_temporaries() noexcept;

/// Removes what killed processes left in the folder (files or folders as Temporary::file_in, or folder_in with this purpose, makes them).
/// Works once for each folder in the life of the process. What cannot be removed is left there.
void remove_stale_files(const std::string& folder);
void remove_stale_folders(const std::string& folder, const std::string& purpose);

} // namespace clvr
