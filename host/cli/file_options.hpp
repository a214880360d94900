// Which options name files that a command reads, and which ones it writes: declared beside the option, checked in one place before any
// command begins.
#pragma once
#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// The files that a command writes for a value of this option: the value itself, unless told otherwise.
using WrittenFiles = std::function<std::vector<std::string>(const std::string& value)>;

/// The values of these options are files or folders that the command reads.
void reads_files(CLI::App& command, const std::vector<std::string>& options);
/// The command writes files that the values of this option name.
void writes_files(CLI::App& command, const std::string& option, WrittenFiles files = {});

/// What reads_files and writes_files declared for an option.
struct FileOption {
    bool read = false, written = false;
    WrittenFiles files;
};
FileOption file_option(const CLI::Option* option);

/// Checks the options that were given on this command line: throws Error{usage} where a file is written that is also read, or that another
/// option writes, too (host/io/file_roles.hpp). Made for the program's parse_complete_callback, which runs before the commands' callbacks.
void check_files(const CLI::App& program);

} // namespace clvr
