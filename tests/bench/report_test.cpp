// Rows, recommendations, the JSON's shape, the page.
#include "tools/bench/report.hpp"
#include "tools/bench/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

namespace clvr::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Row row(const std::string& stage, double rate, Status status = Status::ok, const std::string& reason = {}) {
    Row r;
    r.stage = stage, r.unit = "M/s", r.size = "standard", r.status = status, r.reason = reason;
    r.rate = rate, r.seconds = 0.012, r.spread = 0.034, r.batches = 9;
    return r;
}

DeviceRows device(int index, const std::string& name, double speed) {
    DeviceRows d;
    d.facts.index = index, d.facts.name = name, d.facts.platform = "Plat<form>";
    d.facts.available = d.facts.has_compiler = true;
    d.facts.version = "OpenCL 1.2";
    for (const char* stage : {"FMA rate", "copy", "GuideNet", "path trace", "denoise a frame", "training step"})
        d.rows.push_back(row(stage, speed));
    d.rows[0].flops = 100e9 * speed;
    d.rows[1].bytes = 10e9 * speed;
    d.rows[2].flops = 82e9 * speed, d.rows[2].intensity = 30;
    return d;
}

TEST(Rows, SurviveJson) {
    Row r = row("GuideNet", 3, Status::wrong_result, "off");
    r.native_share = 0.83, r.repeated = 4, r.pace_s = 0.002, r.hash = "ab", r.note = "width 16";
    EXPECT_EQ(to_json(row_from_json(to_json(r))), to_json(r));
    EXPECT_EQ(row_from_json(to_json(r)).status, Status::wrong_result);
    EXPECT_THROW(row_from_json(nlohmann::json::object()), nlohmann::json::exception);
}

TEST(Rows, ShareOfTheDevicesOwnCeiling) {
    DeviceRows d = device(0, "a", 2);
    fill_shares(d);
    EXPECT_DOUBLE_EQ(d.ok_row("GuideNet")->share, 0.82);
    EXPECT_EQ(d.ok_row("path trace")->share, 0);
    d.rows[0].status = Status::error;
    d.rows[2].share = 0;
    fill_shares(d);
    EXPECT_EQ(d.ok_row("GuideNet")->share, 0) << "no ceiling, no share";
}

TEST(Recommend, TheFastestWithTheReason) {
    const Recommendation r = recommend("render", {device(0, "slow", 1), device(1, "fast", 3)});
    EXPECT_EQ(r.devices, (std::vector<std::size_t>{1}));
    EXPECT_THAT(r.reason, AllOf(HasSubstr("3.00 times"), HasSubstr("device 0 \"slow\"")));
    EXPECT_EQ(r.evidence.size(), 2u);
    EXPECT_THAT(recommend("train", {device(0, "one", 1)}).reason, HasSubstr("only device"));
}

TEST(Recommend, NeverWhatIsWrongSimulatedOrFailing) {
    std::vector<DeviceRows> devices{device(0, "right", 1), device(1, "wrong", 9), device(2, "simulator", 9), device(3, "failing", 9)};
    devices[1].rows[2] = row("GuideNet", 9, Status::wrong_result, "bits");
    devices[2].facts.simulator = true;
    devices[3].rows[3] = row("path trace", 9, Status::error, "crashed");
    const Recommendation r = recommend("render", devices);
    EXPECT_EQ(r.devices, (std::vector<std::size_t>{0}));
    EXPECT_THAT(r.evidence, testing::ElementsAre(HasSubstr("M/s"), HasSubstr("wrong result in \"GuideNet\""), HasSubstr("simulator"),
                                                 HasSubstr("crashed")));
    EXPECT_EQ(recommend("denoise", devices).devices, (std::vector<std::size_t>{3})) << "only its path tracer fails";
    devices.erase(devices.begin());
    EXPECT_TRUE(recommend("render", devices).devices.empty());
}

