#include "host/cli/described/share_files.hpp"
#include "host/cli/described/completion.hpp"
#include "host/cli/described/man_page.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace clvr {

namespace {

void write(const std::filesystem::path& path, const std::string& text) {
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed) throw Error(ErrorKind::input, "cannot be made: " + failed.message(), path.parent_path().string());
    write_atomically(path.string(), text);
}

void write_share_files(const CLI::App& program, const std::string& version, const Placeholders& placeholders, const std::string& folder) {
    const std::filesystem::path share(folder);
    const std::string name = program.get_name();
    for (const auto& [file, text] : man_pages(program, name + " " + version)) write(share / "man/man1" / file, text);
    write(share / "bash-completion/completions" / name, completion("bash", program, placeholders));
    write(share / "zsh/vendor-completions" / ("_" + name), completion("zsh", program, placeholders));
    write(share / "fish/vendor_completions.d" / (name + ".fish"), completion("fish", program, placeholders));
}

} // namespace

void add_share_options(CLI::App& program, const std::string& version, const Placeholders& placeholders) {
    program
        .add_option_function<std::string>(
            "--completion",
            [&program, placeholders](const std::string& shell) {
                fmt::print("{}", completion(shell, program, placeholders));
                throw CLI::Success();
            },
            "Print a script that completes " + program.get_name() + "'s words in this shell, and exit")
        ->type_name("bash|zsh|fish");
    program
        .add_option_function<std::string>(
            "--share-files",
            [&program, version, placeholders](const std::string& folder) {
                write_share_files(program, version, placeholders, folder);
                throw CLI::Success();
            },
            "Write manual pages and completions into this folder, and exit")
        ->type_name("DIR")
        ->group("");
}

} // namespace clvr
