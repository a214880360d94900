#include "host/cli/described/single_values.hpp"

namespace clvr {

void take_single_values(CLI::App& app) {
    for (CLI::Option* option : app.get_options([](CLI::Option*) { return true; }))
        if (!option->get_positional()) option->allow_extra_args(false);
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) take_single_values(*command);
}

} // namespace clvr
