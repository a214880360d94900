#include "runtime/choose/select.hpp"

#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"
#include "tests/runtime/warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clvr {
namespace {

DeviceFacts device(const std::string& name, DeviceType type, bool simulator = false) {
    DeviceFacts facts;
    facts.name = name;
    facts.type = type;
    facts.simulator = simulator;
    facts.available = facts.has_compiler = true;
    facts.version = "OpenCL 3.0 fake";
    return facts;
}

std::vector<PlatformFacts> machine(std::vector<PlatformFacts> platforms) {
    int index = 0;
    for (PlatformFacts& platform : platforms)
        for (DeviceFacts& d : platform.devices) {
            d.index = index++;
            d.platform = platform.name;
        }
    return platforms;
}

/// 0 cpu, 1 simulator, 2 and 3 equal gpus, 4 another gpu without a compiler.
std::vector<PlatformFacts> rich_machine() {
    DeviceFacts broken = device("Old GPU", DeviceType::gpu);
    broken.has_compiler = false;
    return machine({{"Portable", "", "", {device("Host CPU 9000", DeviceType::cpu)}},
                    {"Oclgrind", "", "", {device("Oclgrind Simulator", DeviceType::cpu, true)}},
                    {"Empty", "", "", {}},
                    {"Fast", "", "", {device("Big GPU", DeviceType::gpu), device("Big GPU", DeviceType::gpu), broken}}});
}

std::size_t last(const std::vector<std::size_t>& candidates) { return candidates.back(); }

std::size_t unexpected(const std::vector<std::size_t>&) {
    ADD_FAILURE() << "no speed probe was needed";
    return 0;
}

/// "0", "0/2", "2 3": what was chosen.
std::string chosen(const Wishes& wishes, const Fastest& fastest = unexpected,
                   const std::vector<PlatformFacts>& platforms = rich_machine()) {
    std::string text;
    for (const DevicePart& part : choose_devices(platforms, wishes, fastest).parts)
        text += (text.empty() ? "" : " ") + std::to_string(part.device) + (part.sub_devices ? "/" + std::to_string(part.sub_devices) : "");
    return text;
}

std::string option(const std::string& selector, const Fastest& fastest = unexpected) { return chosen({selector, "", {}}, fastest); }

Error refusal(const Wishes& wishes, const std::vector<PlatformFacts>& platforms = rich_machine()) {
    try {
        choose_devices(platforms, wishes, last);
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was refused";
    return Error(ErrorKind::internal, "");
}

TEST(Selector, Grammar) {
    EXPECT_EQ(option("0"), "0");
    EXPECT_EQ(option("3"), "3");
    EXPECT_EQ(option("cpu"), "0");
    EXPECT_EQ(option("CPU"), "0");
    EXPECT_EQ(option("gpu", last), "3") << "the fastest of two";
    EXPECT_EQ(option("host c"), "0");
    EXPECT_EQ(option("portable"), "0") << "a platform's name";
    EXPECT_EQ(option("cpu/2"), "0/2");
    EXPECT_EQ(option("0/16"), "0/16");
    EXPECT_EQ(option("2+3"), "2 3");
    EXPECT_EQ(option("gpu+cpu/2", last), "3 0/2");
}

TEST(Selector, SimulatorsOnlyWhenNamed) {
    EXPECT_EQ(option("1"), "1");
    EXPECT_EQ(option("oclgrind"), "1");
    EXPECT_EQ(option("cpu"), "0");
    const auto alone = machine({{"Oclgrind", "", "", {device("Oclgrind Simulator", DeviceType::cpu, true)}}});
    EXPECT_EQ(refusal({"cpu", "", {}}, alone).kind(), ErrorKind::device);
    EXPECT_THAT(refusal({}, alone).what(), testing::HasSubstr("simulators"));
}

TEST(Selector, NoDeviceFits) {
    for (const char* text : {"5", "9999", "nothing like this"}) EXPECT_EQ(refusal({text, "", {}}).kind(), ErrorKind::device) << text;
    EXPECT_THAT(refusal({"5", "", {}}).line(), testing::AllOf(testing::StartsWith("--device: "), testing::HasSubstr("2 \"Big GPU\"")));
}

TEST(Selector, SeveralDevicesFitAName) {
    const Error error = refusal({"big gpu", "", {}});
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("2 \"Big GPU\", 3 \"Big GPU\""), testing::Not(testing::HasSubstr("Host"))));
}

