// clvr view: a volume or a scene in the browser.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/provenance.hpp"
#include "host/cli/render_options.hpp"
#include "host/io/model/model_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/io/scene/scene_inputs.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "host/live/session_painter.hpp"
#include "host/view/address.hpp"
#include "host/view/token.hpp"
#include "host/view/viewer.hpp"
#include "runtime/system/signals.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <pwd.h>
#include <thread>
#include <unistd.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;

struct ViewOptions {
    RenderOptions scene;
    view::ServerSettings server;
    std::string token_file, output_dir;
    double idle_s = 0;
    bool insecure = false, no_browser = false;
};

/// The file or folder without those that it lies in.
std::string name_of_volume(const std::string& volume) {
    if (is_demo_volume(volume)) return volume;
    const fs::path path = fs::absolute(split_dataset_path(volume).file).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string user_name() {
    const passwd* const user = getpwuid(geteuid());
    return user ? user->pw_name : "";
}

std::string machine_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "localhost";
}

/// Throws Error{usage} for options that do not go together, before anything is read.
void check(const ViewOptions& o) {
    if (o.scene.input.empty())
        throw Error(ErrorKind::usage, "no volume given: name a file or folder, or demo:head for the built-in one", "clvr view");
    if (o.server.port < 0 || o.server.port > 65535)
        throw Error(ErrorKind::usage, fmt::format("is {}; expected 1 to 65535, or 0 for any that is free", o.server.port), "--port");
    if (!(o.idle_s >= 0))
        throw Error(ErrorKind::usage, fmt::format("is {}; expected a positive number of seconds", o.idle_s), "--idle-timeout");
    if (!o.output_dir.empty() && !fs::is_directory(o.output_dir))
        throw Error(ErrorKind::usage, fmt::format("there is no folder '{}'; make it first", o.output_dir), "--output-dir");
    check_address(o.server, o.insecure);
}

view::VolumePointer read_volume_of(Scene& scene, std::vector<Device>& devices) {
    auto volume = std::make_shared<const PreparedVolume>(open_volume(scene.volume, scene.reading, devices));
    if (scene.volume_sha256.empty()) return volume;
    const std::string hash = volume_sha256(volume->voxels);
    if (scene.volume_sha256 != hash)
        throw Error(
            ErrorKind::input,
            fmt::format("does not hold the voxels that the scene was saved with (SHA-256 {}, expected {})", hash, scene.volume_sha256),
            scene.volume);
    return volume;
}

view::ViewerSettings viewer_settings(const ViewOptions& o, const Scene& scene, const view::VolumePointer& volume,
                                     const std::vector<Device>& devices) {
    view::ViewerSettings settings;
    settings.scene = scene;
    settings.volume = volume;
    settings.name = name_of_volume(scene.volume);
    settings.version = CLVR_VERSION;
    settings.output_dir = o.output_dir;
    const bool gpu = std::any_of(devices.begin(), devices.end(), [](const Device& d) { return d.facts().type == DeviceType::gpu; });
    settings.time_steps = volume->voxels.frames;
    settings.read_step = [scene](int step) {
        VolumeReadOptions reading = scene.reading;
        reading.frame = step;
        return std::make_shared<const PreparedVolume>(read_volume(scene.volume, reading));
    };
    settings.show_volume = [](Painter& painter, const view::VolumePointer& shown) {
        dynamic_cast<SessionPainter&>(painter).set_volume(shown);
    };
    if (gpu) settings.loop.moving_budget_s = 1.0 / 30;
    settings.provenance = [devices](Frame& frame, const Scene& made) { add_provenance(frame, made, provenance_json(made), devices); };
    return settings;
}

/// Stops the server before its viewer is gone, also when something throws.
struct Stopping {
    view::Server& server;
    ~Stopping() { server.stop(view::bye_reply("clvr view has ended.")); }
};

void announce(const ViewOptions& o, const view::Server& server, const std::string& folder) {
    const view::Whereabouts where = whereabouts(o.server, server.port(), user_name(), machine_name());
    if (!o.server.socket.empty() && o.server.base_url.empty()) {
        fmt::print("On your own machine: {}\nthen open {}\n", where.tunnel, where.url);
    } else {
        fmt::print("{}\n", where.url);
        if (!where.tunnel.empty()) fmt::print("From another machine: {}\n", where.tunnel);
    }
    std::fflush(stdout);
    if (o.insecure && o.server.certificate.empty() && !view::is_loopback(o.server.host))
        spdlog::warn("--insecure: whoever is on the way can read the token and the pictures, and control the view");
    if (!o.no_browser && o.server.socket.empty() && o.server.base_url.empty()) view::open_browser(where.url, folder);
}

