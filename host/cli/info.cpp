// `clvr info`: what a volume file holds, and what the device would have to hold.
#include "host/cli/commands.hpp"
#include "host/cli/file_options.hpp"
#include "host/cli/open_volume.hpp"
#include "host/cli/text_chart.hpp"
#include "host/cli/volume_options.hpp"
#include "host/render/device_volume.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/system/size.hpp"
#include "runtime/trust/trust.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

namespace clvr {

namespace {

struct InfoOptions {
    std::string input, selector;
    VolumeReadOptions volume;
    bool json = false;
};

/// What one device would hold of the whole volume.
struct MemoryPlan {
    std::string device;
    std::size_t max_alloc_bytes = 0, free_bytes = 0;
    std::optional<BrickLayout> layout;
    std::string problem; ///< why there is no layout, or why it does not fit
};

struct InfoReport {
    Voxels volume;
    Histogram histogram; ///< over stored values
    std::array<double, 2> range{};
    std::array<std::string, 3> axes;
    double oblique_degrees = 0;
    std::vector<MemoryPlan> plans;
    std::string rule; ///< why these devices, or why there is none
};

/// "R->L": from the patient's right to the left, by the greatest component of the direction in LPS.
std::string axis_text(const Double3& direction) {
    constexpr std::array<std::array<char, 2>, 3> ends{{{'R', 'L'}, {'A', 'P'}, {'I', 'S'}}};
    std::size_t main = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(direction[i]) > std::abs(direction[main])) main = i;
    const bool forward = direction[main] > 0;
    return fmt::format("{}->{}", ends[main][forward ? 0 : 1], ends[main][forward ? 1 : 0]);
}

/// The greatest angle between an index axis and the nearest axis of the world [degrees].
double obliqueness(const Matrix3& direction) {
    double least = 1;
    for (int j = 0; j < 3; ++j) {
        const Double3 axis = direction.column(j);
        least = std::min(least, std::max({std::abs(axis[0]), std::abs(axis[1]), std::abs(axis[2])}) / norm(axis));
    }
    return std::acos(std::min(least, 1.0)) * 180 / M_PI;
}

MemoryPlan plan_for(const Device& device, const Voxels& v, const MajorantGrid& grid) {
    MemoryPlan plan;
    plan.device = device.facts().name;
    plan.max_alloc_bytes = device.max_alloc_bytes();
    plan.free_bytes = device.free_bytes();
    try {
        Classified whole; // as if every voxel were visible
        whole.voxels = &v;
        whole.grid = &grid;
        whole.majorants.assign(grid.count(), 1.0f);
        plan.layout = device_layout(device, whole);
        if (plan.layout->stored_bytes() > plan.free_bytes) plan.problem = fmt::format("{} are free", size_text(plan.free_bytes));
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::device_memory) throw;
        plan.problem = e.line();
    }
    return plan;
}

Voxels volume_of(const InfoOptions& o) {
    if (!is_demo_volume(o.input)) return read_volume(o.input, o.volume);
    std::vector devices{open_trusted(select_devices(o.selector, "render").devices.front())};
    return open_volume(o.input, o.volume, devices);
}

/// What the file holds: without any device.
InfoReport make_report(const InfoOptions& o) {
    InfoReport r;
    r.volume = volume_of(o);
    const Voxels& v = r.volume;
    r.histogram = stored_histogram(v);
    r.range = {v.slope * r.histogram.low + v.intercept, v.slope * r.histogram.high + v.intercept};
    if (v.slope < 0) {
        std::swap(r.range[0], r.range[1]);
        std::reverse(r.histogram.bins.begin(), r.histogram.bins.end());
    }
    for (int j = 0; j < 3; ++j) r.axes[j] = axis_text(v.geometry.direction.column(j));
    r.oblique_degrees = obliqueness(v.geometry.direction);
    return r;
}

/// Adds what the devices would hold; where there is none, why. Throws Error for a device that was asked for.
void add_plans(InfoReport& r, const InfoOptions& o) {
    try {
        const Selection selection = select_devices(o.selector, "render");
        const MajorantGrid grid = majorant_grid(r.volume);
        for (const DeviceFacts& facts : selection.devices) // no kernel is built, so a device need not be trusted
            r.plans.push_back(plan_for(Device::open_untested(facts), r.volume, grid));
        r.rule = selection.rule;
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::device || !o.selector.empty()) throw;
        r.plans.clear();
        r.rule = e.line();
    }
}

Double3 size_mm(const Voxels& v) {
    const Double3& s = v.geometry.spacing;
    return {v.dims[0] * s[0], v.dims[1] * s[1], v.dims[2] * s[2]};
}

void print_line(const char* name, const std::string& text) { fmt::print("  {:<12}{}\n", name, text); }

void print_plan(const MemoryPlan& plan, const Voxels& v) {
    print_line("device", plan.device);
    if (!plan.layout) return print_line("memory", "the volume does not fit: " + plan.problem);
    const BrickLayout& b = *plan.layout;
    const std::size_t stored = b.stored_bytes();
    print_line("bricks", fmt::format("{} x {} x {} of {} voxels an edge, {} ({:.2f} times the voxels) in {} buffer{}", b.bricks[0],
                                     b.bricks[1], b.bricks[2], 1 << b.log2_edge, size_text(stored),
                                     static_cast<double>(stored) / static_cast<double>(v.bytes.size()), b.pools, b.pools == 1 ? "" : "s"));
    print_line("memory", plan.problem.empty() ? fmt::format("fits: {} of {} free, at most {} a buffer", size_text(stored),
                                                            size_text(plan.free_bytes), size_text(plan.max_alloc_bytes))
                                              : "the volume does not fit: " + plan.problem);
}

