// Tunables change speed and never a bit: every declared value, of ranges the ends and a few between, gives the golden bits.
#include "host/phantom/phantom.hpp"
#include "host/selftest/check.hpp"
#include "host/selftest/golden.hpp"
#include "host/train/tunables.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/trust/trust.hpp"

#include <gtest/gtest.h>

namespace clvr::selftest {
namespace {

Device open_device() { return open_trusted(select_devices("").devices.front()); }

std::string phantom_hash(Device& device) {
    const Voxels v = make_phantom(device, "cloud", {Int3{37, 9, 6}, VoxelType::i16});
    const auto* values = v.data<std::int16_t>();
    return sha256_hex(std::string(reinterpret_cast<const char*>(values), v.count() * sizeof *values));
}

/// In round k every tunable has its k-th sample, those with fewer begin again, each at another place: all values come up, in few runs.
std::vector<Tunables> rounds() {
    std::size_t most = 0;
    for (const Tunable* t : declared_tunables()) most = std::max(most, t->allowed.samples().size());
    std::vector<Tunables> rounds(most);
    for (std::size_t k = 0; k < most; ++k)
        for (std::size_t place = 0; place < declared_tunables().size(); ++place) {
            const Tunable& t = *declared_tunables()[place];
            const std::vector<int> samples = t.allowed.samples();
            rounds[k][t.name] = samples[(k + place) % samples.size()];
        }
    return rounds;
}

TEST(Tunables, GiveTheGoldenBitsAtEveryDeclaredValue) {
    Device usual = open_device();
    const std::string phantom = phantom_hash(usual);
    for (const Tunables& round : rounds()) {
        std::string what;
        for (const auto& [name, value] : round) what += (what.empty() ? "" : ",") + name + "=" + std::to_string(value);
        SCOPED_TRACE(what);
        Device device = open_device();
        device.set_tunables(round);
        EXPECT_EQ(pixel_hash(golden_picture(device)), golden_picture_hash);
        EXPECT_EQ(check_training(device).found, golden_training_hash);
        EXPECT_EQ(phantom_hash(device), phantom);
    }
}

/// The sizes where tiles, waves, launches and whole rows of cells divide something: the small picture fits into one of most.
TEST(Tunables, GiveTheGoldenBitsOfLargerFrames) {
    const std::string denoised = pixel_hash(golden_denoised(open_device()));
    for (const Tunables& round :
         {Tunables{{"conv_width", 4}, {"conv_vectors", 3}, {"conv_block", 4}, {"conv_group_y", 8}, {"denoise_mib", 1}},
          Tunables{{"conv_width", 1}, {"conv_group_x", 128}, {"splat_bins", 7}, {"pixel_group", 2}},
          Tunables{{"conv_width", 1}, {"conv_vectors", 2}, {"conv_group_x", 8}}, Tunables{{"conv_width", 8}, {"conv_vectors", 3}},
          Tunables{{"splat_bins", 1}}}) {
        Device device = open_device();
        device.set_tunables(round);
        EXPECT_EQ(pixel_hash(golden_denoised(device)), denoised) << round.begin()->second;
    }
    for (const Tunables& round : {Tunables{{"wave_paths", 333}, {"tile_pixels", 50}, {"march_pixels", 100}, {"packet_run", 3}},
                                  Tunables{{"packet", 4}, {"brick_log2", 3}, {"packet_refill", 1}, {"packet_group", 4}},
                                  Tunables{{"packet", 1}, {"brick_log2", 6}, {"packet_group", 64}, {"shade_group", 16}},
                                  Tunables{{"packet", 8}, {"packet_group", 2}, {"shade_group", 1}}, Tunables{{"packet", 16}}}) {
        Device device = open_device();
        device.set_tunables(round);
        EXPECT_EQ(pixel_hash(render_golden("automatic", {device})), golden_hashes.at("automatic")) << round.begin()->first;
    }
}

/// Rows of planes are padded to whole groups of a convolution and to 16 pixels: here 12 pixels a work-item, which divide neither.
TEST(Tunables, GiveTheGoldenBitsWhereRowsNeedPadding) {
    for (const Tunables& round :
         {Tunables{{"conv_width", 4}, {"conv_vectors", 3}}, Tunables{{"conv_width", 1}, {"conv_vectors", 6}, {"conv_group_x", 2}}}) {
        Device device = open_device();
        device.set_tunables(round);
        EXPECT_EQ(check_training(device).found, golden_training_hash) << round.begin()->second;
    }
}

} // namespace
} // namespace clvr::selftest
