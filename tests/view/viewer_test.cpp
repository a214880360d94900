// Clients of a viewer: what they are told, who controls, whose scene is seen.
#include "tests/view/viewing.hpp"

#include <gmock/gmock.h>

#include <numeric>

namespace clvr::view {
namespace {

using testing::HasSubstr;
using testing::Not;

class ViewerTest : public Viewing {};

TEST_F(ViewerTest, SaysWhatThereIs) {
    start();
    json hello;
    Page page = join("control", &hello);
    EXPECT_EQ(hello["protocol"], 1);
    EXPECT_EQ(hello["version"], "1.2.3");
    EXPECT_EQ(hello["role"], "control");
    EXPECT_EQ(hello["device"], "a fake");
    EXPECT_EQ(hello["generation"], 1);
    EXPECT_EQ(hello["scene"]["width"], 32);
    EXPECT_EQ(hello["volume"]["name"], "ball.nii.gz");
    EXPECT_EQ(hello["volume"]["size"], json({8, 8, 8}));
    EXPECT_EQ(hello["volume"]["type"], "uint8");
    EXPECT_EQ(hello["volume"]["unit"], "HU");
    EXPECT_EQ(hello["volume"]["anatomical"], true);
    EXPECT_EQ(hello["volume"]["range"], json({0.0, 200.0}));
    EXPECT_EQ(hello["volume"]["index_to_world"], json({1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0}));
    const json& counts = hello["volume"]["histogram"]["counts"];
    EXPECT_EQ(counts.size(), 512u);
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0, [](int sum, const json& c) { return sum + c.get<int>(); }), 512);
    EXPECT_FALSE(hello["automatic"]["points"].empty());
    EXPECT_GT(hello["presets"].size(), 3u);
    EXPECT_FALSE(hello["presets"][0]["transfer"]["points"].empty());
    EXPECT_EQ(hello["limits"]["side"], 4096);
    EXPECT_TRUE(std::any_of(hello["settings"].begin(), hello["settings"].end(),
                            [](const json& s) { return s["key"] == "camera.fov" && s["high"] == 180; }));
    EXPECT_EQ(hello["jobs"], json::array());
    EXPECT_GT(hello["view"]["height"], 0);
}

TEST_F(ViewerTest, SendsNoPathsAndNoTextsOfTheFile) {
    start();
    json hello;
    join("control", &hello);
    EXPECT_THAT(hello.dump(), Not(HasSubstr("somebody")));
    for (const char* member : {"volume", "volume_sha256", "series", "raw"}) EXPECT_FALSE(hello["scene"].contains(member)) << member;
}

TEST_F(ViewerTest, DrawsForWhoeverLooksUntilItIsSettled) {
    start();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(painter.draws, 0); // nobody looks
    Page page = join();
    EXPECT_FALSE(picture(page, 2).empty());
    const int drawn = painter.draws;
    Page second = join("watch");
    EXPECT_FALSE(picture(second, 2).empty()); // the one that is there
    EXPECT_EQ(painter.draws, drawn);
}

TEST_F(ViewerTest, HiddenPagesStopTheDrawing) {
    start();
    json hello;
    Page page = join("control", &hello);
    picture(page, 2);
    page.say(json{{"type", "pause"}, {"paused", true}});
    page.say(change(2, scene_of(hello)));
    page.say(json{{"type", "transfer_text"}, {"id", 1}, {"text", "?"}});
    page.next_of("refused"); // all before was taken
    const int drawn = painter.draws;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(painter.draws, drawn);
    page.say(json{{"type", "pause"}, {"paused", false}});
    EXPECT_FALSE(picture(page, 2).empty());
}