TEST(Recommend, CombinationsOnlyWhereMeasuredFaster) {
    const std::vector<DeviceRows> devices{device(0, "a", 2), device(1, "b", 1), device(2, "c", 0.1)};
    EXPECT_EQ(worth_joining(devices), (std::vector<std::size_t>{0, 1}));
    EXPECT_TRUE(worth_joining({devices[0], devices[2]}).empty()) << "a twentieth is not worth it";
    EXPECT_TRUE(worth_joining({devices[0]}).empty());
    const auto joined = [&](double rate, Status status = Status::ok) {
        return std::vector<Joined>{{{0, 1}, row("path trace", rate, status, "why")}};
    };
    EXPECT_EQ(recommend("render", devices, joined(2.9)).devices, (std::vector<std::size_t>{0, 1}));
    EXPECT_THAT(recommend("render", devices, joined(2.9)).reason, HasSubstr("1.45 times"));
    EXPECT_EQ(recommend("render", devices, joined(2.1)).devices, (std::vector<std::size_t>{0}));
    EXPECT_EQ(recommend("render", devices, joined(9, Status::wrong_result)).devices, (std::vector<std::size_t>{0}));
    EXPECT_EQ(recommend("train", devices, joined(9)).devices, (std::vector<std::size_t>{0}));
}

Report report() {
    Report r;
    r.devices = {device(0, "CPU & <more>", 1), device(1, "GPU", 4)};
    r.devices[1].rows.push_back(row("slice", 0, Status::unsupported, "no <luck>"));
    for (DeviceRows& d : r.devices) fill_shares(d);
    r.tuned[1] = {{{{"packet", 8}}, {"packet 8: 1.2 x"}}, 3, 1, {"conv_block"}};
    r.joined = {{{0, 1}, row("path trace", 4.8)}};
    for (const std::string& task : task_names()) r.recommendations.push_back(recommend(task, r.devices, r.joined));
    return r;
}

TEST(Json, Shape) {
    const nlohmann::json j = report_json(report());
    ASSERT_EQ(j.at("devices").size(), 2u);
    const auto& gpu = j.at("devices").at(1);
    EXPECT_EQ(gpu.at("name"), "GPU");
    for (const char* key : {"index", "platform", "driver_version", "type", "simulator", "tuning", "compute_units"})
        EXPECT_TRUE(gpu.contains(key)) << key;
    for (const auto& r : gpu.at("rows"))
        for (const char* key : {"stage", "unit", "size", "status", "reason", "seconds", "spread", "rate", "share_of_native",
                                "share_of_ceiling", "batches", "repeated", "hash"})
            EXPECT_TRUE(r.contains(key)) << key;
    EXPECT_EQ(gpu.at("rows").back().at("status"), "unsupported");
    EXPECT_EQ(gpu.at("tuned").at("tunables").at("packet"), 8);
    EXPECT_EQ(gpu.at("tuned").at("left_out").at(0), "conv_block");
    EXPECT_FALSE(j.at("devices").at(0).contains("tuned"));
    EXPECT_EQ(j.at("recommendations").at("render").at("devices"), (nlohmann::json{0, 1}));
    EXPECT_EQ(j.at("recommendations").at("train").at("devices"), nlohmann::json{1});
    EXPECT_EQ(j.at("joined").at(0).at("devices"), (nlohmann::json{0, 1}));
    for (const std::string& task : task_names()) EXPECT_NE(j.at("recommendations").at(task).at("reason"), "");
}

TEST(Json, GivesTheReportBack) {
    const Report first = report();
    const nlohmann::json j = report_json(first);
    const Report again = report_from_json(nlohmann::json::parse(j.dump()));
    EXPECT_EQ(report_json(again), j);
    EXPECT_EQ(report_html(again), report_html(first));
    EXPECT_THROW(report_from_json(nlohmann::json::object()), nlohmann::json::exception);
}

TEST(Table, SaysStatusAndReason) {
    const std::string text = table_text(report().devices[1]);
    EXPECT_THAT(text, AllOf(HasSubstr("device 1 \"GPU\""), HasSubstr("82 %"), HasSubstr("unsupported: no <luck>"), HasSubstr("12 ms"),
                            HasSubstr("3.4 %")));
}

