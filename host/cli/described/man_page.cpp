#include "host/cli/described/man_page.hpp"
#include "host/cli/described/option_text.hpp"

#include <algorithm>
#include <cctype>

namespace clvr {

namespace {

/// Text as roff takes it literally: no escapes, hyphens that can be copied, no line that is a request.
std::string roff(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if ((out.empty() || out.back() == '\n') && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else if (c == '`' || c == '\'')
            out += c == '`' ? "\\(ga" : "\\(aq";
        else
            out += c;
    }
    return out;
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

std::string page_name(const CLI::App& command) {
    std::string name = full_name(command);
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

std::string entries(const std::vector<OptionText>& options) {
    std::string text;
    for (const OptionText& o : options) {
        text += ".TP\n";
        std::string names;
        for (const auto& name : o.names) names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
        if (o.positional && o.several) names += "...";
        if (!o.positional && !o.flag()) names += " \\fI" + roff(o.value) + "\\fR";
        text += names + "\n" + roff(o.description) + "\n";
    }
    return text;
}

/// Arguments, then options by group; `heading` begins a section for each.
std::string arguments(const CLI::App& command, const std::string& heading) {
    std::vector<OptionText> positionals;
    for (const OptionText& o : options_of(command))
        if (o.positional) positionals.push_back(o);
    std::string text;
    if (!positionals.empty()) text += heading + "ARGUMENTS\n" + entries(positionals);
    for (const auto& [group, options] : option_groups(command)) text += heading + roff(upper(group)) + "\n" + entries(options);
    return text;
}

std::string usage(const CLI::App& command) {
    std::string text = ".nf\n";
    for (const auto& line : usage_lines(command)) text += roff(line) + "\n";
    return text + ".fi\n";
}

std::string footer(const CLI::App& command, const std::string& heading) {
    std::string text;
    for (const FooterSection& section : footer_of(command)) {
        text += heading + roff(upper(section.heading)) + "\n.nf\n";
        for (const auto& line : section.lines) text += roff(line) + "\n";
        text += ".fi\n";
    }
    return text;
}

std::string page(const CLI::App& command, const std::string& version) {
    std::string text = ".TH " + roff(upper(page_name(command))) + " 1 \"\" \"" + roff(version) + "\" \"\"\n";
    text += ".SH NAME\n" + roff(page_name(command)) + " \\- " + roff(command.get_description()) + "\n";
    text += ".SH SYNOPSIS\n" + usage(command);
    const bool program = !command.get_parent();
    for (const CLI::App* c : commands_of(command)) {
        if (c == commands_of(command).front()) text += ".SH COMMANDS\n";
        text += program ? ".TP\n\\fB" + roff(page_name(*c)) + "\\fR(1)\n" + roff(c->get_description()) + "\n"
                        : ".SS " + roff(full_name(*c)) + "\n" + roff(c->get_description()) + ".\n.PP\n" + usage(*c) + ".PP\n" +
                              arguments(*c, ".PP\n") + footer(*c, ".PP\n");
    }
    text += arguments(command, ".SH ") + footer(command, ".SH ");
    if (!program) text += ".SH SEE ALSO\n\\fB" + roff(page_name(*command.get_parent())) + "\\fR(1)\n";
    return text;
}

} // namespace

std::map<std::string, std::string> man_pages(const CLI::App& program, const std::string& version) {
    std::map<std::string, std::string> pages{{page_name(program) + ".1", page(program, version)}};
    for (const CLI::App* command : commands_of(program)) pages[page_name(*command) + ".1"] = page(*command, version);
    return pages;
}

} // namespace clvr
