// Model files: as written, by hand, and broken.
#include "host/io/model/model_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace clvr {
namespace {

using ::testing::HasSubstr;

Model small_model() {
    Model m;
    m.channels = {"R", "G", "B", "depth.Z"};
    m.hidden = 3;
    m.kernel = 3;
    m.levels = {{4, 8}, {16, 16}};
    m.exposure = true;
    m.albedo_floor = 1.0f / 32;
    m.notes["clvr.training"] = R"({"epochs": 3})";
    initialise(m, 7);
    return m;
}

std::string length_bytes(std::uint64_t n) {
    std::string bytes;
    for (int k = 0; k < 8; ++k) bytes += static_cast<char>(n >> (8 * k) & 0xff);
    return bytes;
}

std::string file_of(const std::string& header, const std::string& data) { return length_bytes(header.size()) + header + data; }

class ModelFile : public ::testing::Test {
protected:
    TemporaryFolder folder;
    std::string path(const std::string& name = "m.safetensors") const { return (folder.path() / name).string(); }

    void expect_refusal(const std::string& bytes, const std::string& what) {
        folder.write("bad.safetensors", bytes);
        try {
            read_model(path("bad.safetensors"));
            FAIL() << what;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
            EXPECT_THAT(e.line(), HasSubstr(what));
            EXPECT_THAT(e.line(), HasSubstr("bad.safetensors"));
            EXPECT_EQ(e.line().find('\n'), std::string::npos);
        }
    }
};

TEST_F(ModelFile, KeepsEverything) {
    const Model m = small_model();
    write_model(m, path());
    const Model r = read_model(path());
    EXPECT_EQ(r.channels, m.channels);
    EXPECT_EQ(r.hidden, 3);
    EXPECT_EQ(r.kernel, 3);
    ASSERT_EQ(r.levels.size(), 2u);
    EXPECT_EQ(r.levels[0].codes, 8);
    EXPECT_EQ(r.levels[1].pixels, 16);
    EXPECT_TRUE(r.exposure);
    EXPECT_FALSE(r.opacity_weight);
    EXPECT_EQ(r.albedo_floor, m.albedo_floor);
    EXPECT_EQ(r.notes, m.notes);
    EXPECT_EQ(r.flat(), m.flat());
    write_model(r, path("again.safetensors"));
    EXPECT_EQ(read_text(path()), read_text(path("again.safetensors")));
}

TEST_F(ModelFile, DemodulationIsOnUnlessItSaysOtherwise) {
    Model m = small_model();
    write_model(m, path());
    EXPECT_EQ(read_text(path()).find("demodulation"), std::string::npos); // as files of before the switch
    EXPECT_TRUE(read_model(path()).demodulation);
    m.demodulation = false;
    write_model(m, path());
    EXPECT_FALSE(read_model(path()).demodulation);
}

TEST_F(ModelFile, KnownLightHasOneShareUnlessItSaysHowLargeItsCellsAre) {
    Model m = small_model();
    m.control_variate = true;
    m.channels.insert(m.channels.end(), {"known.R", "known.G", "known.B"});
    m.conv1_weight.resize(m.conv1_weight.size() / (m.channels.size() - 3) * m.channels.size());
    write_model(m, path());
    EXPECT_EQ(read_text(path()).find("control_variate_cell"), std::string::npos);
    EXPECT_EQ(read_model(path()).control_variate_cell, 0);
    m.control_variate_cell = 32;
    write_model(m, path());
    EXPECT_EQ(read_model(path()).control_variate_cell, 32);
}

/// What Hugging Face's safetensors library reads into PyTorch: 8 bytes of header length, JSON, raw little-endian values in header order.
TEST_F(ModelFile, IsLaidOutAsTheFormatSays) {
    const Model m = small_model();
    write_model(m, path());
    const std::string bytes = read_text(path());
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data(), 8);
    EXPECT_EQ(length % 8, 0u);
    const std::string header = bytes.substr(8, length);
    EXPECT_THAT(header, HasSubstr(R"("conv1.weight":{"dtype":"F32","shape":[3,4,3,3],"data_offsets":[0,432]})"));
    EXPECT_THAT(header, HasSubstr(R"("conv1.bias":{"dtype":"F32","shape":[3],"data_offsets":[432,444]})"));
    EXPECT_THAT(header, HasSubstr(R"("__metadata__":{)"));
    ASSERT_EQ(bytes.size(), 8 + length + 4 * m.parameters());
    std::vector<float> values(m.parameters());
    std::memcpy(values.data(), bytes.data() + 8 + length, 4 * values.size());
    EXPECT_EQ(values, m.flat());
}

