#include "host/experiment/ablation.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

using testing::HasSubstr;

TEST(AblationRows, AddUpThenChangeOneThing) {
    const auto& rows = ablation_rows();
    ASSERT_EQ(rows.size(), 11u);
    const std::size_t channels[] = {3, 6, 9, 10, 13, 13, 13, 14, 14, 17, 17};
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const Model& m = rows[k].model;
        EXPECT_EQ(m.channels.size(), channels[k]) << rows[k].name;
        EXPECT_EQ(m.demodulation, rows[k].name != "no-demodulation");
        EXPECT_EQ(m.opacity_weight, k == 6 || k >= 8);
        EXPECT_EQ(m.control_variate, rows[k].name == "known-light");
        EXPECT_EQ(std::count(m.channels.begin(), m.channels.end(), "noise"), k >= 7 ? 1 : 0);
        EXPECT_TRUE(m.exposure);
        EXPECT_EQ(rows[k].standard, k < 8);
        if (k == 0 || k > 4) continue;
        const auto& fewer = rows[k - 1].model.channels;
        EXPECT_TRUE(std::equal(fewer.begin(), fewer.end(), m.channels.begin())) << rows[k].name;
    }
    EXPECT_EQ(rows[3].model.channels, reference_channels());
}

TEST(AblationTables, HaveMeansOverTheTests) {
    const auto score = [](const char* test, int spp, double psnr, double ssim) {
        AblationScore s{test, spp, {}};
        s.mean.psnr = psnr, s.mean.ssim = ssim;
        return s;
    };
    const std::string text = markdown_tables(
        {{"noisy input", {score("a", 1, 10, 0.5), score("b", 1, 20, 0.7), score("a", 4, 16, 0.6), score("b", 4, 27, 0.9)}, 0},
         {"colour only", {score("a", 1, 30, 0.8), score("b", 1, 31, 0.9), score("a", 4, 32, 0.9), score("b", 4, 35, 1)}, 1}});
    EXPECT_THAT(text, HasSubstr("| 1 spp: PSNR [dB] |      1 spp: SSIM |      1 spp: FLIP | 4 spp: PSNR [dB] |"));
    EXPECT_THAT(text, testing::ContainsRegex("noisy input +\\| +15.00 \\| +0.6000 \\| +0.0000 \\| +21.50 \\| +0.7500 \\|"));
    EXPECT_THAT(text, testing::ContainsRegex("colour only +\\| +30.50 \\| +0.8500"));
    EXPECT_THAT(text, testing::ContainsRegex("4 spp: PSNR .dB. / SSIM +\\| +a \\| +b \\|"));
    EXPECT_THAT(text, testing::ContainsRegex("colour only +\\| +32.00 / 0.9000 \\| +35.00 / 1.0000 \\|"));
}

} // namespace
} // namespace clvr
