#include "host/cli/file_options.hpp"
#include "host/io/file_roles.hpp"

#include <map>
#include <utility>

namespace clvr {

namespace {

/// By the option's address and name: once a program is gone, an option of another one may have the same address.
using Declared = std::map<std::pair<const CLI::Option*, std::string>, FileOption>;

Declared& declared() {
    static Declared all;
    return all;
}

FileOption& declare(const CLI::Option* option) { return declared()[{option, option->get_name()}] = {}; }

/// Calls visit(option) for those of the program and of the commands that were called.
template <class Visit>
void each_given(const CLI::App& app, Visit&& visit) {
    for (const CLI::Option* option : app.get_options())
        if (option->count() > 0) visit(option);
    for (const CLI::App* command : app.get_subcommands()) each_given(*command, visit);
}

} // namespace

void reads_files(CLI::App& command, const std::vector<std::string>& options) {
    for (const std::string& option : options) declare(command.get_option(option)).read = true;
}

void writes_files(CLI::App& command, const std::string& option, WrittenFiles files) {
    if (!files) files = [](const std::string& value) { return std::vector{value}; };
    FileOption& role = declare(command.get_option(option));
    role.written = true;
    role.files = std::move(files);
}

FileOption file_option(const CLI::Option* option) {
    const auto found = declared().find({option, option->get_name()});
    return found == declared().end() ? FileOption() : found->second;
}

void check_files(const CLI::App& program) {
    each_given(program, [](const CLI::Option* option) {
        if (!file_option(option).read) return;
        for (const std::string& value : option->results()) will_read(value, option->get_name());
    });
    each_given(program, [](const CLI::Option* option) {
        const FileOption role = file_option(option);
        if (!role.written) return;
        for (const std::string& value : option->results())
            for (const std::string& file : role.files(value)) will_write(file, option->get_name());
    });
}

} // namespace clvr
