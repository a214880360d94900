// The subcommands of `clvr`, one file each; program.cpp registers them all; runtime/program_end.hpp catches Error once.
#pragma once
#include <CLI/CLI.hpp>

namespace clvr {

/// Each adds its subcommand with options and a callback to the app. Callbacks throw Error.
void add_devices_command(CLI::App& app);    // devices.cpp
void add_info_command(CLI::App& app);       // info.cpp
void add_render_command(CLI::App& app);     // render.cpp
void add_view_command(CLI::App& app);       // view.cpp
void add_denoise_command(CLI::App& app);    // denoise.cpp
void add_pairs_command(CLI::App& app);      // pairs.cpp
void add_compare_command(CLI::App& app);    // compare.cpp
void add_train_command(CLI::App& app);      // train.cpp
void add_eval_command(CLI::App& app);       // eval.cpp
void add_dataset_command(CLI::App& app);    // dataset.cpp
void add_ablation_command(CLI::App& app);   // ablation.cpp
void add_experiment_command(CLI::App& app); // experiment.cpp
void add_selftest_command(CLI::App& app);   // selftest.cpp

} // namespace clvr
