// What each file is to this run of the program: no file that is written may be one that is read, or be written twice.
#pragma once
#include <string>

namespace clvr {

/// `path` (or FILE of FILE:/path/of/dataset) is read, or will be. `name` is what the user calls it ("VOLUME", "--tf"; empty: a file that
/// another file names). Throws Error{usage} where it is a file that is written. Files are the same where device and inode are, so links of
/// both kinds are seen through; a file that is not there yet is known by its folder and name.
void will_read(const std::string& path, const std::string& name = {});

/// `path` is written, or will be: said before anything is. Throws Error{usage} where it is a file that is read, one that something else
/// writes, or one that standard output goes to. Devices and pipes may be shared.
void will_write(const std::string& path, const std::string& name);

/// Forgets all: for tests, which are many runs in one process.
void forget_file_roles();

} // namespace clvr
