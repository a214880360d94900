// The `clvr` program: parses the words, which runs a command.
#include "host/cli/first_word.hpp"
#include "host/cli/program.hpp"
#include "runtime/error.hpp"
#include "runtime/program_end.hpp"
#include "runtime/system/nearest.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace {

/// Everything that is no result goes to stderr: "clvr: warning: ..." unless --quiet, details with --verbose.
void log_to_stderr() {
    auto logger = spdlog::stderr_color_mt("clvr");
    logger->set_pattern("%n: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

/// One line for what CLI11 refuses: an unknown option with the one that may be meant, else CLI11's own words.
std::string refusal(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const std::string name = clvr::full_name(*command);
    for (const std::string& word : app.remaining(true)) {
        if (word.size() < 2 || word[0] != '-') continue;
        std::vector<std::string> names;
        for (const CLI::App* of : {command, &app})
            for (const auto& option : clvr::options_of(*of))
                if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
        const std::string unknown = word.substr(0, word.find('=')), near = clvr::nearest_name(unknown, names);
        const std::string lacks = command == &app ? "there is" : name.substr(name.find(' ') + 1) + " has";
        return fmt::format("{} no option {}{} (see {} --help)", lacks, unknown, near.empty() ? "" : ": did you mean " + near + "?", name);
    }
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    return fmt::format("{} (see {} --help)", what, name);
}

int run(int argc, char** argv) {
    log_to_stderr();
    CLI::App app;
    clvr::add_program(app);
    try {
        std::vector<std::string> words = clvr::with_command(app, {argv + 1, argv + argc});
        std::reverse(words.begin(), words.end()); // as CLI11 takes them
        app.parse(std::move(words));
        if (app.get_subcommands().empty()) std::fputs(app.help().c_str(), stdout);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // help and version
        throw clvr::Error(clvr::ErrorKind::usage, refusal(app, error));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) { return clvr::run_program("clvr", run, argc, argv); }
