// Completions for shells from CLI11's description of a program.
#pragma once
#include "host/cli/described/option_text.hpp"

#include <string>

namespace clvr {

/// A script that completes commands, options, and their values: words, files or folders (choices_of). Hidden options are left out.
std::string bash_completion(const CLI::App& program, const Placeholders& placeholders);
std::string zsh_completion(const CLI::App& program, const Placeholders& placeholders);
std::string fish_completion(const CLI::App& program, const Placeholders& placeholders);

/// The script of a shell by its name. Throws Error{usage} for another than bash, zsh and fish.
std::string completion(const std::string& shell, const CLI::App& program, const Placeholders& placeholders);

/// A command as completions look at it.
struct CompletedCommand {
    const CLI::App* app;
    std::string path; ///< "" for the program itself, " dataset make" for that command
    std::vector<OptionText> options;
    std::vector<const CLI::App*> commands;
};
/// The program, its commands, and their commands. The program's own options are valid for all commands, so each lists them, too.
std::vector<CompletedCommand> completed_commands(const CLI::App& program);

/// "clvr-bench" as the name of a shell function: "_clvr_bench".
std::string function_name(const std::string& program);

/// The text in single quotes for bash and zsh.
std::string single_quoted(const std::string& text);

} // namespace clvr
