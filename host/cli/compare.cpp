// clvr compare: how far a picture is from its reference.
#include "host/cli/commands.hpp"
#include "host/frame/metrics.hpp"
#include "host/io/frame_file.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

namespace {

struct Options {
    std::string image, reference;
    bool json = false;
};

void compare(const Options& o) {
    Metrics m;
    try {
        m = compare_frames(read_exr(o.image), read_exr(o.reference));
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), fmt::format("{} against {}", o.image, o.reference)) : e;
    }
    const std::pair<const char*, double> rows[] = {{"psnr", m.psnr}, {"ssim", m.ssim},   {"ssim_opaque", m.ssim_opaque},
                                                   {"rmse", m.rmse}, {"smape", m.smape}, {"relmse", m.relmse}};
    if (!o.json) {
        for (const auto& [name, value] : rows) fmt::print("{:<12} {:.6g}\n", name, value);
        return;
    }
    nlohmann::ordered_json all;
    for (const auto& [name, value] : rows) {
        if (std::isfinite(value))
            all[name] = value;
        else
            all[name] = nullptr; // the PSNR of equal pictures
    }
    fmt::print("{}\n", all.dump(1));
}

} // namespace

void add_compare_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("compare", "PSNR, SSIM, RMSE, SMAPE and relMSE of a picture (EXR) against its reference");
    auto o = std::make_shared<Options>();
    c->add_option("A", o->image, "Picture (.exr)")->required();
    c->add_option("B", o->reference, "Reference (.exr), as large")->required();
    c->add_flag("--json", o->json, "Write JSON");
    c->callback([o] { compare(*o); });
}

} // namespace clvr