TEST(Selector, Malformed) {
    for (const char* text : {"+", "0+", "+0", "0++2", "cpu/", "cpu/1", "cpu/0", "cpu/x", "cpu/-2", "/2", "cpu/99999", "0+0", "0+cpu/2"})
        EXPECT_EQ(refusal({text, "", {}}).kind(), ErrorKind::usage) << text;
}

TEST(Selection, OrderOfTheRules) {
    const std::vector<RememberedDevice> remembered{{"Fast", "Big GPU", 1, 0}};
    EXPECT_EQ(chosen({"0", "2", remembered}), "0");
    EXPECT_EQ(chosen({"", "2", remembered}), "2");
    EXPECT_EQ(chosen({"", "", remembered}), "3");
    EXPECT_EQ(chosen({}, last), "3") << "not device 4, which has no compiler";
    std::vector<std::size_t> asked;
    chosen({}, [&](const std::vector<std::size_t>& candidates) {
        asked = candidates;
        return candidates.front();
    });
    EXPECT_EQ(asked, (std::vector<std::size_t>{0, 2, 3}));
}

TEST(Selection, RuleIsSaid) {
    EXPECT_THAT(choose_devices(rich_machine(), {"0", "", {}}, unexpected).rule, testing::HasSubstr("--device 0"));
    EXPECT_THAT(choose_devices(rich_machine(), {"", "0", {}}, unexpected).rule, testing::HasSubstr("CLVR_DEVICE=0"));
    EXPECT_THAT(choose_devices(rich_machine(), {"", "", {{{"Portable", "Host CPU 9000", 0, 2}}}}, unexpected).rule,
                testing::HasSubstr("remembered"));
    EXPECT_THAT(choose_devices(rich_machine(), {}, last).rule, testing::HasSubstr("fastest of 3"));
    const auto one = machine({{"Portable", "", "", {device("Host CPU", DeviceType::cpu)}}});
    EXPECT_THAT(choose_devices(one, {}, unexpected).rule, testing::HasSubstr("only usable device"));
}

TEST(Selection, EnvironmentIsNamedWhenItIsWrong) { EXPECT_THAT(refusal({"", "none", {}}).line(), testing::StartsWith("CLVR_DEVICE: ")); }

TEST(Selection, RememberedDeviceThatIsGone) {
    const Choice choice = choose_devices(rich_machine(), {"", "", {{{"Fast", "Big GPU", 2, 0}}}}, last);
    EXPECT_EQ(choice.parts.at(0).device, 3u);
    EXPECT_THAT(choice.rule, testing::AllOf(testing::HasSubstr("fastest"), testing::HasSubstr("\"Big GPU\" is gone")));
}

TEST(Selection, NoPlatformAndNoDevice) {
    EXPECT_EQ(refusal({}, {}).exit_code(), 4);
    EXPECT_THAT(refusal({}, {}).what(), testing::AllOf(testing::HasSubstr("no OpenCL platform"), testing::HasSubstr("pocl-opencl-icd")));
    const auto empty = machine({{"Clover", "", "", {}}, {"Other", "", "", {}}});
    EXPECT_EQ(refusal({"cpu", "", {}}, empty).exit_code(), 4);
    EXPECT_THAT(refusal({}, empty).what(),
                testing::AllOf(testing::HasSubstr("\"Clover\", \"Other\""), testing::HasSubstr("pocl-opencl-icd")));
}

TEST(Usable, SaysWhy) {
    DeviceFacts d = device("x", DeviceType::gpu);
    EXPECT_EQ(why_unusable(d), "");
    d.version = "OpenCL 1.2 ";
    EXPECT_EQ(why_unusable(d), "");
    d.version = "OpenCL 1.1 Mesa";
    EXPECT_THAT(why_unusable(d), testing::HasSubstr("1.2"));
    d = device("x", DeviceType::gpu);
    d.available = false;
    EXPECT_NE(why_unusable(d), "");
}

