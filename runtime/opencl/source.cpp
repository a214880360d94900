#include "runtime/opencl/source.hpp"

#include "runtime/error.hpp"
#include "runtime/system/embedded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string_view>

namespace clvr {
namespace fs = std::filesystem;
namespace {

/// A preprocessor directive: "include" and "\"x\" // why" of a line `#  include "x" // why`. Both empty for any other line.
struct Directive {
    std::string_view name, rest;
};

Directive directive_of(std::string_view line) {
    const auto skip_blanks = [&] { line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size())); };
    skip_blanks();
    if (line.empty() || line.front() != '#') return {};
    line.remove_prefix(1);
    skip_blanks();
    const auto end = std::find_if(line.begin(), line.end(), [](unsigned char c) { return !std::isalpha(c); });
    const std::string_view name = line.substr(0, static_cast<std::size_t>(end - line.begin()));
    line.remove_prefix(name.size());
    skip_blanks();
    return {name, line};
}

/// The x of `"x" ...`; empty when it does not begin with a quote.
std::string quoted(std::string_view text) {
    const std::size_t end = text.find('"', 1);
    return text.empty() || text.front() != '"' || end == std::string_view::npos ? std::string() : std::string(text.substr(1, end - 1));
}

class Expander {
public:
    explicit Expander(const ReadKernelFile& read) : read_(read) {}

    void add(const std::string& path) {
        const auto text = read_(path);
        if (!text) throw Error(ErrorKind::input, "there is no such kernel file", path);
        file(path, *text, false);
    }
    Source result() { return std::move(source_); }

private:
    enum class Seen { conditionally, always, open };
    const ReadKernelFile& read_;
    Source source_;
    std::map<std::string, Seen> seen_;

    void line(const std::string& text, const std::string& path, int number) {
        source_.text += text + '\n';
        source_.origins.push_back({path, number});
    }

    void file(const std::string& path, const std::string& text, bool conditional) {
        seen_[path] = Seen::open;
        line(fmt::format("#line 1 \"{}\"", path), path, 1);
        std::istringstream lines(text);
        std::string current;
        int depth = 0;
        for (int number = 1; std::getline(lines, current); ++number) {
            if (!current.empty() && current.back() == '\r') current.pop_back();
            const Directive directive = directive_of(current);
            if (directive.name == "if" || directive.name == "ifdef" || directive.name == "ifndef") ++depth;
            if (directive.name == "endif") --depth;
            const std::string name = directive.name == "include" ? quoted(directive.rest) : std::string();
            if (directive.name == "pragma" && directive.rest == "once") {
                line("", path, number); // the compiler sees one file
            } else if (name.empty() || !included(path, name, number, conditional || depth > 0)) {
                line(current, path, number);
            }
        }
        seen_[path] = conditional ? Seen::conditionally : Seen::always;
    }

    /// False when the directive is to stay for the compiler.
    bool included(const std::string& from, const std::string& name, int number, bool conditional) {
        for (const fs::path& candidate : {fs::path(from).parent_path() / name, fs::path(name)}) {
            const std::string path = candidate.lexically_normal().generic_string();
            if (path.compare(0, 2, "..") == 0) continue; // outside the root
            const auto text = read_(path);
            if (!text) continue;
            const auto seen = seen_.find(path);
            if (seen != seen_.end() && seen->second != Seen::conditionally) {
                line("", from, number); // keeps the count of lines
                return true;
            }
            const std::string guard = guard_of(path);
            line("#ifndef " + guard, from, number);
            line("#define " + guard, from, number);
            file(path, *text, conditional);
            line("#endif", from, number);
            line(fmt::format("#line {} \"{}\"", number + 1, from), from, number);
            return true;
        }
        if (conditional) return false;
        throw Error(ErrorKind::input,
                    fmt::format("#include \"{}\" names no kernel file, neither beside this one nor under the root of the kernels", name),
                    fmt::format("{}:{}", from, number));
    }

    static std::string guard_of(const std::string& path) {
        std::string guard = "CLVR_INCLUDED_" + path;
        std::replace_if(
            guard.begin(), guard.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
        return guard;
    }
};

std::string& kernel_dir() {
    static std::string folder = [] {
        const char* variable = std::getenv("CLVR_KERNEL_DIR");
        return std::string(variable ? variable : "");
    }();
    return folder;
}

void require_folder(const std::string& folder, const char* where) {
    std::error_code failed;
    if (!fs::is_directory(folder, failed))
        throw Error(ErrorKind::usage, fmt::format("\"{}\" is not a folder; give one with the layout of kernels/", folder), where);
}

} // namespace

Source expand_source(const std::string& path, const ReadKernelFile& read, const std::string& prelude) {
    Expander expander(read);
    if (!prelude.empty()) expander.add(prelude);
    expander.add(path);
    return expander.result();
}

std::string located_log(const std::string& log, const Source& source, bool counts_whole_text) {
    if (!counts_whole_text) return log;
    std::istringstream lines(log);
    std::string current, result;
    while (std::getline(lines, current)) {
        const std::size_t colon = current.find_first_of(": \t");
        char* end = nullptr;
        const unsigned long number = colon == std::string::npos ? 0 : std::strtoul(current.c_str() + colon + 1, &end, 10);
        if (number >= 1 && number <= source.origins.size() && current[colon] == ':' && *end == ':') {
            const Source::Origin& origin = source.origins[number - 1];
            current = fmt::format("{}:{}{}", origin.file, origin.line, end);
        }
        result += current + '\n';
    }
    return result;
}

void set_kernel_dir(const std::string& folder) {
    if (!folder.empty()) require_folder(folder, "--kernel-dir");
    kernel_dir() = folder;
}

std::optional<std::string> read_kernel_file(const std::string& path) {
    if (!kernel_dir().empty()) {
        require_folder(kernel_dir(), "CLVR_KERNEL_DIR");
        const fs::path replacement = fs::path(kernel_dir()) / path;
        std::error_code failed;
        if (fs::is_regular_file(replacement, failed)) {
            std::ifstream file(replacement, std::ios::binary);
            if (!file) throw Error(ErrorKind::input, "cannot be read; check its permissions", replacement.string());
            return std::string(std::istreambuf_iterator<char>(file), {});
        }
    }
    const auto found = embedded_kernels().find(path);
    if (found == embedded_kernels().end()) return std::nullopt;
    return found->second;
}

} // namespace clvr