TEST_F(ViewerTest, ShowsTheSceneOfWhoControls) {
    start();
    json hello, other;
    Page page = join("control", &hello), watcher = join("control", &other);
    EXPECT_EQ(other["role"], "watch"); // the first who asks has it
    json scene = scene_of(hello);
    scene["width"] = 48;
    page.say(change(5, scene));
    const json news = watcher.next_of("scene");
    EXPECT_EQ(news["generation"], 5);
    EXPECT_EQ(news["scene"]["width"], 48);
    EXPECT_EQ(news["view"]["eye"], hello["view"]["eye"]);
    std::string bytes;
    do bytes = picture(page, 2);
    while (!bytes.empty() && bytes[8] != 5);
    EXPECT_EQ(bytes.substr(24, 2), std::string("\x30\0", 2));
}

TEST_F(ViewerTest, WatchersChangeNothing) {
    start();
    json hello;
    Page page = join("control", &hello), watcher = join("watch");
    watcher.say(change(9, scene_of(hello)));
    EXPECT_THAT(watcher.next_of("refused")["message"], HasSubstr("Somebody else controls"));
    for (const char* text : {R"({"type":"save","id":1,"what":"still"})", R"({"type":"pick","id":1,"x":0.5,"y":0.5})",
                             R"({"type":"scene_text","id":1,"text":"{}"})"}) {
        watcher.say(std::string(text));
        EXPECT_THAT(watcher.next_of("refused")["message"], HasSubstr("Somebody else controls")) << text;
    }
    for (const char* text : {R"({"type":"time_step","step":0})", R"({"type":"cancel","job":"1"})"}) {
        watcher.say(std::string(text));
        EXPECT_THAT(watcher.next_of("notice")["message"], HasSubstr("Somebody else controls")) << text;
    }
    EXPECT_EQ(painter.stills, 0);
    json again;
    join("watch", &again);
    EXPECT_EQ(again["generation"], 1);
}

TEST_F(ViewerTest, ControlCanBeTaken) {
    start();
    json hello;
    Page first = join("control", &hello), second = join("control");
    second.say(json{{"type", "take_control"}});
    EXPECT_EQ(first.next_of("role")["role"], "watch");
    EXPECT_EQ(second.next_of("role")["role"], "control");
    first.say(change(2, scene_of(hello)));
    EXPECT_EQ(first.next_of("refused")["generation"], 2);
    second.say(change(2, scene_of(hello)));
    EXPECT_EQ(first.next_of("scene")["generation"], 2);
    second.close();
    json later;
    ASSERT_TRUE(eventually([&] {
        join("control", &later);
        return later["role"] == "control";
    })); // it was free again
}

TEST_F(ViewerTest, ScenesThatCannotBeAreRefusedAndNothingChanges) {
    start();
    json hello;
    Page page = join("control", &hello);
    const json good = scene_of(hello);
    const auto refused = [&](const std::function<void(json&)>& spoil) {
        json scene = good;
        spoil(scene);
        page.say(change(2, scene));
        const json answer = page.next_of("refused");
        EXPECT_EQ(answer["generation"], 2);
        return answer["message"].get<std::string>();
    };
    EXPECT_THAT(refused([](json& s) { s["camera"]["fov"] = 200; }), HasSubstr("--fov"));
    EXPECT_THAT(refused([](json& s) { s["width"] = 4097; }), HasSubstr("at most 4096"));
    EXPECT_THAT(refused([](json& s) { s["spp"] = 65537; }), HasSubstr("at most 65536"));
    EXPECT_THAT(refused([](json& s) { s["more"] = 1; }), HasSubstr("unknown member"));
    EXPECT_THAT(refused([](json& s) { s["volume"] = "/etc/passwd"; }), HasSubstr("the server's"));
    EXPECT_THAT(refused([](json& s) { s["raw"] = json::object(); }), HasSubstr("the server's"));
    EXPECT_THAT(refused([](json& s) { s["light"]["environment"] = "image", s["light"]["image"] = "/etc/passwd"; }),
                HasSubstr("no image that was uploaded"));
    EXPECT_THAT(refused([](json& s) { s["light"]["environment"] = "image"; }), HasSubstr("light.image"));
    EXPECT_THAT(refused([](json& s) { s["camera"]["eye"] = nullptr; }), HasSubstr("camera.eye"));
    EXPECT_THAT(refused([](json& s) { s["seed"] = FakePainter::bad_seed; }), HasSubstr("device 0: is too small")); // by the painter
    page.say(change(1 << 30, good));
    page.say(change(7, good));
    EXPECT_THAT(page.next_of("refused")["message"], HasSubstr("older"));
    json again;
    join("watch", &again);
    EXPECT_EQ(again["generation"], 1 << 30);
    EXPECT_EQ(again["scene"]["camera"]["fov"], good["camera"]["fov"]);
}