/// Until Ctrl-C, or nobody was there for as long as --idle-timeout says.
const char* wait(const ViewOptions& o, const view::Viewer& viewer, const std::atomic<bool>& interrupted) {
    while (!interrupted) {
        if (o.idle_s > 0 && viewer.idle_seconds() > o.idle_s) return "clvr view has ended, as nobody was there.";
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return "clvr view has ended.";
}

void run_viewer(ViewOptions o) {
    check(o);
    std::vector<std::string> notes;
    Scene scene = view::within_limits(scene_of(o.scene), notes);
    for (const std::string& note : notes) spdlog::warn("{}", note);
    const Model model = read_model("default");
    std::vector<Device> devices = open_devices(o.scene.devices);
    const view::VolumePointer volume = read_volume_of(scene, devices);
    read_environment(scene); // refused before anybody waits for a picture

    const std::atomic<bool>& interrupted = catch_interrupts();
    o.server.token = view::new_token();
    view::Server server(o.server);
    if (!o.token_file.empty()) view::write_token_file(o.token_file, o.server.token);
    SessionPainter painter(devices, volume, model, [](const Scene& s) { return read_environment(s); });
    SteadyClock clock;
    view::Viewer viewer(viewer_settings(o, scene, volume, devices), painter, clock, server);
    const Stopping stopping{server};
    server.start(viewer);
    announce(o, server, viewer.folder());
    const char* const why = wait(o, viewer, interrupted);
    server.stop(view::bye_reply(why));
    if (!interrupted) spdlog::info("{}", why);
    print_profiles(o.scene.devices, devices);
}

void add_server_options(CLI::App& c, ViewOptions& o) {
    const auto add = [&](const char* name, auto& value, const char* help, const char* type) {
        c.add_option(name, value, help)->type_name(type)->group("Server");
    };
    add("--host", o.server.host, "Address to listen at [127.0.0.1: this machine alone]", "ADDRESS");
    add("--port", o.server.port, "Port to listen at [any that is free]", "N");
    add("--socket", o.server.socket, "Listen at a Unix socket instead, which only you can use", "PATH");
    add("--base-url", o.server.base_url, "Where a proxy shows the page, such as https://hub.example.org/view/", "URL");
    add("--token-file", o.token_file, "Write the token there, for programs", "FILE");
    add("--cert", o.server.certificate, "TLS: the certificate, in PEM form", "FILE");
    add("--cert-key", o.server.key, "TLS: its key, in PEM form", "FILE");
    c.add_flag("--insecure", o.insecure, "Allow an address that other machines reach without TLS")->group("Server");
    add("--idle-timeout", o.idle_s, "End when nobody was there for so long [never]", "SECONDS");
    c.add_flag("--no-browser", o.no_browser, "Only print the address")->group("Server");
    c.add_option("--output-dir", o.output_dir, "Write what is saved there, too, beside its download")->type_name("DIR")->group("Output");
    reads_files(c, {"--cert", "--cert-key"});
    writes_files(c, "--token-file");
    writes_files(c, "--output-dir");
}

} // namespace

void add_view_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("view", "Turn a volume and edit how it looks, in a browser");
    auto options = std::make_shared<ViewOptions>();
    add_scene_options(*command, options->scene);
    add_server_options(*command, *options);
    command->footer("Transfer functions:\n"
                    "  JSON files as `clvr render --help` describes them, or made in the page.\n"
                    "From another machine:\n"
                    "  The page is served to this machine alone. From elsewhere, run the ssh command\n"
                    "  that is printed and open the printed address there. The part after # is a\n"
                    "  token: who has it can see and control the view.\n"
                    "Examples:\n"
                    "  clvr view scan.nii.gz\n"
                    "  clvr view scene.json --spp 256 --output-dir pictures\n"
                    "  clvr view scans/ --socket ~/.clvr/view.sock --idle-timeout 3600\n");
    command->callback([options] { run_viewer(*options); });
}

} // namespace clvr
