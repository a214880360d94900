// clvr dataset: volumes that others publish, and volumes that clvr computes.
#include "host/cli/commands.hpp"
#include "host/cli/device_options.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/progress_bar.hpp"
#include "host/cli/volume_options.hpp"
#include "host/dataset/download.hpp"
#include "host/dataset/manifest.hpp"
#include "host/io/volume/volume_file.hpp"
#include "host/phantom/phantom.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/system/signals.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

struct DatasetOptions {
    std::string name, folder = ".", output, dims, type;
    std::uint64_t seed = 0;
    bool json = false;
    DeviceOptions device;
};

ordered_json to_json(const Dataset& d) {
    ordered_json j{{"name", d.name}, {"title", d.title}, {"source", d.source}, {"licence", d.licence}, {"citation", d.citation}};
    if (!d.url.empty()) j["url"] = d.url, j["bytes"] = d.bytes;
    if (!d.sha512.empty()) j["sha512"] = d.sha512;
    j["dims"] = d.dims, j["type"] = d.type, j["spacing"] = d.spacing;
    if (!d.transfer_function.empty()) j["transfer_function"] = d.transfer_function;
    j["view"] = {{"azimuth", d.azimuth}, {"elevation", d.elevation}, {"zoom", d.zoom}};
    if (!d.computed.empty()) j["computed"] = d.computed;
    return j;
}

void list(const DatasetOptions& o) {
    if (o.json) {
        ordered_json all = ordered_json::array();
        for (const Dataset& d : datasets()) all.push_back(to_json(d));
        fmt::print("{}", json_text(ordered_json{{"datasets", all}, {"computed", phantom_names()}}));
        return;
    }
    for (const Dataset& d : datasets())
        fmt::print("{:<12} {:>15} {:<4} {:<6} {}\n", d.name, fmt::format("{}", fmt::join(d.dims, "x")), d.type,
                   d.url.empty() ? "" : "fetch", d.title);
    fmt::print("computed by `clvr dataset make`, or as demo:NAME: {}\n", fmt::join(phantom_names(), ", "));
}

void info(const DatasetOptions& o) {
    const Dataset& d = dataset_named(o.name);
    if (o.json) {
        fmt::print("{}", json_text(to_json(d)));
        return;
    }
    fmt::print("{}: {}\n", d.name, d.title);
    fmt::print("  voxels    {} {}, spacing {} mm\n", fmt::join(d.dims, " x "), d.type, fmt::join(d.spacing, " x "));
    fmt::print("  source    {}\n  licence   {}\n  citation  {}\n", d.source, d.licence, d.citation);
    if (!d.url.empty()) fmt::print("  url       {}, {} bytes\n", d.url, d.bytes);
    if (!d.sha512.empty()) fmt::print("  sha512    {}\n", d.sha512);
    fmt::print("  view      --azimuth {} --elevation {} --zoom {}{}\n", d.azimuth, d.elevation, d.zoom,
               d.transfer_function.empty() ? "" : " --tf " + d.transfer_function);
    if (!d.computed.empty()) fmt::print("  stand-in  clvr dataset make {}\n", d.computed);
}

/// What any download into the folder may write.
std::vector<std::string> fetched_files(const std::string& folder) {
    std::vector<std::string> all;
    for (const Dataset& d : datasets())
        if (!d.url.empty())
            for (const std::string& file : download_files((fs::path(folder) / d.file_name()).string())) all.push_back(file);
    return all;
}

void fetch(const DatasetOptions& o) {
    const Dataset& d = dataset_named(o.name);
    if (d.url.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("is not published as a single file; its source: {}{}", d.source,
                                d.computed.empty() ? "" : fmt::format(". `clvr dataset make {}` computes a volume like it", d.computed)),
                    d.name);
    std::error_code failed;
    fs::create_directories(o.folder, failed);
    if (failed) throw Error(ErrorKind::input, fmt::format("cannot be made: {}", failed.message()), o.folder);
    const std::string path = (fs::path(o.folder) / d.file_name()).string();
    {
        ProgressBar bar("fetching " + d.name, false);
        download(
            {d.url, path, d.bytes, d.sha512},
            [&](std::uint64_t there) {
                bar.update(static_cast<double>(there) / static_cast<double>(d.bytes),
                           fmt::format("{} of {} MB", there >> 20, d.bytes >> 20));
            },
            &catch_interrupts());
    }
    spdlog::info("{}: {} (licence: {})", path, d.title, d.licence);
}

