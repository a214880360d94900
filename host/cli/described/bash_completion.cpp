#include "host/cli/described/completion.hpp"

namespace clvr {

namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

/// "words='a b' files=1": what can stand here.
std::string choices(const ValueChoices& c) {
    std::string text = "words=" + single_quoted(joined(c.words));
    if (c.files) text += " files=1";
    if (c.folders) text += " folders=1";
    return text;
}

constexpr const char* begin = R"sh(() {
    local cur=${COMP_WORDS[COMP_CWORD]} at=$COMP_CWORD prev colon= path= words= files= folders= i
    # Bash ends words at "=" and ":" too.
    if [[ $cur == "=" || $cur == ":" ]]; then cur=; else at=$((at - 1)); fi
    case ${COMP_WORDS[at]} in
        "=") prev=${COMP_WORDS[at - 1]} ;;
        ":") colon=${COMP_WORDS[at - 1]}: prev=${COMP_WORDS[at - 2]} ;;
        *) prev=${COMP_WORDS[at]} ;;
    esac
    for ((i = 1; i < COMP_CWORD; i++)); do
        case "$path ${COMP_WORDS[i]}" in
            )sh";

constexpr const char* end = R"sh(    esac
    COMPREPLY=()
    [[ -z $words ]] || mapfile -t COMPREPLY < <(compgen -W "$words" -- "$colon$cur")
    COMPREPLY=("${COMPREPLY[@]#"$colon"}")
    if [[ -n $files$folders ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen "$([[ -n $files ]] && echo -f || echo -d)" -- "${cur//\\/}")
    else
        compopt +o default +o bashdefault 2>/dev/null
    fi
}
)sh";

} // namespace

std::string bash_completion(const CLI::App& program, const Placeholders& placeholders) {
    const auto commands = completed_commands(program);
    const std::string name = program.get_name(), function = function_name(name);
    std::string paths;
    for (const auto& c : commands)
        if (!c.path.empty()) paths += (paths.empty() ? "" : " | ") + ("\"" + c.path + "\"");
    if (paths.empty()) paths = "\"\"";
    std::string text = "# Completes " + name + " in bash; written by `" + name + " --completion bash`.\n" + function + begin + paths +
                       ") path+=\" ${COMP_WORDS[i]}\" ;;\n        esac\n    done\n    case \"$path $prev\" in\n";
    for (const auto& c : commands)
        for (const OptionText& o : c.options) {
            if (o.positional || o.flag()) continue;
            std::string patterns;
            for (const auto& n : o.names) patterns += (patterns.empty() ? "" : " | ") + ("\"" + c.path + " " + n + "\"");
            text += "        " + patterns + ") " + choices(choices_of(o, placeholders)) + " ;;\n";
        }
    text += "        *)\n            case \"$path:$cur\" in\n";
    for (const auto& c : commands) {
        std::vector<std::string> names;
        ValueChoices arguments;
        for (const OptionText& o : c.options) {
            if (!o.positional) {
                names.insert(names.end(), o.names.begin(), o.names.end());
                continue;
            }
            const ValueChoices more = choices_of(o, placeholders);
            arguments.words.insert(arguments.words.end(), more.words.begin(), more.words.end());
            arguments.files |= more.files, arguments.folders |= more.folders;
        }
        for (const CLI::App* inner : c.commands) arguments.words.push_back(inner->get_name());
        if (c.path.empty() && !c.commands.empty()) arguments.files = true; // clvr VOLUME
        text += "                \"" + c.path + ":-\"*) words=" + single_quoted(joined(names)) + " ;;\n";
        text += "                \"" + c.path + ":\"*) " + choices(arguments) + " ;;\n";
    }
    return text + "            esac\n            ;;\n" + end + "complete -o bashdefault -o default -F " + function + " " + name + "\n";
}

} // namespace clvr