TEST(Select, AllIsEveryUsableDeviceThatIsNoSimulator) {
    EXPECT_EQ(option("all"), "0 2 3");
    EXPECT_EQ(option("ALL+1"), "0 2 3 1");
    EXPECT_EQ(refusal({"all/2", "", {}}).kind(), ErrorKind::usage);
    EXPECT_EQ(refusal({"all+0", "", {}}).kind(), ErrorKind::usage);
    const auto simulators = machine({{"Oclgrind", "", "", {device("Oclgrind Simulator", DeviceType::cpu, true)}}});
    EXPECT_EQ(refusal({"all", "", {}}, simulators).kind(), ErrorKind::device);
}

TEST(Remembered, SavedAndRecalled) {
    const TemporaryFolder folder;
    const ScopedVariable config("XDG_CONFIG_HOME", folder.path().string());
    EXPECT_FALSE(load_remembered());
    std::vector<DeviceFacts> devices;
    for (const PlatformFacts& platform : rich_machine()) devices.insert(devices.end(), platform.devices.begin(), platform.devices.end());
    devices[0].max_sub_devices = 2;
    save_remembered(remember({{3, 0}, {0, 2}}, devices));
    const auto parts = recall(load_remembered().value(), devices);
    ASSERT_TRUE(parts);
    ASSERT_EQ(parts->size(), 2u);
    EXPECT_EQ((*parts)[0].device, 3u) << "the second of two with one name";
    EXPECT_EQ((*parts)[1].device, 0u);
    EXPECT_EQ((*parts)[1].sub_devices, 2);
    devices[0].max_sub_devices = 0;
    EXPECT_FALSE(recall(load_remembered().value(), devices)) << "it cannot be divided any more";
    devices[0].max_sub_devices = 2;
    devices.pop_back();
    devices.pop_back();
    EXPECT_FALSE(recall(load_remembered().value(), devices)) << "one of them is gone";
}

TEST(Remembered, ByTask) {
    const TemporaryFolder folder;
    const ScopedVariable config("XDG_CONFIG_HOME", folder.path().string());
    save_remembered({{"p", "general", 0, 0}}, {{"train", {{"p", "trainer", 0, 0}, {"p", "helper", 1, 2}}}});
    EXPECT_EQ(load_remembered()->at(0).name, "general");
    EXPECT_EQ(load_remembered("render")->at(0).name, "general");
    ASSERT_EQ(load_remembered("train")->size(), 2u);
    EXPECT_EQ(load_remembered("train")->at(1).sub_devices, 2);
    folder.write("clvr/device.json", R"({"devices": [{"platform": "p", "name": "n"}], "tasks": {"train": []}})");
    EXPECT_FALSE(load_remembered("train")) << "with a warning";
    EXPECT_EQ(load_remembered("render")->at(0).name, "n");
}

TEST(Remembered, BrokenFileIsIgnoredWithAWarning) {
    const TemporaryFolder folder;
    const ScopedVariable config("XDG_CONFIG_HOME", folder.path().string());
    const Warnings warnings;
    for (const char* text : {"", "{", "[]", "{\"devices\": 3}", "{\"devices\": []}", "{\"devices\": [{\"name\": 1}]}",
                             "{\"devices\": [{\"platform\": \"p\", \"name\": \"n\", \"occurrence\": 1e300}]}",
                             "{\"devices\": [{\"platform\": \"p\", \"name\": \"n\", \"sub_devices\": -1}]}"}) {
        folder.write("clvr/device.json", text);
        EXPECT_FALSE(load_remembered()) << text;
    }
    EXPECT_THAT(warnings.text(), testing::AllOf(testing::HasSubstr("device.json"), testing::HasSubstr("is not a list of devices"),
                                                testing::HasSubstr("names no device")));
    EXPECT_EQ(warnings.lines(), 2) << "once each";
    const ScopedVariable unwritable("XDG_CONFIG_HOME", "/dev/null");
    EXPECT_THROW(save_remembered({{"p", "n", 0, 0}}), Error);
}

} // namespace
} // namespace clvr