TEST_F(ViewerTest, AsksThePainterWhatIsSeen) {
    start();
    Page page = join();
    page.say(json{{"type", "pick"}, {"id", 4}, {"x", 0.5}, {"y", 0.25}});
    json answer = page.next_of("picked");
    EXPECT_EQ(answer["id"], 4);
    EXPECT_EQ(answer["position"], json({0.5, 0.25, 7.0}));
    page.say(json{{"type", "pick"}, {"id", 5}, {"x", 0}, {"y", 0}});
    EXPECT_TRUE(page.next_of("picked")["position"].is_null());
}

TEST_F(ViewerTest, ReadsTransferFunctionsOfBothForms) {
    start();
    Page page = join();
    const auto read = [&](const std::string& text) { page.say(json{{"type", "transfer_text"}, {"id", 1}, {"text", text}}); };
    read(R"({"points":[{"value":1,"color":[1,1,1],"opacity":0.5}]})");
    EXPECT_EQ(page.next_of("transfer")["transfer"]["points"][0]["opacity"], 0.5);
    read(R"([{"ColorSpace":"RGB","Name":"map","RGBPoints":[0,0,0,0,10,1,1,1],"Points":[0,0,0.5,0,10,1,0.5,0]}])");
    EXPECT_GT(page.next_of("transfer")["transfer"]["points"].size(), 1u);
    read(R"({"points":[]})");
    EXPECT_THAT(page.next_of("refused")["message"], HasSubstr("empty"));
}

TEST_F(ViewerTest, ReadsSceneFiles) {
    start();
    json hello;
    Page page = join("control", &hello), watcher = join("watch");
    Scene saved;
    saved.volume = "/etc/passwd", saved.spp = 7, saved.width = 8192, saved.height = 4096;
    saved.reading.frame = 3;
    page.say(json{{"type", "scene_text"}, {"id", 3}, {"text", to_json(saved)}});
    const json notice = page.next_of("notice");
    EXPECT_THAT(notice["message"], HasSubstr("4096"));
    const json news = page.next_of("scene");
    EXPECT_EQ(news["id"], 3);
    EXPECT_EQ(news["generation"], 2);
    EXPECT_EQ(news["scene"]["spp"], 7);
    EXPECT_EQ(news["scene"]["height"], 2048);
    EXPECT_GT(news["view"]["height"], 0); // the camera was framed
    EXPECT_EQ(watcher.next_of("scene")["scene"]["spp"], 7);
    saved.light.environment = Light::Environment::image, saved.light.image = "/etc/hosts.hdr";
    page.say(json{{"type", "scene_text"}, {"id", 4}, {"text", to_json(saved)}});
    EXPECT_THAT(page.next_of("refused")["message"], HasSubstr("hosts.hdr"));
}

TEST_F(ViewerTest, FindsTheCameraOfASceneWithoutOne) {
    start();
    json hello;
    Page page = join("control", &hello), watcher = join("watch");
    json scene = hello["scene"];
    scene["camera"]["azimuth"] = 90;
    page.say(change(2, scene));
    const json news = watcher.next_of("scene");
    EXPECT_EQ(news["generation"], 2);
    EXPECT_GT(news["view"]["eye"][0], 20); // from the left side
}

