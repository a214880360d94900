// Saves: what is made of the scene beside the live picture. They outlive the client that asked for them.
#pragma once
#include "host/view/messages.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace clvr::view {

enum class JobState { waiting, running, done, failed, cancelled };

/// Where a save stands.
struct Job {
    std::string id;
    Product what = Product::still;
    std::string name; ///< of the file
    JobState state = JobState::waiting;
    double progress = 0; ///< 0..1
    int samples = 0;     ///< per pixel, so far
    std::string message; ///< why it failed
    std::string path;    ///< of the finished file

    bool finished() const { return state >= JobState::done; }
};

/// One at a time; the last sixteen are remembered with their files. For any thread.
class Jobs {
public:
    /// `changed` is called, without a lock, after each change that is worth telling: at most ten a second of one job's progress.
    explicit Jobs(std::function<void(const Job&)> changed) : changed_(std::move(changed)) {}
    /// Removes the files.
    ~Jobs();
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;

    /// A new job, which `changed` is not told of. Throws Error{usage} while another one is not finished.
    Job begin(Product what, const std::string& name);
    void progress(const std::string& id, double share, int samples);
    void done(const std::string& id, const std::string& path);
    void failed(const std::string& id, const std::string& message);
    void cancelled(const std::string& id);

    /// Asks a job to end; it ends as cancelled. An unknown or finished one is left alone.
    void cancel(const std::string& id);
    void cancel_all();
    /// Set once the job is to end.
    std::shared_ptr<const std::atomic<bool>> cancellation(const std::string& id) const;

    std::vector<Job> all() const;
    bool busy() const;
    /// The path of a finished job's file; empty: there is none of that id and name.
    std::string file(const std::string& id, const std::string& name) const;

private:
    struct Kept;
    std::function<void(const Job&)> changed_;
    mutable std::mutex mutex_;
    std::vector<std::shared_ptr<Kept>> jobs_; // the oldest first
    int last_ = 0;

    // Under the lock.
    std::shared_ptr<Kept> find(const std::string& id) const;
    bool one_is_unfinished() const;
    template <class F>
    void change(const std::string& id, bool always, F&& f);
};

} // namespace clvr::view
