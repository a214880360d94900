#include "host/cli/described/option_text.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace clvr {

namespace {

constexpr const char* last_group = "Options";

/// CLI11's names of types as a person reads them.
std::string value_name(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (type == "INT" || type == "UINT") return "N";
    return type == "FLOAT" ? "X" : type;
}

OptionText text_of(const CLI::Option& option) {
    OptionText text;
    text.positional = option.get_positional();
    if (text.positional)
        text.names.push_back(option.get_name(true, false));
    else {
        for (const auto& name : option.get_snames()) text.names.push_back("-" + name);
        for (const auto& name : option.get_lnames()) text.names.push_back("--" + name);
    }
    if (option.get_items_expected_max() > 0) text.value = value_name(option);
    text.group = option.get_group();
    text.description = option.get_description();
    text.required = option.get_required();
    text.several = option.get_items_expected_max() > 1;
    return text;
}

} // namespace

std::string OptionText::usage() const {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    if (!positional && !flag()) text += " " + value;
    return positional && several ? text + "..." : text;
}

std::vector<OptionText> options_of(const CLI::App& command) {
    std::vector<OptionText> options, last;
    for (const CLI::Option* option : command.get_options())
        if (!option->get_group().empty()) (option == command.get_help_ptr() ? last : options).push_back(text_of(*option));
    options.insert(options.end(), last.begin(), last.end());
    return options;
}

std::vector<std::pair<std::string, std::vector<OptionText>>> option_groups(const CLI::App& command) {
    std::vector<std::pair<std::string, std::vector<OptionText>>> groups;
    const auto in = [&](const std::string& name) -> std::vector<OptionText>& {
        for (auto& [known, options] : groups)
            if (known == name) return options;
        groups.emplace_back(name, std::vector<OptionText>{});
        return groups.back().second;
    };
    for (const bool last : {false, true})
        for (const OptionText& option : options_of(command))
            if (!option.positional && (option.group == last_group) == last) in(option.group).push_back(option);
    return groups;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App* c) { return !c->get_group().empty(); });
    return commands;
}

std::string full_name(const CLI::App& command) {
    return (command.get_parent() ? full_name(*command.get_parent()) + " " : "") + command.get_name();
}

std::vector<std::string> usage_lines(const CLI::App& command) {
    const std::string name = full_name(command);
    if (!commands_of(command).empty()) {
        std::vector<std::string> lines{name + " COMMAND [OPTION...]"};
        if (!command.get_parent()) lines.push_back(name + " VOLUME [OPTION...]");
        return lines;
    }
    std::string line = name + " [OPTION...]";
    for (const OptionText& option : options_of(command))
        if (option.positional) line += " " + (option.required ? option.usage() : "[" + option.usage() + "]");
    return {line};
}

std::vector<FooterSection> footer_of(const CLI::App& command) {
    std::vector<FooterSection> sections;
    std::istringstream lines(command.get_footer());
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("  ", 0) == 0 && !sections.empty())
            sections.back().lines.push_back(line.substr(2));
        else if (line.empty() && !sections.empty())
            sections.back().lines.emplace_back();
        else if (!line.empty())
            sections.push_back({line.substr(0, line.find_last_not_of(':') + 1), {}});
    }
    for (FooterSection& section : sections)
        while (!section.lines.empty() && section.lines.back().empty()) section.lines.pop_back();
    return sections;
}

ValueChoices choices_of(const OptionText& option, const Placeholders& placeholders) {
    ValueChoices choices;
    std::istringstream parts(option.value);
    for (std::string part; std::getline(parts, part, '|');) {
        const auto known = placeholders.find(part);
        if (known != placeholders.end())
            choices.words.insert(choices.words.end(), known->second.begin(), known->second.end());
        else if (part.rfind("FILE", 0) == 0)
            choices.files = true;
        else if (part == "DIR")
            choices.folders = true;
        else if (std::all_of(part.begin(), part.end(), [](unsigned char c) { return std::islower(c) || std::isdigit(c) || c == '-'; }))
            choices.words.push_back(part);
    }
    return choices;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

} // namespace clvr