TEST_F(ViewerTest, ShowsOtherTimeSteps) {
    settings.time_steps = 3;
    std::atomic<int> shown{0};
    settings.read_step = [](int step) {
        if (step == 2) throw Error(ErrorKind::input, "is damaged", "ball.nii.gz");
        return ball();
    };
    settings.show_volume = [&](Painter&, const VolumePointer&) { ++shown; };
    start();
    Page page = join();
    page.say(json{{"type", "time_step"}, {"step", 1}});
    EXPECT_EQ(page.next_of("volume")["volume"]["time_step"], 1);
    EXPECT_EQ(page.next_of("scene")["generation"], 2);
    EXPECT_EQ(shown, 1);
    page.say(json{{"type", "time_step"}, {"step", 2}});
    EXPECT_THAT(page.next_of("notice")["message"], HasSubstr("is damaged"));
    page.say(json{{"type", "time_step"}, {"step", 3}});
    EXPECT_THAT(page.next_of("notice")["message"], HasSubstr("the file has 3"));
}

TEST_F(ViewerTest, TakesImagesForTheLight) {
    const int port = start();
    json hello;
    const std::string image = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + std::string("\x80\x80\x80\x81\x40\x40\x40\x81");
    const auto upload = [&](const std::string& bytes) {
        return request(port, request_text("POST", "/environment?name=..%2Fmy%20sky.hdr",
                                          authorization + "Content-Length: " + std::to_string(bytes.size()) + "\r\n") +
                                 bytes);
    };
    EXPECT_EQ(upload(image).status, 409); // nobody controls
    Page page = join("control", &hello);
    const Reply bad = upload("no image");
    EXPECT_EQ(bad.status, 415);
    EXPECT_THAT(bad.body, HasSubstr("my sky.hdr"));
    EXPECT_THAT(bad.body, Not(HasSubstr("/")));
    const json answer = json::parse(upload(image).body, nullptr, false);
    EXPECT_EQ(answer, json({{"environment", "upload-1"}, {"name", "my sky.hdr"}}));
    json scene = scene_of(hello);
    scene["light"]["environment"] = "image", scene["light"]["image"] = "upload-1";
    page.say(change(2, scene));
    json again;
    ASSERT_TRUE(eventually([&] {
        join("watch", &again);
        return again["generation"] == 2;
    }));
    EXPECT_EQ(again["scene"]["light"]["image"], "upload-1");
}

TEST_F(ViewerTest, KeepsFewImagesButThatInUse) {
    const int port = start();
    json hello;
    const std::string image = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + std::string("\x80\x80\x80\x81");
    const std::string text =
        request_text("POST", "/environment?name=a.hdr", authorization + "Content-Length: " + std::to_string(image.size()) + "\r\n") + image;
    Page page = join("control", &hello), watcher = join("watch");
    EXPECT_EQ(request(port, text).status, 200);
    json scene = scene_of(hello);
    scene["light"]["environment"] = "image", scene["light"]["image"] = "upload-1";
    page.say(change(2, scene));
    watcher.next_of("scene");
    for (int i = 0; i < 6; ++i) EXPECT_EQ(request(port, text).status, 200);
    for (const auto& [handle, there] : {std::pair("upload-1", true), std::pair("upload-2", false), std::pair("upload-7", true)}) {
        scene["light"]["image"] = handle;
        page.say(change(3, scene));
        if (there) {
            EXPECT_EQ(watcher.next_of("scene")["scene"]["light"]["image"], handle);
        } else {
            EXPECT_THAT(page.next_of("refused")["message"], HasSubstr("no image"));
        }
    }
}

TEST_F(ViewerTest, IsIdleWithoutClients) {
    start();
    EXPECT_TRUE(eventually([&] { return viewer->idle_seconds() > 0.02; }));
    Page page = join();
    EXPECT_EQ(viewer->idle_seconds(), 0);
    page.close();
    EXPECT_TRUE(eventually([&] { return viewer->idle_seconds() > 0; }));
}

} // namespace
} // namespace clvr::view
