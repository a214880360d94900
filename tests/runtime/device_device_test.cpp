#include "host/render/tunables.hpp"
#include "runtime/opencl/device.hpp"
#include "runtime/trust/trust.hpp"

#include "runtime/choose/select.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <thread>

namespace clvr {
namespace {

DeviceFacts chosen() { return select_devices().devices.at(0); }

template <class Call>
Error error_of(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error;
    }
    ADD_FAILURE() << "nothing was thrown";
    return Error(ErrorKind::internal, "");
}

/// A kernel for the tests: to[i] = first + i for i below n.
class Launches : public testing::Test {
protected:
    Launches() {
        folder_.write("t/iota.cl", "kernel void iota(global int* to, int first, uint n) {\n"
                                   "    const uint i = get_global_id(0);\n"
                                   "    if (i < n) to[i] = first + (int)i;\n"
                                   "}\n");
        set_kernel_dir(folder_.path().string());
    }
    ~Launches() override { set_kernel_dir({}); }

private:
    TemporaryFolder folder_;
};

TEST(Facts, AreWorthBelieving) {
    const DeviceFacts facts = chosen();
    EXPECT_FALSE(facts.name.empty());
    EXPECT_FALSE(facts.platform.empty());
    EXPECT_FALSE(facts.driver_version.empty());
    EXPECT_GE(facts.compute_units, 1u);
    EXPECT_GE(facts.global_bytes, facts.max_alloc_bytes);
    EXPECT_GE(facts.max_alloc_bytes, std::size_t{64} << 20);
    EXPECT_GE(facts.max_work_group, 16u);
    const auto devices = list_devices();
    for (std::size_t i = 0; i < devices.size(); ++i) EXPECT_EQ(devices[i].index, static_cast<int>(i));
}

TEST(Device, TransfersAndFill) {
    Device device = open_trusted(chosen());
    std::vector<int> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), -17);
    Buffer buffer = device.upload(numbers, "numbers");
    EXPECT_EQ(buffer.bytes(), 4000u);
    EXPECT_EQ(device.download<int>(buffer, 1000), numbers);
    EXPECT_EQ(device.download<int>(buffer, 2, 998), (std::vector<int>{981, 982}));
    const int replaced[2] = {5, 6};
    device.write(buffer, replaced, sizeof replaced, 40);
    EXPECT_EQ(device.download<int>(buffer, 4, 9), (std::vector<int>{-8, 5, 6, -5}));
    device.fill(buffer, 0xff);
    EXPECT_EQ(device.download<int>(buffer, 1000), std::vector<int>(1000, -1));
    EXPECT_EQ(device.upload(std::vector<int>{}, "nothing").bytes(), sizeof(int));
    device.finish();
    const auto& rows = device.profile().rows();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].label, "write");
    EXPECT_EQ(rows[0].bytes, 4008);
    EXPECT_EQ(rows[1].label, "read");
    EXPECT_EQ(rows[1].bytes, 4000 + 8 + 16 + 4000);
    EXPECT_EQ(rows[2].label, "fill");
}

TEST(Device, TransfersStayWithinTheBuffer) {
    Device device = open_trusted(chosen());
    Buffer buffer = device.buffer(16, "small");
    char bytes[32] = {};
    EXPECT_NO_THROW(device.write(buffer, bytes, 0, 16));
    EXPECT_EQ(error_of([&] { device.write(buffer, bytes, 17); }).kind(), ErrorKind::internal);
    EXPECT_EQ(error_of([&] { device.write(buffer, bytes, 1, 16); }).kind(), ErrorKind::internal);
    EXPECT_EQ(error_of([&] { device.read(buffer, bytes, 16, 1); }).kind(), ErrorKind::internal);
    EXPECT_EQ(error_of([&] { device.read(buffer, bytes, 2, SIZE_MAX); }).kind(), ErrorKind::internal);
    Buffer none;
    EXPECT_EQ(error_of([&] { device.read(none, bytes, 1); }).kind(), ErrorKind::internal);
}

