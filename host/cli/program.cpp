#include "host/cli/program.hpp"
#include "host/appearance/transfer_function.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/described/help.hpp"
#include "host/cli/described/share_files.hpp"
#include "host/cli/described/single_values.hpp"
#include "host/cli/file_options.hpp"
#include "host/dataset/manifest.hpp"
#include "host/phantom/phantom.hpp"
#include "host/selftest/selftest.hpp"
#include "runtime/opencl/source.hpp"

#include <spdlog/spdlog.h>

namespace clvr {

namespace {

void add_shared_options(CLI::App& app) {
    app.set_version_flag("--version", CLVR_VERSION, "Print the version and exit");
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.set_config("--config", "", "Read options from an INI or TOML file, those of a command in its [section]")->type_name("FILE");
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.add_option_function<std::string>("--kernel-dir", set_kernel_dir,
                                         "Folder whose OpenCL files replace the built-in ones of the same path")
        ->type_name("DIR");
    reads_files(app, {"--config", "--kernel-dir"});
    app.add_flag_callback(
        "-v,--verbose", [] { spdlog::set_level(spdlog::level::debug); }, "Say more about what is done");
    app.add_flag_callback(
        "-q,--quiet", [] { spdlog::set_level(spdlog::level::err); }, "Say nothing but errors");
    add_share_options(app, CLVR_VERSION, placeholders());
}

} // namespace

void add_program(CLI::App& app) {
    app.description("clvr renders scientific and medical volumes by path tracing on any OpenCL device");
    app.name("clvr");
    app.fallthrough();            // shared options are understood after the command, too
    app.require_subcommand(0, 1); // none: main prints the help
    add_shared_options(app);
    add_render_command(app);
    add_view_command(app);
    add_info_command(app);
    add_denoise_command(app);
    add_compare_command(app);
    add_dataset_command(app);
    add_devices_command(app);
    add_selftest_command(app);
    add_pairs_command(app);
    add_train_command(app);
    add_eval_command(app);
    add_experiment_command(app);
    add_ablation_command(app);
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) command->group("Commands");
    for (const char* name : {"pairs", "train", "eval", "experiment", "ablation"}) app.get_subcommand(name)->group("Commands for training");
    app.footer("Examples:\n"
               "  clvr scan.nii.gz                      # writes scan.png beside it\n"
               "  clvr render scans/ -o knee.png --denoise --spp 4\n"
               "  clvr view scan.nii.gz                 # turn it in a browser\n"
               "  clvr info scan.nii.gz\n"
               "  clvr render --help                    # all options of a command\n"
               "Exit codes:\n"
               "  0 done, 2 wrong usage, 3 bad input, 4 no such device, 5 out of memory,\n"
               "  6 internal error, 130 interrupted\n");
    take_single_values(app);
    app.parse_complete_callback([&app] { check_files(app); });
    use_help_text(app);
}

Placeholders placeholders() {
    Placeholders all;
    for (const Preset& preset : transfer_presets()) all["PRESET"].push_back(preset.name);
    all["COMPUTED"] = phantom_names();
    for (const auto& name : phantom_names()) all["DEMO"].push_back("demo:" + name);
    for (const Dataset& d : datasets()) all["DATASET"].push_back(d.name);
    for (const auto* check : selftest::chosen_checks({})) all["CHECK"].push_back(check->name);
    all["SEL"] = {"cpu", "gpu", "all"};
    return all;
}

} // namespace clvr
