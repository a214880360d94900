#include "host/cli/described/help.hpp"
#include "host/cli/described/option_text.hpp"

namespace clvr {

namespace {

constexpr std::size_t columns = 80, indent = 26;

/// "  NAME   description", the description wrapped beside the name, or below a long one.
std::string entry(const std::string& name, const std::string& description) {
    std::string text = "  " + name;
    const auto lines = wrapped(description, columns - indent);
    if (text.size() + 2 > indent) text += "\n";
    for (const auto& line : lines) {
        const std::size_t begin = text.rfind('\n') == text.npos ? 0 : text.rfind('\n') + 1;
        text += std::string(indent - (text.size() - begin), ' ') + line + "\n";
    }
    return text;
}

class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override { return help_text(*app); }
};

} // namespace

std::string help_text(const CLI::App& command) {
    std::string text;
    for (const auto& line : wrapped(command.get_description() + ".", columns)) text += line + "\n";
    std::string lead = "\nUsage: ";
    for (const auto& line : usage_lines(command)) {
        text += lead + line + "\n";
        lead = "       ";
    }
    std::string arguments;
    for (const OptionText& option : options_of(command))
        if (option.positional) arguments += entry(option.usage(), option.description);
    if (!arguments.empty()) text += "\n" + arguments;
    std::string group;
    for (const CLI::App* c : commands_of(command)) {
        if (c->get_group() != group) text += "\n" + (group = c->get_group()) + ":\n";
        text += entry(c->get_name(), c->get_description());
    }
    for (const auto& [name, options] : option_groups(command)) {
        text += "\n" + name + ":\n";
        for (const OptionText& option : options) text += entry(option.usage(), option.description);
    }
    for (const FooterSection& section : footer_of(command)) {
        text += "\n" + section.heading + ":\n";
        for (const auto& line : section.lines) text += (line.empty() ? "" : "  ") + line + "\n";
    }
    return text;
}

void use_help_text(CLI::App& app) {
    app.formatter(std::make_shared<HelpFormatter>());
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) use_help_text(*command);
}

} // namespace clvr
