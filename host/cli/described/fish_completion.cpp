#include "host/cli/described/completion.hpp"

namespace clvr {

namespace {

/// The text in single quotes; fish knows two escapes inside.
std::string fish_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        out += c;
    }
    return out + "'";
}

std::string words_argument(const ValueChoices& c) {
    std::string words;
    for (const auto& word : c.words) words += (words.empty() ? "" : " ") + word;
    return words.empty() ? "" : " -a " + fish_quoted(words);
}

} // namespace

std::string fish_completion(const CLI::App& program, const Placeholders& placeholders) {
    const auto commands = completed_commands(program);
    const std::string name = program.get_name(), at = "_" + function_name(name) + "_at";
    std::string text = "# Completes " + name + " in fish; written by `" + name + " --completion fish`.\n";
    text += "function " + at +
            " -d 'Whether the line names this command'\n    set -l path ''\n    for word in (commandline -opc)[2..]\n"
            "        if contains -- \"$path $word\"";
    for (const auto& c : commands)
        if (!c.path.empty()) text += " " + fish_quoted(c.path);
    text += "\n            set path \"$path $word\"\n        end\n    end\n    test \"$path\" = \"$argv[1]\"\nend\n";
    for (const auto& c : commands) {
        const std::string rule = "complete -c " + name + " -n " + fish_quoted(at + " \"" + c.path + "\"");
        for (const CLI::App* inner : c.commands)
            text += rule + " -a " + fish_quoted(inner->get_name()) + " -d " + fish_quoted(inner->get_description()) + "\n";
        bool files = c.path.empty() && !c.commands.empty(); // clvr VOLUME
        for (const OptionText& o : c.options) {
            const ValueChoices choices = choices_of(o, placeholders);
            if (o.positional) {
                if (!choices.words.empty()) text += rule + words_argument(choices) + "\n";
                files |= choices.files || choices.folders;
                continue;
            }
            text += rule;
            for (const auto& n : o.names) text += n[1] == '-' ? " -l " + n.substr(2) : " -s " + n.substr(1);
            if (!o.flag()) text += (choices.files || choices.folders ? " -r -F" : " -x") + words_argument(choices);
            text += " -d " + fish_quoted(o.description) + "\n";
        }
        if (!files) text += rule + " -f\n";
    }
    return text;
}

} // namespace clvr
