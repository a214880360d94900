// Which options name files that a command reads, and which ones it writes: declared beside the option, checked in one place before any
// command begins.
#pragma once
#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// The files that a command writes where an option has this value: the value itself, unless told otherwise.
using WrittenFiles = std::function<std::vector<std::string>(const std::string& value)>;

/// The values of these options are files or folders that the command reads.
void reads_files(CLI::App& command, const std::vector<std::string>& options);
/// The command writes files by the values of this option.
void writes_files(CLI::App& command, const std::string& option, WrittenFiles files = {});

/// What was declared of an option.
struct FileOption {
    bool read = false, written = false;
    WrittenFiles files;
};
FileOption file_option(const CLI::Option* option);

/// Of the options that were given on this command line: throws Error{usage} where a file that is written is one that is read, or written
/// by another option, too (host/io/file_roles.hpp). For the program's parse_complete_callback, which comes before the commands'.
void check_files(const CLI::App& program);

} // namespace clvr
