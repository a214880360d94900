# Sourced by the kernel lints.
set -euo pipefail

# What the host may define for a build, beside the packet width: together these reach every `#if` of the kernels.
variants=('-DCLVR_MARCH=0 -DCLVR_LIT=1 -DCLVR_KNOWN=1'
    '-DCLVR_VOXEL=short -DCLVR_VOXEL_BITS=16 -DCLVR_VOXEL_SIGNED=1 -DCLVR_POOLS=2 -DCLVR_MARCH=1'
    '-DCLVR_VOXEL=float -DCLVR_VOXEL_BITS=32 -DCLVR_VOXEL_SIGNED=0 -DCLVR_POOLS=8 -DCLVR_MARCH=2 -DCLVR_RAYS=1')

kernel_compiler=$(command -v clang-14 || command -v clang) || { echo "no clang here"; exit 1; }
export kernel_compiler

kernel_clang() { # FILE OPTION...: clang on a kernel file as OpenCL C 1.2, from within kernels/
    "$kernel_compiler" -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -I . "${@:2}" "$1"
}

# Reads lines "FILE DEFINE..." and prints those whose preprocessed text is new: most kernels use few of the defines.
distinct() {
    local line text
    local -A seen=()
    while read -r line; do
        text=$("$kernel_compiler" -x cl -cl-std=CL1.2 -I . -E -P ${line#* } "${line%% *}" 2>/dev/null) || text=$line # the check says what is wrong
        [ -n "${seen[=$text]:-}" ] || echo "$line"
        seen[=$text]=1
    done
}

# for_each_kernel ROOT [SKIPPED [FILTER]]: calls the shell function `check FILE DEFINE...` for every .cl file of ROOT/kernels but those whose path
# matches the pattern SKIPPED, in every variant (that the shell function FILTER lets through), those that mention CLVR_WIDTH also 16 lanes wide; two
# at a time. Fails when a check does (it says why itself) or when there is no file.
for_each_kernel() {
    cd "$1/kernels"
    local files file width variant
    files=$(find . -name '*.cl' ! -path "${2:-}" | sort)
    [ -n "$files" ] || { echo "no kernel file in $PWD"; return 1; }
    export -f check kernel_clang
    for file in $files; do
        for width in 1 $(grep -q CLVR_WIDTH "$file" && echo 16); do
            for variant in "${variants[@]}"; do echo "${file#./} -DCLVR_WIDTH=$width $variant"; done
        done
    done | "${3:-cat}" | xargs -P2 -L1 bash -c 'set -euo pipefail; check "$@"' _
}
