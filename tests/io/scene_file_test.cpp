// Scene files: every field there and back, and what is refused.
#include "host/io/scene/scene_file.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <limits>

namespace clvr {
namespace {

using nlohmann::json;
using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

/// A valid scene with no field at its default and awkward numbers.
Scene unusual() {
    Scene s;
    s.volume = "data/a \"b\" \xc3\xbc.nii.gz";
    s.volume_sha256 = std::string(64, 'a');
    s.reading.frame = 3;
    s.reading.channel = 0;
    s.reading.array = "density \"2\"";
    s.reading.recursive = true;
    s.reading.series = "1.2.840.113619.2";
    s.reading.allow_gaps = true;
    s.reading.dims = Int3{7, 8, 9};
    s.reading.type = "uint16";
    s.reading.spacing = Double3{0.1, 1.0 / 3, 2};
    s.reading.endian = "big";
    TransferFunction tf;
    tf.name = "mine";
    tf.normalized = true;
    tf.points = {{0.1, {0.1, 0.2, 0.3}, 0}, {std::nextafter(0.7, 1.0), {1, 1.0 / 3, 0x1p-1060}, 0.9}};
    s.transfer = tf;
    s.mode = Mode::dvr;
    s.shading = Shading::gradient;
    s.phase_g = -0.3;
    s.extinction = 1e-7;
    s.bounces = 0;
    s.width = 641;
    s.height = 479;
    s.spp = 65;
    s.feature_samples = 1;
    s.features = false;
    s.seed = std::numeric_limits<std::uint64_t>::max();
    s.view = 5;
    s.camera.orthographic = true;
    s.camera.fov = 0.1 + 0.2;
    s.camera.azimuth = -1234.5678901234567;
    s.camera.elevation = -90;
    s.camera.zoom = 1e-3;
    s.camera.eye = Double3{1, 2, -0.0};
    s.camera.target = Double3{1e30, 5, 6};
    s.camera.up = {0, 0.6, 0.8};
    s.camera.height = 123;
    s.light.environment = Light::Environment::image;
    s.light.level = 0.7;
    s.light.image = "sky.hdr";
    s.light.image_rotation = 33;
    s.light.key = 0;
    s.light.key_azimuth = 12;
    s.light.key_elevation = -13;
    s.light.key_angle = 0;
    s.light.headlight = 0.5;
    s.background.kind = Background::Kind::color;
    s.background.color = {0.1, 0.2, 4};
    s.clip_box = std::array<double, 6>{0, 0.1, 0.2, 1, 0.9, 0.8};
    s.clip_plane = ClipPlane{{1, -1, 0.5}, -17};
    s.exposure = -1.5;
    s.tonemap = "aces";
    return s;
}

TEST(SceneFileTest, EveryFieldComesBack) {
    const Scene made = unusual();
    const Scene back = parse_scene(to_json(made), "scene.json");
    EXPECT_EQ(to_json(back), to_json(made)); // the digits are unique to the bits
    EXPECT_EQ(back.seed, made.seed);
    EXPECT_EQ(back.camera.azimuth, made.camera.azimuth);
    EXPECT_EQ(back.transfer->points[1].value, made.transfer->points[1].value);
    EXPECT_EQ(back.transfer->points[1].color, made.transfer->points[1].color);
    EXPECT_TRUE(std::signbit((*back.camera.eye)[2]));
    // No field of the unusual scene is written as the default one, so none can have been left out or mixed up.
    Scene usual;
    usual.volume = "v";
    const json a = json::parse(to_json(made)), b = json::parse(to_json(usual));
    for (const auto& member : a.items()) {
        if (member.key() == "clvr.format") continue;
        if (!b.contains(member.key())) continue; // an optional one
        EXPECT_NE(member.value(), b[member.key()]) << member.key();
        if (member.value().is_object())
            for (const auto& inner : member.value().items())
                if (b[member.key()].contains(inner.key())) {
                    EXPECT_NE(inner.value(), b[member.key()][inner.key()]) << member.key() << "." << inner.key();
                }
    }
}

TEST(SceneFileTest, AbsentFieldsKeepTheirDefaults) {
    Scene usual;
    usual.volume = "demo:head";
    EXPECT_EQ(to_json(parse_scene(R"({"clvr.format": "scene/1", "volume": "demo:head"})", "s.json")), to_json(usual));
    EXPECT_EQ(to_json(parse_scene(to_json(usual), "folder/s.json")), to_json(usual)) << "a built-in volume has no folder";
}

TEST(SceneFileTest, PathsAreRelativeToTheFile) {
    const Folder folder;
    std::filesystem::create_directories(folder / "scenes/deep");
    std::filesystem::create_directories(folder / "data");
    Scene s = unusual();
    s.volume = folder / "data/v.nii";
    s.light.image = folder / "scenes/sky.hdr";
    write_scene(s, folder / "scenes/deep/s.json");
    const json written = json::parse(read_text(folder / "scenes/deep/s.json"));
    EXPECT_EQ(written["volume"], "../../data/v.nii");
    EXPECT_EQ(written["light"]["image"], "../sky.hdr");
    const Scene back = read_scene(folder / "scenes/deep/s.json");
    EXPECT_EQ(back.volume, s.volume);
    EXPECT_EQ(back.light.image, s.light.image);
    EXPECT_EQ(parse_scene(R"({"clvr.format": "scene/1", "volume": "/abs/v.nii"})", "a/s.json").volume, "/abs/v.nii");
    EXPECT_EQ(parse_scene(R"({"clvr.format": "scene/1", "volume": "v.nii"})", "s.json").volume, "v.nii");
}

TEST(SceneFileTest, ProvenanceNamesNoFolder) {
    Scene s = unusual();
    s.volume = "/home/somebody/series/";
    s.light.image = "../sky.hdr";
    const json named = json::parse(provenance_json(s));
    EXPECT_EQ(named["volume"], "series");
    EXPECT_EQ(named["light"]["image"], "sky.hdr");
}

std::string refusal(const std::string& text) {
    const Error e = error_of([&] { parse_scene(text, "scene.json"); });
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_EQ(e.where(), "scene.json");
    return e.line();
}

/// The refusal of a good scene with one member replaced; `pointer` as "/camera/fov".
std::string with(const std::string& pointer, const json& value) {
    json scene = json::parse(to_json(unusual()));
    scene[json::json_pointer(pointer)] = value;
    return refusal(scene.dump());
}

TEST(SceneFileTest, RefusesWhatItDoesNotUnderstand) {
    EXPECT_THAT(refusal(""), HasSubstr("no valid JSON"));
    EXPECT_THAT(refusal("[]"), HasSubstr("expected an object"));
    EXPECT_THAT(refusal("{}"), HasSubstr("clvr.format is missing"));
    EXPECT_THAT(refusal(R"({"clvr.format": "scene/2", "volume": "v"})"), HasSubstr("expected scene/1"));
    EXPECT_THAT(refusal(R"({"clvr.format": "scene/1"})"), HasSubstr("volume is missing"));
    EXPECT_THAT(refusal(R"({"clvr.format": "scene/1", "volume": "v", "volume": "w"})"), HasSubstr("\"volume\" twice"));
    EXPECT_THAT(refusal("{\"a\":" + std::string(100000, '[')), HasSubstr("nested deeper"));
    EXPECT_THAT(with("/samples", 3), HasSubstr("unknown member \"samples\""));
    EXPECT_THAT(with("/camera/fow", 3), HasSubstr("unknown member \"camera.fow\""));
    EXPECT_THAT(with("/light/kee", 3), HasSubstr("unknown member \"light.kee\""));
    EXPECT_THAT(with("/background/x", 3), HasSubstr("background.x"));
    EXPECT_THAT(with("/clip_plane/x", 3), HasSubstr("clip_plane.x"));
    EXPECT_THAT(with("/raw/x", 3), HasSubstr("raw.x"));
    EXPECT_THAT(with("/transfer/x", 3), HasSubstr("unknown member \"x\""));
}

TEST(SceneFileTest, RefusesWrongTypes) {
    EXPECT_THAT(with("/volume", 3), HasSubstr("volume is 3; expected a text"));
    EXPECT_THAT(with("/spp", 1.5), HasSubstr("spp is 1.5; expected whole numbers"));
    EXPECT_THAT(with("/spp", "64"), HasSubstr("spp is \"64\"; expected a whole number"));
    EXPECT_THAT(with("/spp", 1e10), HasSubstr("spp is 1"));
    EXPECT_THAT(with("/seed", -1), HasSubstr("seed is -1"));
    EXPECT_THAT(with("/seed", 0.5), HasSubstr("seed is 0.5"));
    EXPECT_THAT(with("/features", 1), HasSubstr("features is 1; expected true or false"));
    EXPECT_THAT(with("/mode", "fast"), HasSubstr("mode is \"fast\"; expected one of path, dvr, mip"));
    EXPECT_THAT(with("/camera", 3), HasSubstr("camera is 3; expected an object"));
    EXPECT_THAT(with("/camera/fov", "NaN"), HasSubstr("camera.fov is \"NaN\"; expected a number"));
    EXPECT_THAT(with("/camera/fov", nullptr), HasSubstr("camera.fov is null"));
    EXPECT_THAT(with("/camera/eye", json::array({1, 2})), HasSubstr("camera.eye is a list; expected a list of 3 numbers"));
    EXPECT_THAT(with("/clip_box", json::array({0, 0, 0, 1, 1, "1"})), HasSubstr("clip_box"));
    EXPECT_THAT(with("/raw/dims", json::array({1, 2, 2.5})), HasSubstr("raw.dims"));
    EXPECT_THAT(with("/transfer/points/0/opacity", 2), HasSubstr("opacity 2 is outside 0..1"));
}

TEST(SceneFileTest, RefusesValuesOutOfRange) {
    EXPECT_THAT(with("/spp", 0), HasSubstr("--spp: is 0; expected 1 to 1048576"));
    EXPECT_THAT(with("/width", 20000), HasSubstr("--size (width): is 20000"));
    EXPECT_THAT(with("/tonemap", "sepia"), HasSubstr("one of filmic, aces, reinhard, none"));
}

TEST(SceneFileTest, KnowsASceneFile) {
    const Folder folder;
    Scene s;
    s.volume = "demo:head";
    write_scene(s, folder / "scene");
    EXPECT_TRUE(is_scene_file(folder / "scene"));
    test::put(folder / "sidecar.json", "{\"dims\": [1, 2, 3]}");
    test::put(folder / "empty.json", "");
    test::put(folder / "volume.nii", std::string(1000, '\0'));
    for (const char* name : {"sidecar.json", "empty.json", "volume.nii", "absent", "."}) EXPECT_FALSE(is_scene_file(folder / name)) << name;
}

TEST(SceneFileTest, FilesThatCannotBeRead) {
    const Folder folder;
    EXPECT_THAT(error_of([&] { read_scene(folder / "absent.json"); }).line(), HasSubstr("No such file"));
    test::put(folder / "big.json", std::string((16 << 20) + 1, ' '));
    EXPECT_THAT(error_of([&] { read_scene(folder / "big.json"); }).line(), HasSubstr("larger than"));
    EXPECT_THAT(error_of([&] { write_scene(unusual(), folder / "absent/s.json"); }).line(), HasSubstr("no folder"));
}

} // namespace
} // namespace clvr
