// The `clvr` program: registers the subcommands.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "runtime/error.hpp"
#include "runtime/program_end.hpp"
#include "runtime/source.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>

namespace {

/// Everything that is no result goes to stderr: "clvr: warning: ..." unless --quiet, details with --verbose.
void log_to_stderr() {
    auto logger = spdlog::stderr_color_mt("clvr");
    logger->set_pattern("%n: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

int run(int argc, char** argv) {
    log_to_stderr();
    CLI::App app("clvr renders scientific and medical volumes by path tracing on any OpenCL device.");
    app.name("clvr");
    app.fallthrough();            // global options are understood after the subcommand, too
    app.require_subcommand(0, 1); // none is told apart below from an unknown one
    app.set_version_flag("--version", CLVR_VERSION);
    clvr::reads_files(
        app.set_config("--config", "", "Read options from an INI or TOML file, those of a subcommand in its [section]")->type_name("FILE"));
    app.parse_complete_callback([&app] { clvr::check_files(app); });
    app.allow_config_extras(CLI::config_extras_mode::error);
    app.add_option_function<std::string>("--kernel-dir", clvr::set_kernel_dir,
                                         "Folder whose OpenCL files replace the built-in ones of the same path")
        ->type_name("DIR");
    app.add_flag_callback(
        "-v,--verbose", [] { spdlog::set_level(spdlog::level::debug); }, "Say more about what is done");
    app.add_flag_callback(
        "-q,--quiet", [] { spdlog::set_level(spdlog::level::err); }, "Say nothing but errors");
    clvr::add_devices_command(app);
    clvr::add_info_command(app);
    clvr::add_render_command(app);
    clvr::add_denoise_command(app);
    clvr::add_pairs_command(app);
    clvr::add_compare_command(app);
    clvr::add_train_command(app);
    clvr::add_eval_command(app);
    clvr::add_dataset_command(app);
    clvr::add_experiment_command(app);
    clvr::add_ablation_command(app);
    clvr::add_selftest_command(app);
    try {
        app.parse(argc, argv);
        if (app.get_subcommands().empty()) throw CLI::RequiredError("A subcommand");
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // help and version
        std::string what = error.what();
        std::replace(what.begin(), what.end(), '\n', ' ');
        throw clvr::Error(clvr::ErrorKind::usage, what + " (see clvr --help)");
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) { return clvr::run_program("clvr", run, argc, argv); }
