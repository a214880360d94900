// The walk through the tunables with candidates that are better, worse, wrong, crash or hang; and what is tried of the declared tunables.
#include "tools/bench/bench.hpp"
#include "tools/bench/stage.hpp"
#include "tools/bench/tuner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace clvr::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;

double never_late() { return 0; }

int value(const Tunables& t, int fallback) { return t.count("k") ? t.at("k") : fallback; }

/// Speed of each value of knob "k": evaluates as a perfect measurement would.
Evaluate speeds(const std::map<int, double>& speed, std::vector<int>* tried = nullptr, double spread = 0.001) {
    return [=](const Tunables& base, const Tunables& candidate, const std::vector<std::string>&) {
        const int from = value(base, 4), to = value(candidate, 4);
        if (tried) tried->push_back(to);
        return Verdict{Status::ok, "", speed.at(to) / speed.at(from), spread, false};
    };
}

int current(const Tunables& t) { return value(t, 4); }
const Knob knob{"k", {"GuideNet"}, {1, 2, 4, 8, 16}, current};

TEST(Tune, FindsTheTopAndStopsBehindIt) {
    std::vector<int> tried;
    const TunedDevice t = tune({knob}, {}, speeds({{1, 0.5}, {2, 0.8}, {4, 1}, {8, 1.3}, {16, 1.1}}, &tried), never_late, 1);
    EXPECT_EQ(t.tuning.values, (Tunables{{"k", 8}}));
    EXPECT_EQ(tried, (std::vector<int>{2, 8, 16, 8})) << "1 is not tried behind the slower 2; 8 is held against the start in the end";
    EXPECT_EQ(t.tried, 3);
    EXPECT_THAT(t.tuning.evidence, Contains(HasSubstr("k 8: 1.300 x")));
    EXPECT_THAT(t.tuning.evidence, Contains(HasSubstr("in the end: 1.300 x")));
}

TEST(Tune, KeepsTheStartWhereNothingIsBetter) {
    EXPECT_EQ(tune({knob}, {}, speeds({{1, 1}, {2, 1.01}, {4, 1}, {8, 0.9}, {16, 2}}), never_late, 1).tuning.values, Tunables());
    EXPECT_EQ(
        tune({knob}, {{"k", 2}, {"other", 7}}, speeds({{1, 0.5}, {2, 1}, {4, 0.9}, {8, 0.8}, {16, 0.8}}), never_late, 1).tuning.values,
        (Tunables{{"k", 2}, {"other", 7}}));
}

TEST(Tune, NoiseIsNoGain) {
    EXPECT_EQ(tune({knob}, {}, speeds({{1, 1}, {2, 1.05}, {4, 1}, {8, 1.05}, {16, 1.05}}, nullptr, 0.1), never_late, 1).tuning.values,
              Tunables());
}

TEST(Tune, WrongCrashedAndHungCandidatesAreRefused) {
    for (const Status status : {Status::wrong_result, Status::error, Status::unsupported}) {
        const Evaluate evaluate = [&](const Tunables&, const Tunables& candidate, const std::vector<std::string>&) {
            if (value(candidate, 4) > 4) return Verdict{status, "why", 9, 0, false};
            return Verdict{Status::ok, "", 0.5, 0, false};
        };
        const TunedDevice t = tune({knob}, {}, evaluate, never_late, 1);
        EXPECT_EQ(t.tuning.values, Tunables()) << "its speed of 9 does not count";
        EXPECT_EQ(t.refused, 1) << "16 is not tried behind it";
        EXPECT_THAT(t.tuning.evidence, Contains(HasSubstr(std::string("k 8: ") + status_name(status) + ": why")));
    }
}

TEST(Tune, WhatLosesInTheEndGoesBack) {
    const Evaluate evaluate = [](const Tunables& base, const Tunables& candidate, const std::vector<std::string>& on) {
        const bool end = base.empty() && on.size() == 1;
        return Verdict{Status::ok, "", end ? on.front() == "slice" ? 0.9 : 1.2 : value(candidate, 4) == 8 ? 1.3 : 0.9, 0, false};
    };
    const Knob two{"k", {"GuideNet", "slice"}, {4, 8}, current};
    const TunedDevice t = tune({two}, {}, evaluate, never_late, 1);
    EXPECT_EQ(t.tuning.values, Tunables());
    EXPECT_THAT(t.tuning.evidence, Contains(HasSubstr("goes back")));
}

TEST(Tune, WhatGainsNothingInTheEndGoesBack) {
    const Evaluate evaluate = [](const Tunables& base, const Tunables& candidate, const std::vector<std::string>&) {
        const bool walk = value(candidate, 4) != 16 && base.empty() && value(candidate, 4) != 8;
        static int asked;
        if (value(candidate, 4) == 8) return Verdict{Status::ok, "", ++asked == 1 ? 1.1 : 1.0, 0, false};
        return Verdict{Status::ok, "", walk ? 0.9 : 0.8, 0, false};
    };
    const TunedDevice t = tune({knob}, {}, evaluate, never_late, 1);
    EXPECT_EQ(t.tuning.values, Tunables());
    EXPECT_THAT(t.tuning.evidence, Contains(HasSubstr("k goes back: nothing was gained")));
}

