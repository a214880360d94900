#include "host/cli/described/completion.hpp"
#include "runtime/error.hpp"

#include <algorithm>

namespace clvr {

namespace {

void collect(const CLI::App& app, const std::string& path, const std::vector<OptionText>& global, std::vector<CompletedCommand>& all) {
    CompletedCommand command{&app, path, options_of(app), commands_of(app)};
    for (const OptionText& option : global)
        if (std::none_of(command.options.begin(), command.options.end(), [&](const OptionText& o) { return o.names == option.names; }))
            command.options.push_back(option);
    const std::vector<OptionText> inherited = path.empty() ? command.options : global;
    const auto commands = command.commands;
    all.push_back(std::move(command));
    for (const CLI::App* c : commands) collect(*c, path + " " + c->get_name(), inherited, all);
}

} // namespace

std::vector<CompletedCommand> completed_commands(const CLI::App& program) {
    std::vector<CompletedCommand> all;
    collect(program, "", {}, all);
    return all;
}

std::string function_name(const std::string& program) {
    std::string name = "_" + program;
    std::replace(name.begin(), name.end(), '-', '_');
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

std::string single_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string completion(const std::string& shell, const CLI::App& program, const Placeholders& placeholders) {
    if (shell == "bash") return bash_completion(program, placeholders);
    if (shell == "zsh") return zsh_completion(program, placeholders);
    if (shell == "fish") return fish_completion(program, placeholders);
    throw Error(ErrorKind::usage, "is \"" + shell + "\"; expected bash, zsh or fish", "--completion");
}

} // namespace clvr
