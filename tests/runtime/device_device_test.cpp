#include "runtime/device.hpp"
#include "runtime/select.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

Device first_device() { return Device::open(select_devices().devices.at(0)); }

TEST(Device, LaunchIsRoundedUpToTheLocalSize) {
    Device device = first_device();
    Buffer numbers = device.buffer(1000 * sizeof(int), "numbers");
    device.fill(numbers, 0);
    Kernel iota = device.kernel("probe/iota");
    device.launch(iota, {1000}, {64}, {}, numbers, 7, cl_uint{1000});
    const auto values = device.download<int>(numbers, 1000);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(values[static_cast<std::size_t>(i)], 7 + i);
    device.finish();
    EXPECT_EQ(device.profile().rows().size(), 3u);
}

} // namespace
} // namespace clvr
