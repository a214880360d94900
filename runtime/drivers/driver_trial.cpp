#include "runtime/drivers/driver_trial.hpp"

#include "runtime/drivers/check.hpp"
#include "runtime/drivers/facts.hpp"
#include "runtime/system/folders.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/system/temporary.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace clvr {
namespace fs = std::filesystem;
namespace {

constexpr const char* trial_version = "driver trial 1";
constexpr unsigned patience_s = 600; // a driver on a busy machine (seen: 60 s at a load of 30) is not a driver that hangs
constexpr const char* source = "__kernel void trial(__global uint* x) { x[get_global_id(0)] += 41u; }";

void run_small_kernel(const cl::Device& handle) {
    const cl::Context context(handle);
    cl::CommandQueue queue(context, handle);
    cl::Program program(context, std::string(source));
    program.build({handle}, "-cl-std=CL1.2");
    cl::Kernel kernel(program, "trial");
    const cl::Buffer buffer(context, CL_MEM_READ_WRITE, 4 * sizeof(cl_uint));
    cl_uint values[4] = {1, 1, 1, 1};
    queue.enqueueWriteBuffer(buffer, CL_TRUE, 0, sizeof values, values);
    kernel.setArg(0, buffer);
    queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(4));
    queue.enqueueReadBuffer(buffer, CL_TRUE, 0, sizeof values, values);
}

/// Tries one device of each kind, as devices of a kind fail alike.
void try_platform(const cl::Platform& platform) {
    std::vector<cl::Device> devices;
    platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    std::set<cl_device_type> tried;
    for (const cl::Device& device : devices)
        if (device.getInfo<CL_DEVICE_AVAILABLE>() && device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() &&
            tried.insert(device.getInfo<CL_DEVICE_TYPE>()).second)
            run_small_kernel(device);
}

void send(int pipe, const std::string& line) { [[maybe_unused]] const ssize_t sent = ::write(pipe, line.data(), line.size()); }

/// Tries the platforms from `first` on: "try N" before each, then "good", or "bad <why>"; "done" at the end.
[[noreturn]] void run_child(int first, int answers, int said, const std::string& cache) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGALRM, SIGPIPE}) std::signal(signal, SIG_DFL);
    ::alarm(patience_s);
    ::dup2(said, STDOUT_FILENO);
    ::dup2(said, STDERR_FILENO);
    if (!cache.empty()) ::setenv("POCL_CACHE_DIR", cache.c_str(), 1); // an empty folder, as kept kernels would hide a missing linker
    try {
        std::vector<cl::Platform> platforms;
        try {
            cl::Platform::get(&platforms);
        } catch (const cl::Error&) { // the loader found none
        }
        for (int p = first; p < static_cast<int>(platforms.size()); ++p) {
            send(answers, fmt::format("try {}\n", p));
            try {
                try_platform(platforms[static_cast<std::size_t>(p)]);
                send(answers, "good\n");
            } catch (const cl::BuildError& error) {
                for (const auto& [device, log] : error.getBuildLog()) send(STDERR_FILENO, log + "\n");
                send(answers, fmt::format("bad does not build a small kernel ({})\n", status_name(error.err())));
            } catch (const cl::Error& error) {
                send(answers, fmt::format("bad fails in {} with {}\n", error.what(), status_name(error.err())));
            }
        }
        send(answers, "done\n");
    } catch (...) {
        ::_exit(1);
    }
    ::_exit(0); // no driver's destructors
}

/// Reads both pipes to their ends.
void read_both(int answers, int said, std::string& answered, std::string& spoken) {
    pollfd ends[] = {{answers, POLLIN, 0}, {said, POLLIN, 0}};
    std::string* const to[] = {&answered, &spoken};
    while (ends[0].fd >= 0) { // a process that a driver leaves running may keep the other pipe open
        if (::poll(ends, 2, -1) < 0 && errno != EINTR) return;
        for (int k = 0; k < 2; ++k) {
            if (ends[k].fd < 0 || ends[k].revents == 0) continue;
            char piece[4096];
            const ssize_t n = ::read(ends[k].fd, piece, sizeof piece);
            if (n > 0 && to[k]->size() < (std::size_t{1} << 20)) to[k]->append(piece, static_cast<std::size_t>(n));
            if (n == 0 || (n < 0 && errno != EINTR)) ends[k].fd = -1;
        }
    }
}

struct Trial {
    DriverProblems problems;
    bool complete = true; ///< whether each driver could be tried
};

bool lacks_room(const std::string& said) {
    for (const int why : {ENOSPC, EFBIG, EDQUOT})
        if (said.find(std::strerror(why)) != std::string::npos) return true;
    return false;
}

