// clvr compare: how far a picture is from its reference.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/frame/error_pictures.hpp"
#include "host/frame/metrics.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

namespace {

struct Options {
    std::string image, reference, map;
    Tonemap tonemap{"none", 0};
    bool json = false;
};

/// NAME.png becomes NAME.<what>.png.
std::string beside(const std::string& path, const char* what) {
    const std::filesystem::path p(path);
    return (p.parent_path() / (p.stem().string() + "." + what + ".png")).string();
}

Metrics compare_pictures(const Options& o, const Frame& image, const Frame& reference) {
    Metrics m;
    try {
        m = compare_frames(image, reference);
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), fmt::format("{} against {}", o.image, o.reference)) : e;
    }
    if (!o.map.empty()) {
        write_png(flip_picture(image, reference), {"none", 0}, beside(o.map, "flip"));
        write_png(difference_picture(image, reference), {"none", 0}, beside(o.map, "difference"));
    }
    return m;
}

/// A picture as it is to be compared: linear, or as display light of the tone map (what PNG files hold already).
Frame picture_of(const std::string& path, const Tonemap& tonemap) {
    Frame frame = read_picture(path);
    if ((tonemap.curve == "none" && tonemap.exposure == 0) || !is_exr_path(path)) return frame;
    for (const char* c : {"R", "G", "B"})
        if (!frame.has(c)) throw Error(ErrorKind::input, fmt::format("lacks channel {}", c), path);
    Frame mapped = tonemapped(frame, tonemap);
    if (frame.has("opacity.A")) mapped.channels["opacity.A"] = frame.at("opacity.A");
    return mapped;
}

void compare(const Options& o) {
    if (!o.map.empty()) {
        if (is_exr_path(o.map)) throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected a name that ends in .png", o.map), "--map");
        check_frame_path(o.map);
    }
    const ToneCurve known(o.tonemap); // refuses unknown names before anything is read
    const Metrics m = compare_pictures(o, picture_of(o.image, o.tonemap), picture_of(o.reference, o.tonemap));
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
    fmt::print("{}\n", all.dump(1));
}

} // namespace

void add_compare_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("compare", "PSNR, SSIM, RMSE, SMAPE, relMSE and FLIP of a picture against its reference");
    auto o = std::make_shared<Options>();
    reads_files(c->add_option("A", o->image, "Picture (.exr or .png)")->required());
    reads_files(c->add_option("B", o->reference, "Reference (.exr or .png), as large")->required());
    c->add_option("--tonemap", o->tonemap.curve, "Compare EXR files as filmic, aces or reinhard would show them [none: linear]");
    c->add_option("--exposure", o->tonemap.exposure, "Exposure before that, in stops [0]");
    writes_files(c->add_option("--map", o->map, "Also write error pictures: NAME.flip.png and NAME.difference.png")->type_name("NAME.png"),
                 [](const std::string& name) {
                     return std::vector{beside(name, "flip"), beside(name, "difference")};
                 });
    c->add_flag("--json", o->json, "Write JSON");
    c->callback([o] { compare(*o); });
}

} // namespace clvr
