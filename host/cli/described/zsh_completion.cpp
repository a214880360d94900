#include "host/cli/described/completion.hpp"

namespace clvr {

namespace {

/// Text inside a specification of _arguments: colons and brackets mean something there.
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

/// ":FILE:_files", ":path|dvr:(path dvr)", both as a block.
std::string argument(const std::string& what, const ValueChoices& c) {
    std::string words, action;
    for (const auto& word : c.words) words += " " + escaped(word);
    const std::string files = c.files ? "_files" : c.folders ? "_files -/" : "";
    if (words.empty())
        action = files.empty() ? " " : files;
    else if (files.empty())
        action = "(" + words.substr(1) + ")";
    else
        action = "{compadd --" + words + "; " + files + "}";
    return ":" + escaped(what) + ":" + action;
}

/// The specifications of a command's options and arguments, a line each.
std::string specifications(const CompletedCommand& command, const Placeholders& placeholders) {
    std::string text;
    for (const OptionText& o : command.options) {
        if (o.positional) {
            text += " \\\n        " + single_quoted((o.several    ? "*"
                                                     : o.required ? ""
                                                                  : ":") +
                                                    argument(o.names.front(), choices_of(o, placeholders)));
            continue;
        }
        std::string all;
        for (const auto& name : o.names) all += (all.empty() ? "" : " ") + name;
        for (const auto& name : o.names) {
            std::string spec = (o.several ? "*" : "(" + all + ")") + name;
            if (!o.flag()) spec += name[1] == '-' ? "=" : "+";
            spec += "[" + escaped(o.description) + "]";
            if (!o.flag()) spec += argument(o.value, choices_of(o, placeholders));
            text += " \\\n        " + single_quoted(spec);
        }
    }
    return text;
}

/// The function of a command that has commands: these, or the arguments of the one that was named.
std::string choosing_function(const CompletedCommand& command, const std::string& function, const Placeholders& placeholders) {
    const bool program = command.path.empty();
    std::string text = function + "() {\n    local curcontext=$curcontext context state state_descr line\n    typeset -A opt_args\n";
    text += "    _arguments -C -s -S" + specifications(command, placeholders) + " \\\n        '1:command:" + function +
            "_commands' '*::: :->rest'\n";
    text += "    [[ $state == rest ]] || return\n    words=($line[1] \"${words[@]}\")\n    (( CURRENT += 1 ))\n    case $line[1] in\n";
    for (const CLI::App* c : command.commands) text += "        " + c->get_name() + ") " + function + "_" + c->get_name() + " ;;\n";
    if (program) text += "        *) " + function + "_" + command.commands.front()->get_name() + " ;;\n"; // clvr VOLUME
    text += "    esac\n}\n" + function + "_commands() {\n    local commands=(";
    for (const CLI::App* c : command.commands) text += "\n        " + single_quoted(escaped(c->get_name()) + ":" + c->get_description());
    return text + ")\n    _describe command commands" + (program ? "\n    _files" : "") + "\n}\n";
}

} // namespace

std::string zsh_completion(const CLI::App& program, const Placeholders& placeholders) {
    const std::string name = program.get_name();
    std::string text = "#compdef " + name + "\n# Completes " + name + " in zsh; written by `" + name + " --completion zsh`.\n";
    for (const auto& c : completed_commands(program)) {
        const std::string function = function_name(name + c.path);
        text += c.commands.empty() ? function + "() {\n    _arguments -s -S" + specifications(c, placeholders) + "\n}\n"
                                   : choosing_function(c, function, placeholders);
    }
    return text + "if [[ $funcstack[1] == " + function_name(name) + " ]]; then " + function_name(name) + " \"$@\"; else compdef " +
           function_name(name) + " " + name + "; fi\n"; // loaded by name, or sourced
}

} // namespace clvr
