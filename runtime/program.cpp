#include "runtime/program.hpp"

#include "runtime/check.hpp"
#include "runtime/quirks.hpp"
#include "runtime/source.hpp"

#include <fmt/format.h>

namespace clvr {

std::string build_options(const DeviceFacts& facts, const std::map<std::string, std::string>& defines) {
    std::string options = "-cl-std=CL1.2";
    if (facts.claims_correct_divide_sqrt) options += " -cl-fp32-correctly-rounded-divide-sqrt";
    for (const auto& [name, value] : defines) {
        if (name.empty() || (name + value).find_first_of(" \t\n\"'\\") != std::string::npos)
            throw Error(ErrorKind::internal, fmt::format("the definition {}={} cannot be passed to an OpenCL compiler", name, value));
        options += fmt::format(" -D{}={}", name, value);
    }
    return options;
}

cl::Program build_program(const cl::Context& context, const DeviceFacts& facts, const std::string& path,
                          const std::map<std::string, std::string>& defines) {
    const Source source = expand_source(path, read_kernel_file);
    const std::string options = build_options(facts, defines);
    return cl_check(fmt::format("building {} for {}", path, facts.name), [&] {
        cl::Program program(context, source.text);
        try {
            program.build({facts.handle}, options.c_str());
        } catch (const cl::BuildError& error) {
            std::string log;
            for (const auto& [device, text] : error.getBuildLog()) log += text;
            throw Error(ErrorKind::device,
                        fmt::format("the kernel does not build for {} ({}):\n{}", facts.name, status_name(error.err()),
                                    located_log(log, source, quirks::oclgrind_ignores_line_directives(facts.platform))),
                        path);
        }
        return program;
    });
}

} // namespace clvr
