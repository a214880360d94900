#include "runtime/opencl/program.hpp"

#include "runtime/drivers/check.hpp"
#include "runtime/drivers/quirks.hpp"
#include "runtime/opencl/program_cache.hpp"
#include "runtime/opencl/source.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clvr {
namespace {

/// Nothing when the driver does not take the binary.
std::optional<cl::Program> from_binary(const cl::Context& context, const DeviceFacts& facts, const std::string& binary,
                                       const std::string& options) {
    try {
        cl::Program program(context, {facts.handle}, {{binary.begin(), binary.end()}});
        program.build({facts.handle}, options.c_str());
        return program;
    } catch (const cl::Error& error) {
        spdlog::debug("{} rejected a cached program ({}), which is built anew", facts.name, status_name(error.err()));
        return std::nullopt;
    }
}

cl::Program from_source(const cl::Context& context, const DeviceFacts& facts, const std::string& path, const Source& source,
                        const std::string& options) {
    try {
        cl::Program program(context, source.text);
        program.build({facts.handle}, options.c_str());
        return program;
    } catch (const cl::BuildError& error) {
        if (facts.pocl)
            if (const std::string why = quirks::pocl_cache_problem(); !why.empty()) throw Error(ErrorKind::input, why);
        std::string log;
        for (const auto& [device, text] : error.getBuildLog()) log += text;
        throw Error(ErrorKind::device,
                    fmt::format("the kernel does not build for {} ({} with {}):\n{}", facts.name, status_name(error.err()), options,
                                located_log(log, source, quirks::oclgrind_ignores_line_directives(facts.platform))),
                    path);
    }
}

} // namespace

std::string build_options(const DeviceFacts& facts, const std::map<std::string, std::string>& defines) {
    // -w: PoCL lets clang print its count of warnings to stderr, and on AVX2 wide vectors give some ("changes the ABI").
    std::string options = "-cl-std=CL1.2 -w";
    if (facts.claims_correct_divide_sqrt) options += " -cl-fp32-correctly-rounded-divide-sqrt";
    if (quirks::oclgrind_knows_no_noalias_scopes(facts.platform)) options += " -fno-inline";
    if (quirks::pocl_reads_a_header_of_all_builtins(facts.platform, facts.driver_version)) options += " -D_OPENCL_H_"; // its guard
    for (const auto& [name, value] : defines) {
        if (name.empty() || (name + value).find_first_of(" \t\n\"'\\") != std::string::npos)
            throw Error(ErrorKind::internal, fmt::format("the definition {}={} cannot be passed to an OpenCL compiler", name, value));
        options += fmt::format(" -D{}={}", name, value);
    }
    return options;
}

cl::Program build_program(const cl::Context& context, const DeviceFacts& facts, const std::string& path,
                          const std::map<std::string, std::string>& defines) {
    const Source source =
        expand_source(path, read_kernel_file,
                      quirks::pocl_reads_a_header_of_all_builtins(facts.platform, facts.driver_version) ? "lib/builtins.clh" : "");
    const std::string options = build_options(facts, defines);
    return cl_check(fmt::format("building {} for {}", path, facts.name), [&] {
        if (quirks::pocl_aborts_on_broken_binaries(facts.platform)) return from_source(context, facts, path, source, options);
        const std::string key = program_key(facts, source.text, options);
        if (const auto binary = load_program(key))
            if (auto program = from_binary(context, facts, *binary, options)) {
                spdlog::debug("{} for {} came from the cache", path, facts.name);
                return *std::move(program);
            }
        cl::Program program = from_source(context, facts, path, source, options);
        spdlog::debug("{} for {} was built from source", path, facts.name);
        const auto binaries = program.getInfo<CL_PROGRAM_BINARIES>();
        // A context of several devices gives one binary each, empty for those it was not built for.
        for (const auto& binary : binaries)
            if (!binary.empty()) {
                store_program(key, {reinterpret_cast<const char*>(binary.data()), binary.size()});
                break;
            }
        return program;
    });
}

} // namespace clvr