TEST(Device, AccountsItsBuffers) {
    Device device = open_trusted(chosen());
    ASSERT_EQ(device.used_bytes(), 0u);
    const std::size_t free = device.free_bytes();
    {
        const Buffer a = device.buffer(1000, "a");
        Buffer b = device.buffer(500, "b");
        EXPECT_EQ(device.used_bytes(), 1500u);
        EXPECT_EQ(device.free_bytes(), free - 1500);
        const Buffer moved = std::move(b);
        EXPECT_FALSE(b);
        EXPECT_EQ(device.used_bytes(), 1500u);
        Buffer replaced = device.buffer(10, "c");
        replaced = device.buffer(20, "d");
        EXPECT_EQ(device.used_bytes(), 1520u);
    }
    EXPECT_EQ(device.used_bytes(), 0u);
    EXPECT_EQ(device.peak_bytes(), 1530u);
}

TEST(Device, RefusesBeforeAllocating) {
    const ScopedVariable alloc("CLVR_MAX_ALLOC", "1M"), memory("CLVR_MAX_MEMORY", "2M");
    Device device = open_trusted(chosen());
    EXPECT_EQ(device.max_alloc_bytes(), 1u << 20);
    EXPECT_EQ(device.free_bytes(), 2u << 20);
    const Error large = error_of([&] { device.buffer((1 << 20) + 1, "frames"); });
    EXPECT_EQ(large.kind(), ErrorKind::device_memory);
    EXPECT_THAT(large.line(), testing::AllOf(testing::StartsWith("frames on "), testing::HasSubstr("1.0 MiB")));
    const Buffer a = device.buffer(1 << 20, "a"), b = device.buffer(900 << 10, "b");
    const Error full = error_of([&] { device.buffer(200 << 10, "c"); });
    EXPECT_EQ(full.kind(), ErrorKind::device_memory);
    EXPECT_THAT(full.what(), testing::AllOf(testing::HasSubstr("200 KiB"), testing::HasSubstr("2.0 MiB"), testing::HasSubstr("124 KiB")));
    EXPECT_EQ(device.used_bytes(), a.bytes() + b.bytes());
    device.set_memory_limit(1 << 20);
    EXPECT_EQ(device.free_bytes(), 0u);
    EXPECT_EQ(error_of([&] { device.buffer(1, "d"); }).kind(), ErrorKind::device_memory);
}

TEST(Device, WithoutACompilerIsRefusedByName) {
    DeviceFacts facts = chosen();
    facts.has_compiler = false;
    const Error error = error_of([&] { open_trusted(facts); });
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_EQ(error.where(), facts.name);
    EXPECT_THAT(error.what(), testing::HasSubstr("no OpenCL compiler"));
}

TEST(Device, WrongLimitIsAUsageError) {
    const ScopedVariable alloc("CLVR_MAX_ALLOC", "lots");
    EXPECT_EQ(error_of([] { open_trusted(chosen()); }).line().rfind("CLVR_MAX_ALLOC: ", 0), 0u);
}

TEST(Device, OneAccountForAllThatIsOpenedOnADevice) {
    Device first = open_trusted(chosen()), second = open_trusted(chosen());
    const Buffer buffer = first.buffer(100, "a");
    EXPECT_EQ(second.used_bytes(), 100u);
}

