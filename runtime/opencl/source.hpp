// Kernel sources: real files with real #include, expanded by clvr into one text so that no driver ever looks for a file.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// One text for the compiler, with `#line` directives, and the origin of each of its lines.
struct Source {
    struct Origin {
        std::string file;
        int line; ///< from 1
    };
    std::string text;
    std::vector<Origin> origins; ///< of line i + 1 of the text
};

/// The content of a file by its path relative to the root of the kernels ("render/shade.cl"); nothing when there is none.
using ReadKernelFile = std::function<std::optional<std::string>(const std::string& path)>;

/// Expands `#include "x"` (x beside the including file, else under the root), each file once; a file that so far was included only inside
/// #if is included again, behind a guard. Includes in <> are left to the compiler, and so are those inside #if that name no file. Throws
/// Error{input} naming the including file and line when a file is missing. `prelude`: a file whose text comes first.
Source expand_source(const std::string& path, const ReadKernelFile& read, const std::string& prelude = {});

/// A compiler's log with positions in our files. `#line` does that already; where a driver ignores it, "anything:LINE:" with a line of the
/// expanded text becomes "file:line:".
std::string located_log(const std::string& log, const Source& source, bool counts_whole_text);

/// Files under this folder replace the embedded ones of the same path; empty: none do. Starts as the environment's CLVR_KERNEL_DIR.
/// Throws Error{usage} when it is not a folder.
void set_kernel_dir(const std::string& folder);

/// From the kernel folder, else embedded.
std::optional<std::string> read_kernel_file(const std::string& path);

} // namespace clvr
