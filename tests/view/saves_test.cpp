// What is saved of a view.
#include "host/appearance/transfer_function.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/view/viewing.hpp"

#include <gmock/gmock.h>
#include <minizip/unzip.h>

#include <sys/stat.h>

namespace clvr::view {
namespace {

using testing::HasSubstr;
using testing::Not;

class Saves : public Viewing {
protected:
    static json save(const std::string& what, const json& more = json::object()) {
        json message{{"type", "save"}, {"id", 8}, {"what", what}};
        message.update(more);
        return message;
    }
    std::string kept(const std::string& name) const { return test::bytes_of(folder / name); }
};

TEST_F(Saves, AStillOfAnySize) {
    start();
    Page page = join();
    page.say(save("still", {{"width", 50}, {"height", 40}, {"samples", 9}}));
    const json begun = page.next_of("job");
    EXPECT_EQ(begun["id"], 8);
    EXPECT_EQ(begun["state"], "waiting");
    EXPECT_EQ(begun["name"], "ball.png");
    const json job = finished(page);
    EXPECT_EQ(job["state"], "done");
    EXPECT_EQ(job["progress"], 1);
    EXPECT_EQ(job["url"], "saved/1/ball.png");
    const std::vector<unsigned char> png = encode_png(FakePainter::pixels(50, 40));
    EXPECT_EQ(download(job).body, std::string(png.begin(), png.end()));
    EXPECT_EQ(painter.drawn().at(0).spp, 9);
    EXPECT_EQ(request(server->port(), request_text("GET", "/saved/1/ball.png")).status, 401);
    EXPECT_EQ(request(server->port(), request_text("GET", "/saved/1/other.png", authorization)).status, 404);
}

TEST_F(Saves, JpegAndOpenExr) {
    settings.provenance = [](Frame& frame, const Scene& scene) { frame.attributes["clvr.scene"] = provenance_json(scene); };
    start();
    Page page = join();
    page.say(save("still", {{"format", "jpg"}}));
    EXPECT_EQ(download(finished(page)).body.substr(0, 3), "\xff\xd8\xff");
    page.say(save("still", {{"format", "exr"}}));
    test::put(folder / "a.exr", download(finished(page)).body);
    const Frame frame = read_exr(folder / "a.exr");
    EXPECT_EQ(frame.width, 32);
    EXPECT_THAT(frame.attributes.at("clvr.scene"), Not(HasSubstr("somebody")));
}

TEST_F(Saves, ATurntableOnALevelPath) {
    start();
    Page page = join();
    page.say(save("turntable", {{"views", 4}}));
    const json job = finished(page);
    EXPECT_EQ(job["name"], "ball_turntable.zip");
    test::put(folder / "a.zip", download(job).body);
    unzFile zip = unzOpen((folder / "a.zip").c_str());
    ASSERT_TRUE(zip);
    std::vector<std::string> names;
    for (int found = unzGoToFirstFile(zip); found == UNZ_OK; found = unzGoToNextFile(zip)) {
        char name[100];
        unz_file_info info;
        unzGetCurrentFileInfo(zip, &info, name, sizeof name, nullptr, 0, nullptr, 0);
        EXPECT_EQ(info.compression_method, 0u);
        names.push_back(name);
    }
    unzClose(zip);
    EXPECT_THAT(names, testing::ElementsAre("view_000.png", "view_001.png", "view_002.png", "view_003.png"));
    const std::vector<Scene> scenes = painter.drawn();
    ASSERT_EQ(scenes.size(), 4u);
    const Double3 eye = *scenes[0].camera.eye, target = *scenes[0].camera.target, quarter = *scenes[1].camera.eye;
    EXPECT_NEAR(quarter[2], eye[2], 1e-9);
    EXPECT_NEAR(quarter[0] - target[0], -(eye[1] - target[1]), 1e-9); // as azimuths grow
    EXPECT_NEAR(quarter[1] - target[1], eye[0] - target[0], 1e-9);
    EXPECT_EQ(scenes[3].view, 3);
}

TEST_F(Saves, TheSceneWithoutFolders) {
    start();
    Page page = join();
    page.say(save("scene", {{"width", 77}}));
    const json job = finished(page);
    EXPECT_EQ(job["name"], "ball_scene.json");
    const std::string text = download(job).body;
    EXPECT_THAT(text, Not(HasSubstr("somebody")));
    const Scene scene = parse_scene(text, "a");
    EXPECT_EQ(scene.volume, "ball.nii.gz");
    EXPECT_EQ(scene.width, 77);
    EXPECT_TRUE(scene.transfer); // resolved
    EXPECT_GT(scene.extinction, 0);
    EXPECT_EQ(scene.volume_sha256.size(), 64u);
}

TEST_F(Saves, TheTransferFunction) {
    start();
    Page page = join();
    page.say(save("transfer"));
    const json job = finished(page);
    EXPECT_EQ(job["name"], "ball_transfer.json");
    EXPECT_FALSE(parse_transfer_function(download(job).body, "a").points.empty());
}

TEST_F(Saves, GoToTheOutputFolderToo) {
    settings.output_dir = folder.path();
    settings.scene.volume = folder / "data/ball.nii.gz";
    start();
    Page page = join();
    for (int i = 0; i < 2; ++i) {
        page.say(save("still"));
        EXPECT_EQ(finished(page)["state"], "done");
    }
    EXPECT_EQ(kept("ball.png"), kept("ball-2.png"));
    page.say(save("scene"));
    EXPECT_EQ(finished(page)["state"], "done");
    EXPECT_THAT(kept("ball_scene.json"), HasSubstr("\"data/ball.nii.gz\"")); // which can be rendered as it lies there
    EXPECT_EQ(folder.entries(), 3u);
}

TEST_F(Saves, OneAtATime) {
    painter.hold = true;
    start();
    Page page = join();
    page.say(save("still"));
    page.next_of("job");
    page.say(save("scene"));
    EXPECT_THAT(page.next_of("refused")["message"], HasSubstr("not finished"));
    painter.hold = false;
    EXPECT_EQ(finished(page)["state"], "done");
    page.say(save("scene"));
    EXPECT_EQ(finished(page)["state"], "done");
}

TEST_F(Saves, CanBeCancelled) {
    painter.hold = true;
    start();
    Page page = join();
    page.say(save("turntable"));
    const json begun = page.next_of("job");
    EXPECT_TRUE(eventually([&] { return painter.stills == 1; }));
    page.say(json{{"type", "cancel"}, {"job", "77"}});
    page.say(json{{"type", "cancel"}, {"job", begun["job"]}});
    EXPECT_EQ(finished(page)["state"], "cancelled");
    EXPECT_TRUE(std::filesystem::is_empty(viewer->folder())); // nothing is left of it
    painter.hold = false;
    page.say(save("still"));
    EXPECT_EQ(finished(page)["state"], "done");
}

TEST_F(Saves, ThatFailSaySo) {
    settings.scene.seed = FakePainter::bad_seed;
    settings.output_dir = folder / "gone"; // since the start
    start();
    Page page = join();
    page.say(save("still"));
    EXPECT_THAT(finished(page)["message"], HasSubstr("device 0: broke"));
    page.say(save("transfer"));
    const json job = finished(page);
    EXPECT_EQ(job["state"], "failed");
    EXPECT_THAT(job["message"], HasSubstr("no folder"));
    EXPECT_EQ(job["url"], "");
    EXPECT_EQ(request(server->port(), request_text("GET", "/saved/2/ball_transfer.json", authorization)).status, 404);
}

TEST_F(Saves, OutliveThePageThatAskedForThem) {
    painter.hold = true;
    start();
    Page page = join();
    page.say(save("turntable", {{"views", 3}}));
    page.next_of("job");
    page.close();
    EXPECT_EQ(viewer->idle_seconds(), 0); // something is to be done
    painter.hold = false;
    EXPECT_TRUE(eventually([&] { return painter.stills == 3; }));
    json hello;
    EXPECT_TRUE(eventually([&] {
        join("control", &hello);
        return hello["jobs"][0]["state"] == "done";
    }));
    EXPECT_EQ(hello["jobs"][0]["what"], "turntable");
    EXPECT_EQ(download(hello["jobs"][0]).body.substr(0, 2), "PK");
}

TEST_F(Saves, AreForgottenInTime) {
    start();
    Page page = join();
    json first;
    for (std::size_t i = 0; i <= most_jobs; ++i) {
        page.say(save("transfer"));
        const json job = finished(page);
        if (i == 0) first = job;
    }
    EXPECT_EQ(download(first).status, 404);
    json hello;
    join("watch", &hello);
    EXPECT_EQ(hello["jobs"].size(), most_jobs);
}

TEST_F(Saves, AreGoneWithTheViewer) {
    painter.hold = true;
    start();
    const std::string files = viewer->folder();
    struct stat found {};
    ASSERT_EQ(stat(files.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0700u);
    Page page = join();
    page.say(save("turntable"));
    EXPECT_TRUE(eventually([&] { return painter.stills == 1; }));
    server->stop("{}");
    viewer.reset(); // while it renders
    EXPECT_FALSE(std::filesystem::exists(files));
}

} // namespace
} // namespace clvr::view