void make(const DatasetOptions& o) {
    if (o.output.empty()) throw Error(ErrorKind::usage, "no output given: add -o volume.nii.gz (or .nii)", "clvr dataset make");
    PhantomOptions options;
    options.seed = o.seed;
    options.cancelled = &catch_interrupts();
    if (const Dataset* published = published_as(o.name)) { // as large as what it stands in for
        options.dims = published->dims;
        options.type = voxel_type_named(published->type);
    }
    if (!o.dims.empty()) options.dims = parse_dims(o.dims);
    if (!o.type.empty() && !(options.type = voxel_type_named(o.type)))
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected u8, i8, u16, i16 or f32", o.type), "--type");
    check_nifti_path(o.output);
    Device device = open_device(o.device);
    write_nifti(make_phantom(device, o.name, options), o.output);
    print_profiles(o.device, {device});
}

} // namespace

void add_dataset_command(CLI::App& app) {
    CLI::App* c = app.add_subcommand("dataset", "Volumes that others publish, and volumes that clvr computes");
    c->require_subcommand(1);
    auto o = std::make_shared<DatasetOptions>();

    CLI::App* l = c->add_subcommand("list", "What there is");
    l->add_flag("--json", o->json, "Print JSON")->group("Output");
    l->footer("Examples:\n  clvr dataset list\n");
    l->callback([o] { list(*o); });

    CLI::App* i = c->add_subcommand("info", "Size, source, licence, citation of a published volume");
    i->add_option("NAME", o->name, "As listed")->type_name("DATASET")->required();
    i->add_flag("--json", o->json, "Print JSON")->group("Output");
    i->footer("Examples:\n  clvr dataset info bonsai\n");
    i->callback([o] { info(*o); });

    CLI::App* f = c->add_subcommand("fetch", "Download a published volume; goes on where it was interrupted, checks size and checksum");
    f->add_option("NAME", o->name, "As listed")->type_name("DATASET")->required();
    f->add_option("--dir", o->folder, "Folder to write into [.]")->type_name("DIR")->group("Output");
    f->footer("Examples:\n  clvr dataset fetch bonsai --dir volumes\n");
    writes_files(*f, "--dir", fetched_files);
    f->callback([o] { fetch(*o); });

    CLI::App* m = c->add_subcommand("make", "Compute a volume: the same bits on every device");
    m->add_option("NAME", o->name, fmt::format("{}", fmt::join(phantom_names(), ", ")))->type_name("COMPUTED")->required();
    m->add_option("-o,--output", o->output, "File to write (.nii.gz or .nii)")->type_name("FILE")->group("Output");
    m->add_option("--dims", o->dims, "Voxels [those of the published volume that it is like, else its own]")
        ->type_name("WxHxD")
        ->group("Volume");
    m->add_option("--type", o->type, "Type of the voxels [as --dims]")->type_name("u8|i8|u16|i16|f32")->group("Volume");
    m->add_option("--seed", o->seed, "Of growth, texture and noise [0]")->group("Volume");
    c->footer("Examples:\n"
              "  clvr dataset list\n"
              "  clvr dataset fetch bonsai --dir volumes\n"
              "  clvr dataset make vessels -o vessels.nii.gz --dims 256x256x256\n");
    add_device_options(*m, o->device, "render");
    m->footer("Examples:\n  clvr dataset make vessels -o vessels.nii.gz --dims 256x256x256\n");
    writes_files(*m, "--output");
    m->callback([o] { make(*o); });
}

} // namespace clvr
