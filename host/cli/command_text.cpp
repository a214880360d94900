#include "host/cli/command_text.hpp"

namespace clvr {

std::string command_text(const CLI::App& command) {
    std::string text = "clvr " + command.get_name(), options;
    const auto quoted = [](const std::string& value) {
        const bool plain = !value.empty() && value.find_first_of(" \t\"'\\$&|;<>()*?`#~!") == value.npos;
        return plain ? value : "'" + value + "'";
    };
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0 || option->check_name("--output") || option->check_name("--json")) continue;
        if (option->get_positional()) {
            for (const auto& value : option->results()) text += " " + quoted(value);
            continue;
        }
        const bool flag = option->get_items_expected_max() == 0;
        for (const auto& value : flag ? std::vector<std::string>{""} : option->results())
            options += " " + option->get_name() + (flag ? "" : " " + quoted(value));
    }
    return text + options;
}

} // namespace clvr
