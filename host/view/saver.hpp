// Makes the files of saves.
#pragma once
#include "host/live/loop.hpp"
#include "host/view/jobs.hpp"
#include "host/view/volume_facts.hpp"
#include "host/view/worker.hpp"

#include <functional>
#include <memory>
#include <string>

namespace clvr::view {

/// How saves fit into the program around them. None of the functions may be empty.
struct SaverSettings {
    std::string folder;     ///< for the files of jobs
    std::string output_dir; ///< files are written there, too; empty: nowhere
    /// Adds to a frame what its file says of its making; `scene`: text of a scene file.
    std::function<void(Frame& frame, const Scene& scene)> provenance;
    /// Returns when the live picture is of the newest scene, or after a while: so it moves while a turntable is made.
    std::function<void()> let_live_picture_go_on;
};

/// The path of name.png in the folder, or of name-2.png and so on where that is there already.
std::string free_name(const std::string& folder, const std::string& name);

/// Pictures are drawn on the render thread, files are written by the worker. What fails ends its job, with words.
class Saver {
public:
    /// All outlive the saver; once the worker is stopped and the loop gone, nothing runs any more.
    Saver(Loop& loop, Worker& worker, Jobs& jobs, SaverSettings settings);

    /// The scene at its size and samples, as PNG, JPEG or OpenEXR.
    void still(const Job& job, const Scene& scene, const std::string& format);
    /// So many views around the camera's target, as view_000.png and so on in a ZIP.
    void turntable(const Job& job, const Scene& scene, const PlacedCamera& camera, int views);
    /// `write_kept`: the same for the output folder, where paths may mean something. Both are called by the worker.
    using Write = std::function<void(const std::string& path)>;
    void file(const Job& job, Write write, Write write_kept);

private:
    struct Turntable;
    Loop& loop_;
    Worker& worker_;
    Jobs& jobs_;
    const SaverSettings settings_;

    template <class F>
    void guarded(const Job& job, F&& f);
    void draw_view(std::shared_ptr<Turntable> turntable);
    void keep_view(std::shared_ptr<Turntable> turntable, DisplayPixels pixels);
    void finish(const Job& job, const Write& write, const Write& write_kept);
    std::string place_of(const Job& job) const;
    void copy_out(const Job& job, const std::string& path) const;
};

} // namespace clvr::view
