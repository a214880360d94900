#include "host/view/saver.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/zip_file.hpp"
#include "host/live/caught.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace clvr::view {

namespace {

namespace fs = std::filesystem;

/// A JPEG over black, as `clvr render` writes it.
std::vector<unsigned char> jpeg_of(Painter& painter, Scene scene, const RenderControl& control) {
    scene.features = false;
    const Frame frame = painter.frame(scene, control);
    return encode_jpeg(display_pixels(frame, {scene.tonemap, scene.exposure}, false));
}

void write_bytes(const std::string& path, const std::vector<unsigned char>& bytes) { write_atomically(path, bytes.data(), bytes.size()); }

} // namespace

std::string free_name(const std::string& folder, const std::string& name) {
    fs::path path = fs::path(folder) / name;
    for (int n = 2; fs::exists(path); ++n)
        path = fs::path(folder) / fmt::format("{}-{}{}", fs::path(name).stem().string(), n, fs::path(name).extension().string());
    return path.string();
}

struct Saver::Turntable {
    Job job;
    Scene scene;
    PlacedCamera camera;
    int views, next = 0;
    std::shared_ptr<const std::atomic<bool>> cancelled;
    ZipWriter zip;
};

Saver::Saver(Loop& loop, Worker& worker, Jobs& jobs, SaverSettings settings)
    : loop_(loop), worker_(worker), jobs_(jobs), settings_(std::move(settings)) {}

/// f(); what it throws ends the job, and what was written of its file is gone.
template <class F>
void Saver::guarded(const Job& job, F&& f) {
    const auto remove_file = [&] {
        std::error_code ignored;
        fs::remove(place_of(job), ignored);
    };
    try {
        f();
    } catch (const Error& e) {
        remove_file();
        e.kind() == ErrorKind::interrupted ? jobs_.cancelled(job.id) : jobs_.failed(job.id, e.line());
    } catch (...) {
        remove_file();
        jobs_.failed(job.id, caught_error().line());
    }
}

void Saver::still(const Job& job, const Scene& scene, const std::string& format) {
    loop_.run([=, cancelled = jobs_.cancellation(job.id)](Painter& painter) {
        guarded(job, [&] {
            RenderControl control;
            control.cancelled = cancelled.get();
            control.progress = [&](const RenderProgress& p) { jobs_.progress(job.id, p.done, p.samples); };
            if (*cancelled) throw Error(ErrorKind::interrupted, "cancelled");
            jobs_.progress(job.id, 0, 0);
            Write write;
            if (format == "exr") {
                auto frame = std::make_shared<Frame>(painter.frame(scene, control));
                settings_.provenance(*frame, scene);
                write = [frame](const std::string& path) { write_exr(*frame, path); };
            } else if (format == "jpg") {
                write = [bytes = jpeg_of(painter, scene, control)](const std::string& path) { write_bytes(path, bytes); };
            } else {
                write = [pixels = painter.still(scene, control)](const std::string& path) { write_png(pixels, path); };
            }
            worker_.add([=] { finish(job, write, {}); });
        });
    });
}

void Saver::turntable(const Job& job, const Scene& scene, const PlacedCamera& camera, int views) {
    guarded(job, [&] {
        draw_view(
            std::shared_ptr<Turntable>(new Turntable{job, scene, camera, views, 0, jobs_.cancellation(job.id), ZipWriter(place_of(job))}));
    });
}

void Saver::draw_view(std::shared_ptr<Turntable> turntable) {
    loop_.run([=](Painter& painter) {
        Turntable& t = *turntable;
        guarded(t.job, [&] {
            Scene scene = with_camera(t.scene, turned(t.camera, 360.0 * t.next / t.views));
            scene.view = t.next;
            RenderControl control;
            control.cancelled = t.cancelled.get();
            control.progress = [&](const RenderProgress& p) { jobs_.progress(t.job.id, (t.next + p.done) / t.views, p.samples); };
            if (*t.cancelled) throw Error(ErrorKind::interrupted, "cancelled");
            jobs_.progress(t.job.id, static_cast<double>(t.next) / t.views, 0);
            worker_.add([this, turntable, pixels = painter.still(scene, control)] { keep_view(turntable, pixels); });
        });
    });
}

void Saver::keep_view(std::shared_ptr<Turntable> turntable, DisplayPixels pixels) {
    Turntable& t = *turntable;
    guarded(t.job, [&] {
        t.zip.add(fmt::format("view_{:03}.png", t.next), encode_png(pixels));
        if (++t.next < t.views) {
            settings_.let_live_picture_go_on();
            return draw_view(turntable);
        }
        t.zip.finish();
        copy_out(t.job, place_of(t.job));
        jobs_.done(t.job.id, place_of(t.job));
    });
}

void Saver::file(const Job& job, Write write, Write write_kept) {
    worker_.add([=, write = std::move(write), write_kept = std::move(write_kept)] { finish(job, write, write_kept); });
}

void Saver::finish(const Job& job, const Write& write, const Write& write_kept) {
    guarded(job, [&] {
        write(place_of(job));
        if (write_kept && !settings_.output_dir.empty())
            write_kept(free_name(settings_.output_dir, job.name));
        else
            copy_out(job, place_of(job));
        jobs_.done(job.id, place_of(job));
    });
}

std::string Saver::place_of(const Job& job) const { return (fs::path(settings_.folder) / ("job-" + job.id)).string(); }

void Saver::copy_out(const Job& job, const std::string& path) const {
    if (settings_.output_dir.empty()) return;
    const std::string out = free_name(settings_.output_dir, job.name);
    write_atomically(out, [&](const std::string& temporary) {
        std::error_code failed;
        fs::copy_file(path, temporary, fs::copy_options::overwrite_existing, failed);
        if (failed) throw Error(ErrorKind::input, "cannot be written: " + failed.message(), out);
    });
}

} // namespace clvr::view