TEST(Tune, EndsInTime) {
    double now = 0;
    const Evaluate slow = [&](const Tunables&, const Tunables&, const std::vector<std::string>&) {
        now += 10;
        return Verdict{Status::ok, "", 1, 0, false};
    };
    Knob second = knob;
    second.name = "second";
    const TunedDevice t = tune(
        {knob, second}, {}, slow, [&] { return now; }, 35);
    EXPECT_EQ(t.tried, 4);
    EXPECT_THAT(t.left_out, Contains("second"));
}

DeviceFacts facts(DeviceType type) {
    DeviceFacts d;
    d.type = type;
    d.native_float_width = 16;
    return d;
}

TEST(Knobs, AreSound) {
    for (const DeviceType type : {DeviceType::cpu, DeviceType::gpu}) {
        for (const Knob& k : knobs_for(facts(type), false)) {
            EXPECT_TRUE(std::is_sorted(k.values.begin(), k.values.end())) << k.name;
            EXPECT_GE(k.values.size(), 2u) << k.name;
            EXPECT_FALSE(k.stages.empty()) << k.name;
            for (const std::string& stage : k.stages) EXPECT_NO_THROW(stage_named(stage)) << k.name;
            for (const int candidate : k.values) EXPECT_EQ(why_refused(k.name, candidate), "");
            EXPECT_EQ(k.current({{k.name, 77}}), 77);
        }
        EXPECT_LT(knobs_for(facts(type), true).size(), knobs_for(facts(type), false).size());
        EXPECT_EQ(knobs_for(facts(type), false).size(), declared_tunables().size() - 1) << "tile_pixels";
    }
}

const CompareJob job{{0, -1, 0, "x"}, {"GuideNet"}, {}, {{"packet", 8}}, 3};

TEST(FakeChild, AnswersCrashesHangsAndComesBack) {
    Child child({"/bin/sh", "-c",
                 "while read line; do case \"$line\" in *crash*) kill -SEGV $$;; *hang*) exec sleep 60;; *leave*) exit 7;; *big*) head -c "
                 "300000 /dev/zero | tr '\\0' x; "
                 "echo;; *) echo \"got $line\";; esac; done"});
    EXPECT_EQ(child.ask("one", 10).text, "got one");
    EXPECT_EQ(child.ask("two", 10).text, "got two");
    EXPECT_EQ(child.starts(), 1);
    const Answer crash = child.ask("crash", 10);
    EXPECT_FALSE(crash.ok);
    EXPECT_THAT(crash.why, HasSubstr("Segmentation fault"));
    EXPECT_EQ(child.ask("three", 10).text, "got three");
    EXPECT_EQ(child.starts(), 2);
    const Answer hang = child.ask("hang", 0.2);
    EXPECT_FALSE(hang.ok);
    EXPECT_THAT(hang.why, HasSubstr("no answer within"));
    EXPECT_THAT(child.ask("leave", 10).why, HasSubstr("exit code 7"));
    EXPECT_EQ(child.ask("big", 10).text.size(), 300000u);
    EXPECT_EQ(child.ask("four", 10).text, "got four");
}

TEST(FakeChild, ThatCannotBeStarted) {
    Child child({"/no/such/program"});
    EXPECT_THAT(child.ask("x", 10).why, HasSubstr("exit code 127"));
}

TEST(FakeChild, BadAnswersBecomeErrors) {
    for (const std::string script :
         {"while read l; do echo nonsense; done", "while read l; do echo '{}'; done", "kill -ABRT $$", "exec sleep 60"}) {
        Child child({"/bin/sh", "-c", script});
        const Verdict v = ask_verdict(child, job, 0.3);
        EXPECT_EQ(v.status, Status::error) << script;
        EXPECT_NE(v.reason, "") << script;
        const Row row = ask_row(child, {{job.device}, "copy", true, 0, false}, 0.3);
        EXPECT_EQ(row.status, Status::error) << script;
        EXPECT_EQ(row.stage, "copy");
        EXPECT_THAT(row.reason, HasSubstr("the driver's process")) << script;
    }
}

TEST(FakeChild, VerdictIsRead) {
    Child child(
        {"/bin/sh", "-c", R"(read l; echo '{"status": "wrong result", "reason": "bits", "speedup": 2.5, "spread": 0.1, "pruned": true}')"});
    const Verdict v = ask_verdict(child, job, 10);
    EXPECT_EQ(v.status, Status::wrong_result);
    EXPECT_EQ(v.reason, "bits");
    EXPECT_EQ(v.speedup, 2.5);
    EXPECT_TRUE(v.pruned);
}

} // namespace
} // namespace clvr::bench