/// All but the memory plans.
void print_text(const InfoReport& r) {
    const Voxels& v = r.volume;
    const Geometry& g = v.geometry;
    const Double3 size = size_mm(v);
    const bool scaled = v.slope != 1 || v.intercept != 0;
    fmt::print("{}\n", v.source);
    print_line("format", v.format + (v.modality.empty() ? "" : ", " + v.modality));
    print_line("voxels",
               fmt::format("{} x {} x {} {}, {}", v.dims[0], v.dims[1], v.dims[2], voxel_type_name(v.type), size_text(v.bytes.size())));
    print_line("spacing", fmt::format("{:.5g} x {:.5g} x {:.5g} mm", g.spacing[0], g.spacing[1], g.spacing[2]));
    print_line("size", fmt::format("{:.5g} x {:.5g} x {:.5g} mm", size[0], size[1], size[2]));
    print_line("axes", fmt::format("i {}, j {}, k {}{}{}", r.axes[0], r.axes[1], r.axes[2],
                                   r.oblique_degrees > 0.05 ? fmt::format(", oblique by {:.1f} degrees", r.oblique_degrees) : "",
                                   g.direction.determinant() < 0 ? ", left-handed" : ""));
    print_line("origin", fmt::format("{:.6g}, {:.6g}, {:.6g} mm (LPS)", g.origin[0], g.origin[1], g.origin[2]));
    if (r.oblique_degrees > 1e-6)
        for (int i = 0; i < 3; ++i) {
            const Double3& row = g.direction.row[i];
            print_line(i == 0 ? "direction" : "", fmt::format("{:9.6f} {:9.6f} {:9.6f}", row[0], row[1], row[2]));
        }
    const std::string offset = v.intercept == 0 ? "" : fmt::format(" {} {:.6g}", v.intercept < 0 ? "-" : "+", std::abs(v.intercept));
    const std::string scale =
        fmt::format(" = {:.6g} x stored{}, stored {:.6g} to {:.6g}", v.slope, offset, r.histogram.low, r.histogram.high);
    print_line("values", fmt::format("{:.6g} to {:.6g}{}", r.range[0], r.range[1], scaled ? scale : ""));
    const bool whole = v.type != VoxelType::f32;
    fmt::print("\n{}\n", histogram_chart(r.histogram.bins, r.range[0], r.range[1], whole ? r.histogram.high - r.histogram.low + 1 : 0));
    for (const std::string& decision : v.decisions) print_line("read as", decision);
    for (const std::string& note : v.notes) print_line("note", note);
}

void print_plans(const InfoReport& r) {
    for (const MemoryPlan& plan : r.plans) print_plan(plan, r.volume);
    if (r.plans.empty()) print_line("device", "none: " + r.rule);
}

nlohmann::json to_json(const MemoryPlan& plan) {
    nlohmann::json j{{"device", plan.device},
                     {"max_alloc_bytes", plan.max_alloc_bytes},
                     {"free_bytes", plan.free_bytes},
                     {"fits", plan.problem.empty()}};
    if (!plan.problem.empty()) j["problem"] = plan.problem;
    if (plan.layout)
        j["bricks"] = {{"edge", 1 << plan.layout->log2_edge},
                       {"count", plan.layout->bricks},
                       {"stored_bytes", plan.layout->stored_bytes()},
                       {"buffer_bytes", plan.layout->pool_bytes}};
    return j;
}

void print_json(const InfoReport& r) {
    const Voxels& v = r.volume;
    nlohmann::json plans = nlohmann::json::array();
    for (const MemoryPlan& plan : r.plans) plans.push_back(to_json(plan));
    const nlohmann::json j{{"path", v.source},
                           {"format", v.format},
                           {"modality", v.modality},
                           {"dims", v.dims},
                           {"type", voxel_type_name(v.type)},
                           {"bytes", v.bytes.size()},
                           {"sha256", volume_sha256(v)},
                           {"slope", v.slope},
                           {"intercept", v.intercept},
                           {"spacing_mm", v.geometry.spacing},
                           {"size_mm", size_mm(v)},
                           {"origin_mm", v.geometry.origin},
                           {"direction", v.geometry.direction.row},
                           {"axes", r.axes},
                           {"oblique_degrees", r.oblique_degrees},
                           {"stored_range", {r.histogram.low, r.histogram.high}},
                           {"range", r.range},
                           {"histogram", r.histogram.bins},
                           {"repaired_voxels", v.repaired},
                           {"decisions", v.decisions},
                           {"notes", v.notes},
                           {"device_rule", r.rule},
                           {"memory_plan", plans}};
    fmt::print("{}", json_text(j));
}

} // namespace

void add_info_command(CLI::App& app) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App* command = app.add_subcommand("info", "What a volume holds: geometry, type, range, histogram, bricks, memory plan");
    command->add_option("VOLUME", options->input, "Volume file or folder, or demo:head and the like")
        ->type_name("FILE|DIR|DEMO")
        ->required();
    command->add_flag("--json", options->json, "Print JSON")->group("Output");
    command
        ->add_option("--device", options->selector,
                     "Device of the memory plan: an index, cpu, gpu, part of a name, cpu/2, several joined by +")
        ->type_name("SEL")
        ->group("Device");
    command->footer("Examples:\n"
                    "  clvr info scan.nii.gz\n"
                    "  clvr info scans/ --json\n"
                    "  clvr info fuel.raw --dims 64x64x64 --type uint8\n");
    add_volume_options(*command, options->volume);
    reads_files(*command, {"VOLUME"});
    command->callback([options] {
        InfoReport report = make_report(*options);
        if (!options->json) print_text(report);
        std::fflush(stdout); // whatever drivers do then
        add_plans(report, *options);
        options->json ? print_json(report) : print_plans(report);
    });
}

} // namespace clvr
