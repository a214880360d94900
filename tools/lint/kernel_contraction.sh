#!/bin/bash
# Refuses kernels in which a compiler that ignores FP_CONTRACT (clang -ffp-contract=fast, as PoCL-CUDA uses) can fuse a product and a sum:
# such a product must be written fma(). kernels/probe/ is left out: there the unfused a * b + c is what is asked of the device.
# Usage: kernel_contraction.sh ROOT
source "$(dirname "$0")/kernel_files.sh"

fused() { # MODE FILE DEFINE...: "file:line" of each fused operation
    kernel_clang "${@:2}" -target nvptx64-nvidia-nvcl -ffp-contract="$1" -O2 -gline-directives-only -S -o - |
        awk '$1 == ".file" { gsub(/"/, ""); file[$2] = $NF } $1 == ".loc" { at = $2 " " $3 } /fma\.rn/ { where[n++] = at }
             END { for (i = 0; i < n; i++) { split(where[i], p, " "); print file[p[1]] ":" p[2] } }'
}
export -f fused

check() { # FILE DEFINE...
    local fast off
    fast=$(fused fast "$@")
    [ -n "$fast" ] || return 0 # nearly always: a written fma() is a call here, no fma.rn
    off=$(fused off "$@")
    [ "$fast" == "$off" ] || {
        echo "$*: product and sum may be fused, write fma():" $(diff <(echo "$off") <(echo "$fast") | sed -n 's/^> //p' | sort -u)
        return 1
    }
}

for_each_kernel "$1" './probe/*' distinct
