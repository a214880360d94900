// libFuzzer's entry points. The program's own name chooses the reader: fuzz_nifti runs the target "nifti". With the argument --targets it
// writes the names of all.
#include "tests/fuzz/children.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/runtime/scoped.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace {

struct Run {
    const clvr::test::FuzzTarget* target;
    clvr::TemporaryFolder folder, reports;
};
std::unique_ptr<Run> run;

} // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    if (*argc > 1 && std::string((*argv)[1]) == "--targets") {
        for (const auto& target : clvr::test::fuzz_targets()) std::puts(target.name.c_str());
        std::exit(0);
    }
    const std::string name = std::filesystem::path((*argv)[0]).filename().string(), prefix = "fuzz_";
    if (name.compare(0, prefix.size(), prefix) != 0) {
        std::fprintf(stderr, "call it by a link named fuzz_READER; --targets lists the readers\n");
        std::exit(2);
    }
    run.reset(new Run{&clvr::test::fuzz_target(name.substr(prefix.size())), {}, {}});
    clvr::test::watch_children(run->reports.path().string());
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // An empty input comes as a null pointer, which means "no such file" to read_bytes.
    clvr::test::read_bytes(*run->target, run->folder.path().string(),
                           size ? std::string_view(reinterpret_cast<const char*>(data), size) : "");
    clvr::test::end_at_childs_report();
    return 0;
}