TEST_F(ModelFile, ReadsTensorsAlone) {
    std::string data;
    for (int i = 0; i < 20 * 10 * 25 + 20 + 5 * 20 * 25 + 5; ++i) {
        const float v = 0.25f * static_cast<float>(i % 7);
        data.append(reinterpret_cast<const char*>(&v), 4);
    }
    const std::string header =
        R"({"conv2.bias":{"dtype":"F32","shape":[5],"data_offsets":[30080,30100]},"conv1.weight":{"dtype":"F32","shape":[20,10,5,5],)"
        R"("data_offsets":[0,20000]},"conv1.bias":{"dtype":"F32","shape":[20],"data_offsets":[20000,20080]},)"
        R"("conv2.weight":{"dtype":"F32","shape":[5,20,5,5],"data_offsets":[20080,30080]}}   )";
    folder.write("m.safetensors", file_of(header, data));
    const Model m = read_model(path());
    EXPECT_EQ(m.channels, reference_channels());
    EXPECT_EQ(m.levels.size(), 3u);
    EXPECT_FALSE(m.exposure);
    EXPECT_EQ(m.albedo_floor, 0x1p-20f);
    EXPECT_EQ(m.conv1_weight[8], 0.25f);
    EXPECT_EQ(m.conv2_bias[4], 0.25f * ((20 * 10 * 25 + 20 + 5 * 20 * 25 + 4) % 7));
}

TEST_F(ModelFile, RefusesWhatIsBroken) {
    expect_refusal("", "0 bytes");
    expect_refusal("abc", "3 bytes");
    expect_refusal(length_bytes(1000) + "{}", "1000 bytes");
    expect_refusal(length_bytes(~0ull) + "{}", "header");
    expect_refusal(file_of("{", ""), "JSON");
    expect_refusal(file_of(std::string(5000, '['), ""), "nested");
    expect_refusal(file_of("[]", ""), "object");
    expect_refusal(file_of("{}", ""), "conv1.weight");
    const auto tensor = [](const std::string& type, const std::string& shape, const std::string& offsets) {
        return R"({"conv1.weight":{"dtype":")" + type + R"(","shape":)" + shape + R"(,"data_offsets":)" + offsets + "}}";
    };
    const std::string data(16, '\0');
    expect_refusal(file_of(tensor("F16", "[4]", "[0,16]"), data), "F16");
    expect_refusal(file_of(tensor("F32", "[4]", "[0,12]"), data), "expected 16 bytes");
    expect_refusal(file_of(tensor("F32", "[4]", "[4,20]"), data), "bytes");
    expect_refusal(file_of(tensor("F32", "[3]", "[0,12]"), data), "accounts for 12");
    expect_refusal(file_of(tensor("F32", "[-4]", "[0,16]"), data), "negative");
    expect_refusal(file_of(tensor("F32", "[4611686018427387904,4]", "[0,16]"), data), "larger than the file");
    expect_refusal(file_of(tensor("F32", "[4]", "[0,99999999999]"), data), "bytes");
    expect_refusal(file_of(tensor("F32", "[4]", "[0,16]"), data), "dimensions");
    expect_refusal(
        file_of(R"({"a":{"dtype":"F32","shape":[4],"data_offsets":[0,16]},"b":{"dtype":"F32","shape":[4],"data_offsets":[0,16]}})", data),
        "bytes");
    expect_refusal(
        file_of(R"({"a":{"dtype":"U8","shape":[0],"data_offsets":[0,0]},"a":{"dtype":"U8","shape":[0],"data_offsets":[0,0]}})", ""),
        "twice");
    expect_refusal(file_of(R"({"__metadata__":{"x":1}})", ""), "no string");
}

TEST_F(ModelFile, RefusesACutOffFileAtEveryLength) {
    write_model(small_model(), path());
    const std::string whole = read_text(path());
    for (std::size_t n = 0; n < whole.size(); n += n < 900 ? 7 : 101) {
        folder.write("cut.safetensors", whole.substr(0, n));
        EXPECT_THROW(read_model(path("cut.safetensors")), Error) << n;
    }
}

TEST_F(ModelFile, RefusesModelsThatCannotBe) {
    const auto expect = [&](const std::function<void(Model&)>& change, const std::string& what) {
        Model m = small_model();
        change(m);
        write_model(m, path());
        try {
            read_model(path());
            FAIL() << what;
        } catch (const Error& e) {
            EXPECT_THAT(e.line(), HasSubstr(what));
        }
    };
    expect([](Model& m) { m.conv1_weight[5] = std::numeric_limits<float>::quiet_NaN(); }, "not finite");
    expect([](Model& m) { m.conv2_bias[0] = std::numeric_limits<float>::infinity(); }, "not finite");
    expect([](Model& m) { m.channels[3] = "colour"; }, "unknown");
    expect([](Model& m) { m.channels[3] = "R"; }, "twice");
    expect([](Model& m) { m.levels.push_back({8, 8}); }, "conv2.weight");
    expect([](Model& m) { m.levels[0].codes = 2; }, "levels");
    expect([](Model& m) { m.albedo_floor = 0; }, "albedo floor");
    expect([](Model& m) { m.control_variate_cell = 7; }, "pixels per cell");
    expect([](Model& m) { m.control_variate_cell = -1; }, "pixels per cell");
}

} // namespace
} // namespace clvr
