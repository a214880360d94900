// A whole viewer with its server; the painter alone is a fake.
#pragma once
#include "host/io/picture/frame_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/view/viewer.hpp"
#include "tests/view/fake_painter.hpp"
#include "tests/view/serving.hpp"

namespace clvr::view {

/// A volume of 8x8x8 bytes with a ball in it.
inline VolumePointer ball() {
    Voxels v;
    v.type = VoxelType::u8;
    v.dims = {8, 8, 8};
    v.geometry.spacing = {1, 1, 2};
    v.format = "NIfTI", v.source = "/home/somebody/secret/ball.nii.gz", v.modality = "CT";
    for (int i = 0; i < 512; ++i) {
        const int x = i % 8 - 4, y = i / 8 % 8 - 4, z = i / 64 - 4;
        v.bytes.push_back(static_cast<unsigned char>(std::max(0, 200 - 10 * (x * x + y * y + z * z))));
    }
    return std::make_shared<const PreparedVolume>(std::move(v));
}

class Viewing : public testing::Test {
protected:
    test::Folder folder;
    FakePainter painter;
    SteadyClock clock;
    ServerSettings server_settings;
    ViewerSettings settings;
    std::unique_ptr<Server> server;
    std::unique_ptr<Viewer> viewer;

    Viewing() {
        server_settings.token = "secret";
        settings.volume = ball();
        settings.name = "ball.nii.gz", settings.version = "1.2.3";
        settings.scene.volume = "/home/somebody/secret/ball.nii.gz";
        settings.scene.width = 32, settings.scene.height = 24, settings.scene.spp = 4;
        settings.loop.settle_s = 0.01;
    }
    int start() {
        server = std::make_unique<Server>(server_settings);
        viewer = std::make_unique<Viewer>(settings, painter, clock, *server);
        server->start(*viewer);
        return server->port();
    }
    void TearDown() override {
        painter.hold = false;
        if (server) server->stop("{}");
        viewer.reset();
        server.reset();
    }

    /// A client that has said the token; `hello`, where given, is the answer.
    Page join(const std::string& role = "control", json* hello = nullptr) const {
        std::optional<Page> page;
        EXPECT_TRUE(eventually([&] { return page.emplace(server->port()).status() == 101; }));
        page->say(json{{"type", "hello"}, {"token", "secret"}, {"role", role}});
        const json answer = page->next_of("hello");
        if (hello) *hello = answer;
        return std::move(*page);
    }
    /// What a page sends first: the scene as it was told, with the camera where it stands.
    static json scene_of(const json& hello) {
        json scene = hello["scene"];
        for (const char* part : {"eye", "target", "up"}) scene["camera"][part] = hello["view"][part];
        return scene;
    }
    static json change(std::uint64_t generation, const json& scene) {
        return {{"type", "scene"}, {"generation", generation}, {"scene", scene}};
    }
    /// The last news of a job that ends.
    static json finished(Page& page) {
        for (;;) {
            const json job = page.next_of("job");
            if (job.is_null() || job["state"] == "done" || job["state"] == "failed" || job["state"] == "cancelled") return job;
        }
    }
    Reply download(const json& job) const {
        return request(server->port(), request_text("GET", "/" + job.value("url", ""), authorization));
    }
    /// The next picture of that phase (0 moving, 1 accumulating, 2 settled), acknowledged.
    static std::string picture(Page& page, char phase) {
        for (;;) {
            const Page::Message m = page.next();
            if (m.code < 0 || m.code == 8) return {};
            if (m.code != 2) continue;
            page.acknowledge(m);
            if (m.bytes[30] == phase) return m.bytes;
        }
    }
};

} // namespace clvr::view
