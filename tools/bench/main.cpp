// The `clvr-bench` program: measures every device on clvr's real stages, tunes, recommends, remembers.
#include "host/cli/described/help.hpp"
#include "host/cli/described/share_files.hpp"
#include "host/cli/described/single_values.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/io/model/model_file.hpp"
#include "runtime/choose/remembered.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/error.hpp"
#include "runtime/program_end.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/trust/trust.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/bench/live.hpp"
#include "tools/bench/stage.hpp"
#include "tools/bench/view.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace clvr::bench {
namespace {

struct Options {
    std::string selector, json, html, from, volume;
    std::vector<std::string> stages;
    bool quick = false, tune = false, save = false, explain = false, child = false, hashes = false, tiny = false, live = false,
         view = false;
    double soak_seconds = 0;
};

/// What --save keeps: a device per task; the general one is that for rendering.
void save(const Report& report, const std::vector<DeviceFacts>& all) {
    RememberedByTask by_task;
    std::vector<RememberedDevice> general;
    for (const Recommendation& r : report.recommendations) {
        if (r.devices.empty()) throw Error(ErrorKind::device, fmt::format("nothing to remember for {}: {}", r.task, r.reason));
        std::vector<DevicePart> parts;
        for (const std::size_t d : r.devices) parts.push_back({static_cast<std::size_t>(report.devices[d].facts.index), 0});
        const std::vector<RememberedDevice> devices = remember(parts, all);
        if (general.empty())
            general = devices;
        else
            by_task[r.task] = devices;
    }
    save_remembered(general, by_task);
}

void print_recommendations(const Report& report, bool explain) {
    for (const Recommendation& r : report.recommendations) {
        std::string names;
        for (const std::size_t d : r.devices)
            names += fmt::format("{}device {}", names.empty() ? "" : " and ", report.devices[d].facts.index);
        fmt::print("{}: {}: {}.\n", r.task, names.empty() ? "nothing" : names, r.reason);
        if (!explain) continue;
        for (const std::string& line : r.evidence) fmt::print("    {}\n", line);
    }
    if (!explain) return;
    for (const DeviceRows& d : report.devices) {
        const auto shipped = shipped_tuning(d.facts);
        const auto measured = measured_tuning(d.facts);
        if (!shipped && !measured) continue;
        fmt::print("tuning of device {}: {}\n", d.facts.index, d.tuning);
        for (const std::string& line : measured ? measured->evidence : shipped->tuning.evidence) fmt::print("    {}\n", line);
    }
}

void bench_devices(const Options& o) {
    for (const std::string& file : {o.json, o.html})
        if (!file.empty()) check_writable(file); // before minutes of measuring
    for (const std::string& name : o.stages) stage_named(name);
    tunables_from_environment(); // what it refuses is said before minutes of measuring
    const std::vector<DeviceFacts> all = list_devices();
    std::vector<DeviceFacts> devices = all;
    if (!o.selector.empty() || all.empty()) devices = select_devices(o.selector).devices; // says what is wrong where there is none
    if (o.save && (!o.stages.empty() || o.tiny ||
                   std::any_of(devices.begin(), devices.end(), [](const DeviceFacts& d) { return d.sub_devices != 0; })))
        throw Error(ErrorKind::usage, "--save needs whole devices and all stages; leave --stage and parts such as cpu/2 away");
    Child child({std::filesystem::read_symlink("/proc/self/exe").string(), "--child"});
    const Report report = run_bench(devices, {o.quick, o.tune, o.tiny, o.stages}, child, [](const std::string& text) {
        fmt::print("{}", text);
        std::fflush(stdout);
    });
    if (o.hashes)
        for (const DeviceRows& d : report.devices)
            for (const Row& r : d.rows) fmt::print("{:<16} {:<8} {}\n", r.stage, r.size, r.hash.empty() ? r.reason : r.hash);
    if (o.stages.empty()) print_recommendations(report, o.explain);
    const auto write = [](const std::string& file, const std::string& text) {
        if (!file.empty()) write_atomically(file, text.data(), text.size());
    };
    write(o.json, json_text(report_json(report)));
    write(o.html, report_html(report));
    if (o.save) save(report, all);
}

std::vector<std::string> stage_names() {
    std::vector<std::string> names;
    for (const Stage& stage : stages()) names.push_back(stage.name);
    return names;
}

/// A live view on each device: its frames per second and where the time goes, or what a client of `clvr view` sees.
void bench_live(const Options& o) {
    std::vector<DeviceFacts> facts = list_devices();
    if (!o.selector.empty() || facts.empty()) facts = select_devices(o.selector).devices;
    const Model model = read_model("default");
    for (const DeviceFacts& f : facts) {
        std::vector<Device> devices{open_trusted(f)};
        Scene scene = benchmark_scene(640, 640, 1);
        if (!o.volume.empty()) scene.transfer.reset();
        const auto volume = std::make_shared<const PreparedVolume>(o.volume.empty() ? benchmark_volume(o.tiny ? 64 : 256)
                                                                                    : open_volume(o.volume, {}, devices));
        const double seconds = o.tiny ? 0.01 : o.quick ? 2 : 6;
        const int divider = o.tiny ? 8 : 1, rounds = o.tiny ? 1 : o.quick ? 3 : 6;
        std::string table;
        if (o.view) {
            scene.spp = 256; // it has not settled when it is interrupted
            table = view_table(measure_view(devices.front(), volume, scene, model, seconds, rounds, o.soak_seconds, divider));
        } else {
            table = live_table(measure_live(devices.front(), *volume, scene, model, seconds, divider));
        }
        fmt::print("{}, {}:\n{}", f.name, o.volume.empty() ? "a computed volume" : o.volume, table);
        std::fflush(stdout);
    }
}

/// The page of an earlier run's numbers, without measuring.
void make_page_again(const Options& o) {
    if (o.html.empty()) throw Error(ErrorKind::usage, "needs --html, the page to write", "--from");
    const std::string text = read_text(o.from);
    try {
        const std::string html = report_html(report_from_json(nlohmann::json::parse(text)));
        write_atomically(o.html, html.data(), html.size());
    } catch (const nlohmann::json::exception&) {
        throw Error(ErrorKind::input, "is not what clvr-bench --json writes", o.from);
    }
}

int run(int argc, char** argv) {
    Options o;
    CLI::App app("Measures every OpenCL device on clvr's real stages, checks its results, tunes, recommends and remembers");
    app.name("clvr-bench");
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.set_version_flag("--version", CLVR_VERSION, "Print the version and exit");
    add_share_options(app, CLVR_VERSION, {{"SEL", {"cpu", "gpu"}}, {"STAGE", stage_names()}});
    app.footer("Examples:\n"
               "  clvr-bench\n"
               "  clvr-bench --tune --quick\n"
               "  clvr-bench --html bench.html --json bench.json\n"
               "  clvr-bench --save --explain\n");
    app.add_option("--json", o.json, "Write all numbers as JSON")->type_name("FILE")->group("Output");
    app.add_option("--html", o.html, "Write a page with tables, bars and rooflines")->type_name("FILE")->group("Output");
    app.add_option("--from", o.from, "Measure nothing: make the page of --html from what --json wrote")->type_name("FILE")->group("Output");
    reads_files(app, {"--from"});
    writes_files(app, "--json");
    writes_files(app, "--html");
    app.add_flag("--save", o.save, "Remember the recommended devices for the next runs of clvr")->group("Output");
    app.add_flag("--explain", o.explain, "Print the evidence for what is recommended")->group("Output");
    app.add_option("--device", o.selector,
                   "Only this: an index, cpu, gpu, part of a name, cpu/2, several joined by +; every device otherwise")
        ->type_name("SEL")
        ->group("Measuring");
    app.add_option("--stage", o.stages, "Only this stage, as the table names it; may be given again")
        ->type_name("STAGE")
        ->group("Measuring");
    app.add_flag("--live", o.live, "Measure a live view instead: frames per second, and where the time goes")->group("Measuring");
    app.add_flag("--view", o.view, "Measure what a client of clvr view sees instead: pictures per second, delays, bytes")
        ->excludes("--live")
        ->group("Measuring");
    app.add_option("--seconds", o.soak_seconds, "--view: also turn and edit for so long, and compare the memory")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.0, 1e6))
        ->group("Measuring");
    app.add_option("--volume", o.volume, "--live, --view: this volume in place of a computed one")->type_name("VOLUME")->group("Measuring");
    app.add_flag("--quick", o.quick, "Shorter measurements, and a tuning within a minute of what matters most")->group("Measuring");
    app.add_flag("--tune", o.tune, "Find the fastest tunables of each device (at most 5 minutes each) and keep them for all commands")
        ->group("Measuring");
    app.add_flag("--child", o.child, "Serve requests on stdin (for clvr-bench itself)")->group("");
    app.add_flag("--tiny", o.tiny, "The sizes of simulators on every device (for tests)")->group("");
    app.add_flag("--hashes", o.hashes, "Print the hash of each result")->group("");
    take_single_values(app);
    use_help_text(app);
    app.parse_complete_callback([&app] { check_files(app); });
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // help and version
        std::string what = error.what();
        std::replace(what.begin(), what.end(), '\n', ' ');
        throw Error(ErrorKind::usage, what + " (see clvr-bench --help)");
    }
    if (o.child) return serve();
    if (!o.from.empty()) {
        make_page_again(o);
        return 0;
    }
    o.live || o.view ? bench_live(o) : bench_devices(o);
    return 0;
}

} // namespace
} // namespace clvr::bench

int main(int argc, char** argv) {
    auto logger = spdlog::stderr_color_mt("clvr-bench");
    logger->set_pattern("%n: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
    return clvr::run_program("clvr-bench", clvr::bench::run, argc, argv);
}