TEST(Device, Tunables) {
    const ScopedVariable tune("CLVR_TUNE", "packet=8,conv_vectors=3");
    Device device = open_trusted(chosen());
    EXPECT_EQ(device.tunable(tunables::packet), 8);
    EXPECT_EQ(device.tunable(tunables::packet_refill), 2) << "the default of such packets";
    EXPECT_EQ(device.tunable(tunables::packet_run), tunables::packet_run.usual(device.facts(), {{"packet", 8}}));
    EXPECT_EQ(device.tunable(tunables::tile_pixels, 7), 7) << "what the stage chooses";
    device.set_tunable("packet", 4);
    EXPECT_EQ(device.tunable(tunables::packet), 4);
    device.set_tunables({{"tile_pixels", 20}});
    EXPECT_EQ(device.tunable(tunables::tile_pixels, 7), 20);
    EXPECT_EQ(device.tunable(tunables::packet), tunables::packet.usual(device.facts(), {}));
    EXPECT_EQ(error_of([&] { device.set_tunable("packets", 4); }).kind(), ErrorKind::usage);
    EXPECT_EQ(error_of([&] { device.set_tunable("packet", 2); }).kind(), ErrorKind::usage);
    EXPECT_EQ(error_of([&] { device.set_tunables({{"packet", 2}}); }).kind(), ErrorKind::usage);
    const ScopedVariable bad("CLVR_TUNE", "packet=2");
    EXPECT_EQ(error_of([] { open_trusted(chosen()); }).kind(), ErrorKind::usage);
}

TEST_F(Launches, AreRoundedUpToTheLocalSize) {
    Device device = open_trusted(chosen());
    Buffer numbers = device.buffer(1001 * sizeof(int), "numbers");
    device.fill(numbers, 0);
    Kernel iota = device.kernel("t/iota");
    device.launch(iota, {1000}, {16}, {4000, 0}, numbers, 7, cl_uint{1000});
    std::vector<int> expected(1001, 0);
    std::iota(expected.begin(), expected.end() - 1, 7);
    EXPECT_EQ(device.download<int>(numbers, 1001), expected);
    device.finish();
    EXPECT_EQ(device.profile().rows().at(1).label, "iota");
    EXPECT_EQ(device.profile().rows().at(1).bytes, 4000);
}

TEST_F(Launches, ThatCannotBeAreRefused) {
    Device device = open_trusted(chosen());
    Buffer numbers = device.buffer(16, "numbers");
    Kernel iota = device.kernel("t/iota");
    EXPECT_EQ(error_of([&] { device.launch(iota, {16}, {0}, {}, numbers, 0, cl_uint{4}); }).kind(), ErrorKind::internal);
    const std::size_t above = 2 * device.facts().max_work_group;
    EXPECT_EQ(error_of([&] { device.launch(iota, {above}, {above}, {}, numbers, 0, cl_uint{4}); }).kind(), ErrorKind::device);
    const Error wrong_size = error_of([&] { device.launch(iota, {4}, {1}, {}, numbers, 'c', cl_uint{4}); });
    EXPECT_THAT(wrong_size.line(),
                testing::AllOf(testing::HasSubstr("argument 1 (1 bytes) of kernel iota"), testing::HasSubstr("CL_INVALID_ARG_SIZE")));
    device.finish();
    EXPECT_TRUE(device.profile().rows().empty());
    device.launch(iota, {0}, {1}, {}, numbers, 0, cl_uint{0}); // nothing to do
    device.finish();
    EXPECT_TRUE(device.profile().rows().empty());
}

TEST_F(Launches, AreEachTimedOnce) {
    Device device = open_trusted(chosen());
    Buffer numbers = device.buffer(4, "numbers");
    Kernel iota = device.kernel("t/iota");
    for (int i = 0; i < 3000; ++i) device.launch(iota, {1}, {1}, {0, 2}, numbers, i, cl_uint{1});
    EXPECT_GE(device.profile().rows().at(0).launches, 1000u) << "events are not kept to the end";
    device.finish();
    EXPECT_EQ(device.profile().rows().at(0).launches, 3000u);
    EXPECT_EQ(device.profile().rows().at(0).flops, 6000);
    EXPECT_EQ(device.download<int>(numbers, 1).at(0), 2999);
}

