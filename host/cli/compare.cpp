// clvr compare: how far a picture is from its reference.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/frame/channel_mapping.hpp"
#include "host/frame/error_pictures.hpp"
#include "host/frame/metrics.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace clvr {

namespace {

struct CompareOptions {
    std::string image, reference, map;
    Tonemap tonemap{"none", 0};
    bool json = false;
};

/// NAME.png becomes NAME.<what>.png, NAME.jpg likewise.
std::string beside(const std::string& path, const char* what) {
    const std::filesystem::path p(path);
    return (p.parent_path() / (p.stem().string() + "." + what + p.extension().string())).string();
}

Metrics compare_pictures(const CompareOptions& o, const Frame& image, const Frame& reference) {
    Metrics m;
    try {
        m = compare_frames(image, reference);
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), fmt::format("{} against {}", o.image, o.reference)) : e;
    }
    if (!o.map.empty()) {
        write_frame(flip_picture(image, reference), {"none", 0}, beside(o.map, "flip"));
        write_frame(difference_picture(image, reference), {"none", 0}, beside(o.map, "difference"));
    }
    return m;
}

/// A picture as it is to be compared: linear, or as display light of the tone map (what PNG and JPEG files hold already).
Frame picture_of(const std::string& path, const Tonemap& tonemap) {
    Frame frame = read_picture(path);
    for (const auto& note : frame.notes) spdlog::warn("{}: {}", path, note);
    if (!frame.has("R"))
        for (const auto& said : map_known_channels(frame)) spdlog::info("{}: {}", path, said);
    if ((tonemap.curve == "none" && tonemap.exposure == 0) || is_display_light(picture_format(path))) return frame;
    for (const char* c : {"R", "G", "B"})
        if (!frame.has(c)) throw Error(ErrorKind::input, fmt::format("lacks channel {}", c), path);
    Frame mapped = tonemapped(frame, tonemap);
    if (frame.has(channel::opacity)) mapped.channels[channel::opacity] = frame.at(channel::opacity);
    return mapped;
}

void compare(const CompareOptions& o) {
    if (!o.map.empty()) {
        if (is_exr_path(o.map))
            throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected a name that ends in .png or .jpg", o.map), "--map");
        check_frame_path(o.map);
    }
    const ToneCurve known(o.tonemap); // refuses unknown names before anything is read
    Frame image = picture_of(o.image, o.tonemap), reference = picture_of(o.reference, o.tonemap);
    if (image.window() != reference.window()) image = shown_part(image), reference = shown_part(reference); // crops of one picture
    const Metrics m = compare_pictures(o, image, reference);
    if (!o.json) {
        for (const auto& [name, value] : named(m)) fmt::print("{:<12} {:.6g}\n", name, value);
        return;
    }
    nlohmann::ordered_json all;
    for (const auto& [name, value] : named(m)) {
        if (std::isfinite(value))
            all[name] = value;
        else
            all[name] = nullptr; // the PSNR of equal pictures
    }
    fmt::print("{}", json_text(all));
}

} // namespace

void add_compare_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("compare", "PSNR, SSIM, RMSE, SMAPE, relMSE and FLIP of a picture against its reference");
    auto o = std::make_shared<CompareOptions>();
    c->add_option("A", o->image, "Picture (.exr, .hdr, .pfm, .png or .jpg)")->type_name("FILE")->required();
    c->add_option("B", o->reference, "Reference of the same kinds, as large")->type_name("FILE")->required();
    c->add_flag("--json", o->json, "Print JSON")->group("Output");
    c->add_option("--map", o->map, "Also write error pictures: of NAME.png, NAME.flip.png and NAME.difference.png (or .jpg)")
        ->type_name("FILE.png")
        ->group("Output");
    c->add_option("--tonemap", o->tonemap.curve, "Compare EXR files as this tone curve shows them [none: linear]")
        ->type_name("none|filmic|aces|reinhard")
        ->group("Look");
    c->add_option("--exposure", o->tonemap.exposure, "Exposure before that, in stops [0]")->group("Look");
    c->footer("Examples:\n"
              "  clvr compare clean.exr reference.exr\n"
              "  clvr compare clean.exr reference.exr --tonemap filmic --map error.png\n");
    reads_files(*c, {"A", "B"});
    writes_files(*c, "--map", [](const std::string& name) { return std::vector{beside(name, "flip"), beside(name, "difference")}; });
    c->callback([o] { compare(*o); });
}

} // namespace clvr
