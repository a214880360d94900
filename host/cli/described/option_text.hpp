// CLI11's description of a command as help, manual pages and completions need it.
#pragma once
#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

namespace clvr {

/// An option or a positional argument.
struct OptionText {
    std::vector<std::string> names; ///< "-o", "--output"; of a positional its name alone, "VOLUME"
    std::string value;              ///< type name: "FILE", "path|dvr|mip"; empty for a flag
    std::string group, description;
    bool positional = false, required = false;
    bool several = false; ///< may be given more than once

    bool flag() const { return value.empty(); }
    /// "-o, --output FILE", "VOLUME".
    std::string usage() const;
};

/// All that are not hidden, in the order in which they were added, but --help last.
std::vector<OptionText> options_of(const CLI::App& command);
/// The same without positionals, by group; --help and its like are in "Options", the last group.
std::vector<std::pair<std::string, std::vector<OptionText>>> option_groups(const CLI::App& command);
/// The subcommands in their order; hidden ones are left out.
std::vector<const CLI::App*> commands_of(const CLI::App& app);
/// "clvr dataset make".
std::string full_name(const CLI::App& command);
/// "clvr render [OPTION...] VOLUME", a line for each way of use.
std::vector<std::string> usage_lines(const CLI::App& command);

/// A heading of a command's footer and the lines under it. A footer is written as "Heading:\n  line\n  line\nHeading:\n ...".
struct FooterSection {
    std::string heading;
    std::vector<std::string> lines; ///< without the two spaces
};
std::vector<FooterSection> footer_of(const CLI::App& command);

/// Placeholders in type names and the values that stand for them: {"PRESET", {"ct-bone", ...}}.
using Placeholders = std::map<std::string, std::vector<std::string>>;

/// What an argument can be, for completions.
struct ValueChoices {
    std::vector<std::string> words;
    bool files = false, folders = false;
};
/// From the type name: of "auto|PRESET|FILE", "auto" is a word, PRESET a placeholder, FILE (or FILE.html) any file; DIR is any folder.
ValueChoices choices_of(const OptionText& option, const Placeholders& placeholders);

/// The words of a text in lines of at most `width` characters; a longer word has a line of its own.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

} // namespace clvr