TEST(Device, KernelsAreBuiltPerDefinitions) {
    const TemporaryFolder folder;
    folder.write("t/value.cl", "#include \"value.clh\"\nkernel void value(global int* to, local int* scratch) { scratch[0] = VALUE + ONE; "
                               "to[0] = scratch[0]; }\n");
    folder.write("t/value.clh", "#define ONE 1\n");
    const ScopedKernels kernels(folder);
    Device device = open_trusted(chosen());
    Buffer result = device.buffer(4, "result");
    for (const int value : {1, 2, 1}) {
        Kernel kernel = device.kernel("t/value", {{"VALUE", std::to_string(value)}});
        EXPECT_EQ(kernel.label(), "value");
        device.launch(kernel, {1}, {1}, {}, result, LocalMemory{4});
        EXPECT_EQ(device.download<int>(result, 1).at(0), value + 1);
    }
    EXPECT_EQ(error_of([&] { device.kernel("t/value", {{"VALUE", "1 2"}}); }).kind(), ErrorKind::internal);
    EXPECT_EQ(error_of([&] { device.kernel("t/none"); }).kind(), ErrorKind::input);
}

TEST(Device, BuildFailureShowsFileAndLine) {
    const TemporaryFolder folder;
    folder.write("t/broken.cl",
                 "#include \"lib/fine.clh\"\n#include \"broken.clh\"\nkernel void broken(global int* to) { to[0] = fine(); }\n");
    folder.write("lib/fine.clh", "int fine(void);\nint fine(void) { return 1; }\n");
    folder.write("t/broken.clh", "// a comment\n\nint wrong = undeclared_name;\n");
    const ScopedKernels kernels(folder);
    Device device = open_trusted(chosen());
    const Error error = error_of([&] { device.kernel("t/broken"); });
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_EQ(error.where(), "t/broken.cl");
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("t/broken.clh:3:"), testing::HasSubstr("undeclared_name"),
                                             testing::HasSubstr(device.facts().name)));
}

TEST(Device, MissingEntryPointIsNamed) {
    const TemporaryFolder folder;
    folder.write("t/one.cl", "kernel void another(global int* to) { to[0] = 1; }\n");
    const ScopedKernels kernels(folder);
    Device device = open_trusted(chosen());
    EXPECT_THAT(error_of([&] { device.kernel("t/one"); }).line(),
                testing::AllOf(testing::HasSubstr("entry point one"), testing::HasSubstr("CL_INVALID_KERNEL_NAME")));
}

TEST_F(Launches, OnSubDevicesShareAContextAndAnAccount) {
    const DeviceFacts root = chosen();
    if (root.max_sub_devices < 2) GTEST_SKIP() << root.name << " cannot be divided";
    const Selection selection = select_devices(std::to_string(root.index) + "/2");
    ASSERT_EQ(selection.devices.size(), 2u);
    Device first = open_trusted(selection.devices[0]), second = open_trusted(selection.devices[1]);
    EXPECT_EQ(first.context()(), second.context()());
    EXPECT_EQ(first.facts().sub_device, 0);
    EXPECT_EQ(second.facts().sub_device, 1);
    EXPECT_EQ(first.facts().compute_units, root.compute_units / 2);
    std::vector<Device> devices{first, second};
    std::vector<std::vector<int>> results(2);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < 2; ++i)
        threads.emplace_back([&, i] {
            Device& device = devices[i];
            Buffer numbers = device.buffer(4000, "numbers");
            Kernel iota = device.kernel("t/iota");
            for (int k = 0; k < 100; ++k) device.launch(iota, {1000}, {8}, {}, numbers, k + static_cast<int>(i), cl_uint{1000});
            results[i] = device.download<int>(numbers, 1000);
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(results[i].front(), 99 + static_cast<int>(i));
        EXPECT_EQ(results[i].back(), 1098 + static_cast<int>(i));
    }
    const Buffer buffer = first.buffer(100, "a");
    EXPECT_EQ(second.used_bytes(), 100u);
}

TEST(Facts, NoMoreSubDevicesThanComputeUnits) {
    const DeviceFacts root = chosen();
    EXPECT_EQ(error_of([&] { divide(root, static_cast<int>(root.compute_units) + 1); }).kind(), ErrorKind::device);
}

} // namespace
} // namespace clvr
