// `clvr view` in a browser, as a user works with it: real events, and a look at the pixels.
#include "tests/cli/chromium.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <memory>
#include <optional>

namespace clvr {
namespace {

using test::Chromium;
using testing::HasSubstr;
using testing::IsEmpty;

class ViewInABrowser : public Program {
protected:
    void SetUp() override {
        if (!Chromium::installed()) GTEST_SKIP() << "there is no " << Chromium::program << "; tools/install_packages.sh test installs it";
        viewer_.emplace(start({"view", "demo:head", "--no-browser", "--spp", "2", "--azimuth", "40"}));
        const std::string url = url_of_viewer();
        ASSERT_THAT(url, HasSubstr("#token=")) << viewer_->err();
    }
    void TearDown() override {
        if (!viewer_) return;
        ::kill(viewer_->pid(), SIGTERM);
        viewer_->wait();
    }

    /// What it prints first.
    std::string url_of_viewer() const {
        for (int k = 0; k < 1200; ++k) {
            const std::string text = viewer_->out();
            if (const std::size_t end = text.find('\n'); end != std::string::npos) return text.substr(0, end);
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return {};
    }

    /// The page with its settled picture.
    std::unique_ptr<Chromium> page(int width, int height, double pixel_ratio = 1, bool touch = false) const {
        auto browser = std::make_unique<Chromium>(width, height, pixel_ratio, touch);
        browser->open(url_of_viewer());
        EXPECT_TRUE(browser->becomes("document.getElementById('stage')?.dataset.phase === 'settled'", 120)) << viewer_->err();
        return browser;
    }

    static constexpr const char* settled = "document.getElementById('stage').dataset.phase === 'settled'";

    /// A number that tells the canvas's pictures apart, once one is settled that is not `before`.
    static double picture(Chromium& browser, double before = -1) {
        const std::string sum =
            "(() => { const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, "
            "c.height).data; let s = 0; for (let i = 0; i < d.length; ++i) s = (s * 31 + d[i]) % 4294967291; return s; })()";
        EXPECT_TRUE(browser.becomes(std::string(settled) + " && " + sum + " !== " + std::to_string(before), 120));
        return browser.value(sum).get<double>();
    }
    /// Pixels of the canvas that are not black.
    static int lit_pixels(Chromium& browser) {
        return browser
            .value(
                "(() => { const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; "
                "let n = 0; for (let i = 0; i < d.length; i += 4) n += d[i] + d[i + 1] + d[i + 2] > 30; return n; })()")
            .get<int>();
    }
    static std::string button(const std::string& text) {
        return "[...document.querySelectorAll('button, summary, label')].find(b => b.textContent.trim() === '" + text + "')";
    }
    static void open_section(Chromium& browser, const std::string& title) {
        const std::string section =
            "[...document.querySelectorAll('details')].find(d => d.querySelector('summary').textContent.trim() === '" + title + "')";
        if (browser.value(section + ".open") == false) browser.click(section + ".querySelector('summary')");
    }
    /// The bytes of the one file in the folder of downloads whose name ends so, when it is there whole.
    static std::string downloaded(const Chromium& browser, const std::string& ending) {
        for (int k = 0; k < 600; ++k) {
            std::error_code none;
            for (const auto& entry : std::filesystem::directory_iterator(browser.downloads(), none)) {
                const std::string name = entry.path().filename().string();
                if (name.size() < ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0) continue;
                std::ifstream file(entry.path(), std::ios::binary);
                return {std::istreambuf_iterator<char>(file), {}};
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        return {};
    }

    std::optional<Child> viewer_;
};

TEST_F(ViewInABrowser, TurnsEditsCutsAndSavesWhatRenderWrites) {
    const auto browser = page(660, 420);
    const double first = picture(*browser);
    EXPECT_GT(lit_pixels(*browser), 3000);

    browser->drag(150, 200, 230, 190); // turns
    const double turned = picture(*browser, first);
    const int lit = lit_pixels(*browser);
    browser->wheel(150, 200, -240); // comes nearer
    const double near = picture(*browser, turned);
    EXPECT_NE(lit_pixels(*browser), lit);
    browser->key("z", 'Z', 2); // Ctrl: back
    EXPECT_EQ(picture(*browser, near), turned);

    browser->click("[...document.querySelectorAll('.preset')].find(b => b.textContent.startsWith('ct-bone'))");
    const double bone = picture(*browser, turned);
    open_section(*browser, "Cut open");
    browser->click(button("Clip plane"));
    picture(*browser, bone);

    open_section(*browser, "Save");
    browser->click(button("Save scene"));
    const std::string scene = downloaded(*browser, ".json");
    ASSERT_THAT(scene, HasSubstr("clvr.format"));
    browser->click(button("Save picture"));
    const std::string saved = downloaded(*browser, ".png");
    ASSERT_FALSE(saved.empty());
    EXPECT_THAT(browser->complaints(), IsEmpty());

    home.write("saved.json", scene);
    const Outcome rendered =
        run({"render", (home.path() / "saved.json").string(), "--denoise", "-o", (home.path() / "again.png").string()});
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    std::ifstream file(home.path() / "again.png", std::ios::binary);
    const std::string again(std::istreambuf_iterator<char>(file), {});
    EXPECT_TRUE(again == saved) << "not the same bytes: " << again.size() << " rendered, " << saved.size() << " saved";
}

TEST_F(ViewInABrowser, TurnsByOneFingerAndComesNearerByTwo) {
    const auto browser = page(300, 460, 2, true);
    const double first = picture(*browser);
    browser->touch("touchStart", {{120, 120}});
    for (int k = 1; k <= 5; ++k) browser->touch("touchMove", {{120.0 + 10 * k, 120}});
    browser->touch("touchEnd", {});
    const double turned = picture(*browser, first);
    browser->touch("touchStart", {{120, 120}, {160, 120}});
    for (int k = 1; k <= 5; ++k) browser->touch("touchMove", {{120.0 - 8 * k, 120}, {160.0 + 8 * k, 120}});
    browser->touch("touchEnd", {});
    picture(*browser, turned);
    EXPECT_THAT(browser->complaints(), IsEmpty());
}

} // namespace
} // namespace clvr