/// Tries the platforms from `first` on in one child. Returns where the next child has to begin, or -1 when all were tried.
int try_from(int first, const std::string& cache, Trial& trial) {
    int answers[2], said[2];
    if (::pipe2(answers, O_CLOEXEC) != 0 || ::pipe2(said, O_CLOEXEC) != 0) {
        trial.complete = false;
        return -1; // few descriptors stay open, and no further child needs them
    }
    const pid_t child = ::fork();
    if (child == 0) run_child(first, answers[1], said[1], cache);
    ::close(answers[1]), ::close(said[1]);
    std::string answered, spoken;
    if (child > 0) read_both(answers[0], said[0], answered, spoken);
    ::close(answers[0]), ::close(said[0]);
    if (child < 0) { // no process can be started: nothing is known
        trial.complete = false;
        return -1;
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const auto add = [&](int platform, const std::string& how) {
        if (lacks_room(spoken))
            trial.complete = false; // only the trial's own folder was full: clvr's kernels go elsewhere
        else
            trial.problems[platform] = driver_problem(spoken, how);
    };
    int at = -1;
    std::istringstream lines(answered);
    for (std::string line; std::getline(lines, line);) {
        if (line.compare(0, 4, "try ") == 0) at = std::stoi(line.substr(4));
        if (line.compare(0, 4, "bad ") == 0) add(at, line.substr(4));
        if (line == "good" || line.compare(0, 4, "bad ") == 0) first = at + 1;
        if (line == "done") return -1;
    }
    const std::string end = WIFEXITED(status)             ? fmt::format("ended the process with exit code {}", WEXITSTATUS(status))
                            : WTERMSIG(status) == SIGALRM ? fmt::format("gave no answer within {} s", patience_s)
                                                          : fmt::format("crashed ({})", strsignal(WTERMSIG(status)));
    if (at < first) at = -1; // not within a platform's trial
    add(at, end);
    return at < 0 ? -1 : at + 1;
}

std::string stamp(const fs::path& file) {
    struct stat s {};
    if (::stat(file.c_str(), &s) != 0) return file.string() + " -";
    return fmt::format("{} {} {}.{}", file.string(), s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec);
}

/// All that decides whether drivers work: their registrations and files, their settings, the programs that they call.
std::string circumstances() {
    std::string all = trial_version;
    const auto add = [&](const std::string& line) { all += '\n' + line; };
    for (char** variable = environ; *variable; ++variable)
        for (const char* start :
             {"POCL_", "OCL_", "OPENCL_", "OCLGRIND_", "RUSTICL_", "LD_LIBRARY_PATH=", "PATH=", "CUDA_", "CL_", "HOME="})
            if (std::strncmp(*variable, start, std::strlen(start)) == 0) add(*variable);
    const char* vendors = std::getenv("OCL_ICD_VENDORS");
    const fs::path place = vendors && *vendors ? vendors : "/etc/OpenCL/vendors";
    add(stamp(place));
    std::set<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(place, none)) files.insert(entry.path());
    for (const fs::path& file : files) {
        add(stamp(file));
        if (const auto library = load_file(file)) {
            const std::string path = library->substr(0, library->find_first_of("\r\n"));
            add(path.empty() || path[0] != '/' ? path : stamp(path));
        }
    }
    add(stamp("/etc/ld.so.cache")); // changes with every library that is installed
    std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        for (const char* tool : {"ld", "ld.lld", "lld", "clang"}) add(stamp(fs::path(folder) / tool));
    return sha256_hex(all);
}

Trial try_all() {
    std::error_code failed;
    const std::string temporary = fs::temp_directory_path(failed).string();
    if (!failed) remove_stale_folders(temporary, "trial");
    const Temporary cache = failed ? Temporary() : Temporary::folder_in(temporary, "trial");
    Trial trial;
    for (int next = 0; next >= 0;) next = try_from(next, cache.path(), trial);
    return trial;
}

} // namespace

std::string driver_problem(const std::string& said, const std::string& end) {
    if (said.find("Executable \"ld\" doesn't exist") != std::string::npos) // PoCL, through LLVM's driver
        return "cannot link kernels: there is no linker (ld) in PATH; install binutils, or set PATH";
    std::string last;
    std::istringstream lines(said);
    for (std::string line; std::getline(lines, line);)
        if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
    return last.empty() ? end : fmt::format("{} (it said: {:.200})", end, last);
}

DriverProblems try_drivers() {
    const auto folder = cache_folder();
    const auto path = folder ? std::optional(*folder / "drivers" / circumstances()) : std::nullopt;
    std::error_code none;
    if (path && fs::exists(*path, none)) return {};
    const Trial trial = try_all();
    for (const auto& [platform, what] : trial.problems) spdlog::debug("OpenCL platform {} {}", platform, what);
    if (path && trial.complete && trial.problems.empty()) replace_file(*path, std::string(trial_version) + "\n");
    return trial.problems;
}

} // namespace clvr
