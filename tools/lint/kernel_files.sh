# Sourced by the kernel lints.
set -euo pipefail

kernel_clang() { # FILE WIDTH OPTION...: clang on a kernel file as OpenCL C 1.2, from within kernels/
    clang-14 -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -I . -DCLVR_WIDTH="$2" "${@:3}" "$1"
}

# for_each_kernel ROOT [SKIPPED]: calls the shell function `check FILE WIDTH` for every .cl file of ROOT/kernels but those whose path matches the
# pattern SKIPPED, at packet width 1 and 16, two at a time. Fails when a check does (it says why itself) or when there is no file.
for_each_kernel() {
    cd "$1/kernels"
    local files
    files=$(find . -name '*.cl' ! -path "${2:-}" | sort)
    [ -n "$files" ] || { echo "no kernel file in $PWD"; return 1; }
    export -f check kernel_clang
    sed 's|^\./\(.*\)|\1 1\n\1 16|' <<<"$files" | xargs -P2 -L1 bash -c 'set -euo pipefail; check "$@"' _
}
