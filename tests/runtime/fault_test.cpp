// What CLVR_FAULT means, without a device.
#include "runtime/opencl/fault.hpp"

#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace clvr {
namespace {

DeviceFacts part(int index, int sub_device) {
    DeviceFacts facts;
    facts.index = index;
    facts.sub_device = sub_device;
    facts.sub_devices = sub_device < 0 ? 0 : 2;
    return facts;
}

std::unique_ptr<Faults> faults(const std::string& text, const DeviceFacts& device = part(0, -1)) {
    const ScopedVariable variable("CLVR_FAULT", text);
    return Faults::of(device);
}

TEST(Faults, AreForTheDevicesNamed) {
    const ScopedVariable none("CLVR_FAULT", std::nullopt);
    EXPECT_FALSE(Faults::of(part(0, -1)));
    EXPECT_FALSE(faults(""));
    EXPECT_TRUE(faults("launch:1", part(3, 1)));
    EXPECT_TRUE(faults("launch:1@3", part(3, 1)));
    EXPECT_FALSE(faults("launch:1@3", part(2, 1)));
    EXPECT_TRUE(faults("alloc:5@1,launch:1@3.2", part(3, 1)));
    EXPECT_FALSE(faults("launch:1@3.2", part(3, 0)));
    EXPECT_FALSE(faults("launch:1@3.2", part(3, -1)));
}

TEST(Faults, ALostDeviceStaysLost) {
    const auto f = faults("launch:3");
    f->launch("a"), f->launch("b");
    f->call("clFinish");
    EXPECT_THROW(f->launch("c"), cl::Error);
    EXPECT_THROW(f->call("clFinish"), cl::Error);
    EXPECT_THROW(f->allocate(), cl::Error);
}

TEST(Faults, OneAllocationFails) {
    const auto f = faults("alloc:2");
    f->allocate();
    EXPECT_THROW(f->allocate(), cl::Error);
    f->allocate();
}

TEST(Faults, OneBitIsWrongAfterTheStage) {
    const auto f = faults("result:render/shade");
    EXPECT_TRUE(f->spoils_results());
    std::vector<std::uint32_t> data(5);
    f->launch("free_flight");
    f->read(data.data(), 20);
    EXPECT_EQ(data, std::vector<std::uint32_t>(5));
    f->launch("shade");
    f->read(data.data(), 20);
    EXPECT_EQ(data, (std::vector<std::uint32_t>{0, 0, 1, 0, 0}));
    f->read(data.data(), 20);
    EXPECT_EQ(data[2], 1u);
}

TEST(Faults, BuildsAndDelays) {
    const auto f = faults("build:render/shade,delay:20");
    EXPECT_TRUE(f->breaks_build("render/shade"));
    EXPECT_FALSE(f->breaks_build("render/march"));
    const auto begin = std::chrono::steady_clock::now();
    f->launch("march");
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(20));
}

TEST(Faults, DoNotDisturbProbes) {
    const ProbeScope probing;
    EXPECT_FALSE(faults("launch:1,alloc:1,delay:5,build:probe/trust"));
    EXPECT_TRUE(faults("launch:1,result:trust"));
}

TEST(Faults, NonsenseIsRefused) {
    for (const char* text : {"launch", "launch:", "launch:0", "launch:x", "explode:1", "build:", "launch:1@x", "launch:1@0.x", "@0"}) try {
            faults(text);
            ADD_FAILURE() << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage) << text;
        }
}

} // namespace
} // namespace clvr