TEST(Html, IsSelfContainedAndEscaped) {
    const std::string html = report_html(report());
    EXPECT_THAT(html, AllOf(HasSubstr("<svg"), HasSubstr("CPU &amp; &lt;more&gt;"), HasSubstr("no &lt;luck&gt;"),
                            HasSubstr("GuideNet 82 %"), HasSubstr("3 candidates tried, 1 refused")));
    EXPECT_THAT(html, AllOf(Not(HasSubstr("http")), Not(HasSubstr("<script")), Not(HasSubstr("src=")), Not(HasSubstr("nan")),
                            Not(HasSubstr("inf "))));
    std::size_t opened = 0, closed = 0;
    for (std::size_t at = 0; (at = html.find("<svg", at)) != std::string::npos; ++at) ++opened;
    for (std::size_t at = 0; (at = html.find("</svg>", at)) != std::string::npos; ++at) ++closed;
    EXPECT_EQ(opened, closed);
    EXPECT_GE(opened, 2u + 6u) << "two rooflines, bars of six stages";
}

TEST(Html, OneDeviceIsHeldAgainstItsCeilings) {
    Report one;
    one.devices = {device(0, "CPU", 1)};
    fill_shares(one.devices[0]);
    const std::string html = report_html(one);
    EXPECT_THAT(html, AllOf(HasSubstr("Share of the device's ceilings"), HasSubstr("82 % of FMA rate"), Not(HasSubstr("Speed by stage"))));
    EXPECT_THAT(report_html(report()), AllOf(HasSubstr("Speed by stage"), Not(HasSubstr("Share of the device's ceilings"))));
}

/// The texts of a picture by what they say: where they stand, and about how wide they are.
struct Placed {
    double x0, x1, y;
};
std::vector<Placed> placed(const std::string& svg, const std::string& with) {
    std::vector<Placed> all;
    static const std::regex text("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\" text-anchor=\"(start|end)\">([^<]*)</text>");
    for (std::sregex_iterator it(svg.begin(), svg.end(), text), end; it != end; ++it) {
        if ((*it)[4].str().find(with) == std::string::npos) continue;
        const double x = std::stod((*it)[1]), width = 6 * static_cast<double>((*it)[4].length());
        all.push_back({(*it)[3] == "start" ? x : x - width, (*it)[3] == "start" ? x + width : x, std::stod((*it)[2])});
    }
    return all;
}

TEST(Html, LabelsOfTheRooflineStandApart) {
    DeviceRows d = device(0, "CPU", 1);
    d.rows.resize(2);
    for (int k = 0; k < 7; ++k) { // all at about the same place
        d.rows.push_back(row("stage number " + std::to_string(k), 1));
        d.rows.back().flops = (50 + k) * 1e9, d.rows.back().intensity = 1000 + k;
    }
    const std::string svg = roofline_svg(d);
    const std::vector<Placed> labels = placed(svg, "stage number");
    ASSERT_EQ(labels.size(), 7u) << svg;
    for (std::size_t a = 0; a < labels.size(); ++a) {
        EXPECT_GE(labels[a].x0, 64);
        EXPECT_LE(labels[a].x1, 620);
        for (std::size_t b = a + 1; b < labels.size(); ++b)
            EXPECT_TRUE(std::abs(labels[a].y - labels[b].y) >= 12 || labels[a].x1 <= labels[b].x0 || labels[b].x1 <= labels[a].x0)
                << a << " " << b << svg;
    }
}

TEST(Html, NoCeilingNoRoofline) {
    DeviceRows d = device(0, "a", 1);
    d.rows[0].status = Status::error;
    EXPECT_EQ(roofline_svg(d), "");
}

TEST(Times, AreReadable) {
    EXPECT_EQ(time_text(0.0123), "12.3 ms");
    EXPECT_EQ(time_text(4.56e-6), "4.56 us");
    EXPECT_EQ(time_text(1.5), "1.5 s");
    EXPECT_EQ(time_text(0), "-");
}

TEST(Stages, EachHasGoldenHashesAndEachTaskAStage) {
    for (const Stage& s : stages())
        for (const Size size : {Size::standard, Size::tiny}) EXPECT_NE(golden_hash(s.name, size), "") << s.name;
    for (const std::string& task : task_names()) EXPECT_NE(stage_of_task(task), "") << task;
    EXPECT_THROW(stage_named("nonsense"), Error);
}

} // namespace
} // namespace clvr::bench
