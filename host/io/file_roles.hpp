// What each file is to this run of the program: no file that is written may be one that is read, or be written twice.
#pragma once
#include <string>

namespace clvr {

/// `path` (or FILE of FILE:/path/of/dataset) is read, or will be. `name` is what the user calls it ("VOLUME", "--tf"; empty for a file that
/// another file names). Throws Error{usage} where the file is written, too. Two paths are the same file where device and inode agree, so
/// links of both kinds do not hide it; a file that does not exist yet is known by its folder and name.
void will_read(const std::string& path, const std::string& name = {});

/// `path` is written, or will be; to be called before anything is written. Throws Error{usage} where the file is read, where something else
/// writes it, or where standard output goes to it. Devices and pipes may be shared.
void will_write(const std::string& path, const std::string& name);

/// Forgets all: for tests, which are many runs in one process.
void forget_file_roles();

} // namespace clvr
