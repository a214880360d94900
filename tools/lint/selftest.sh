#!/bin/bash
# Proves that each lint refuses what it is for, and accepts what is fine: small trees in a temporary folder. Usage: selftest.sh
set -euo pipefail
lints=$(cd "$(dirname "$0")" && pwd)
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

# expect accepts|refuses LINT FILE [TEXT]: a tree with the text on stdin as FILE is accepted, or refused with TEXT in the message.
expect() {
    local verdict=$1 lint=$2 file=$3 text=${4:-} said status=0
    rm -rf "${tree:?}"/*
    mkdir -p "$tree/$(dirname "$file")" "$tree/kernels" "$tree/runtime" "$tree/host"
    { [[ $file != *.cl ]] || echo '#pragma OPENCL FP_CONTRACT OFF'; cat; } >"$tree/$file"
    said=$("$lints/$lint.sh" "$tree" 2>&1) || status=$?
    case $verdict in
        accepts) [ "$status" == 0 ] ;;
        refuses) [ "$status" != 0 ] && [[ $said == *"$text"* ]] ;;
    esac || {
        printf 'FAILED: expected: %s %s %s %s; but status %s:\n%s\n' "$lint" "$verdict" "$file" "$text" "$status" "$said"
        failures=$((failures + 1))
    }
}
kernel() { echo "kernel void k(global float* x, global float16* v, global int* n) { size_t i = get_global_id(0); $1 }"; }

for lint in kernel_syntax kernel_symbols kernel_contraction; do
    expect accepts $lint kernels/render/k.cl < <(kernel 'x[i] = fma(x[i], x[i], floor(x[i + 1])) + sqrt(x[i] / 3.0f); v[i] = rint(v[i]); n[i] = min(n[i], convert_int(x[i])) + (int)x[i];')
    expect refuses $lint kernels/readme.txt 'no kernel file' <<<'nothing to see'
    expect refuses $lint kernels/k.cl 'error' < <(kernel 'x[i] = 0.0f;'; printf '#if defined(CLVR_MARCH) && CLVR_MARCH == 2\n#error\n#endif\n') # in a variant
done
expect refuses kernel_syntax kernels/k.cl 'unused variable' < <(kernel 'int unused;')
expect refuses kernel_syntax kernels/k.cl 'double' < <(kernel 'x[i] = x[i] * 2.0;')
expect refuses kernel_syntax kernels/lib/k.clh 'static inline' <<<'inline float f(float x) { return x; }'
expect refuses kernel_syntax kernels/k.cl 'error' <<<'this is no OpenCL C'
expect refuses kernel_syntax kernels/k.cl 'width_16' < <(kernel 'x[i] = 0;'; printf '#if CLVR_WIDTH == 16\n#error width_16\n#endif\n')

for call in 'exp(x[i])' 'log(x[i])' 'sin(x[i])' 'cos(x[i])' 'pow(x[i], x[i])' 'acos(x[i])' 'atan2(x[i], x[i])' 'mad(x[i], x[i], x[i])' 'rsqrt(x[i])' \
    'native_sqrt(x[i])' 'half_recip(x[i])' 'mix(x[i], x[i], x[i])' 'dot(v[i].xyz, v[i].xyz)' 'length(v[i].xyz)' 'normalize(v[i].xyz).x' 'fast_length(v[i].xyz)' \
    'cross(v[i].xyz, v[i].xyz).x' 'distance(v[i].xyz, v[i].xyz)' 'step(x[i], x[i])' 'smoothstep(x[i], x[i], x[i])' 'fmin(x[i], x[i])' 'fmax(x[i], x[i])' \
    'min(x[i], x[i])' 'clamp(x[i], 0.0f, 1.0f)' 'fmod(x[i], x[i])' 'convert_int_sat(x[i])' 'exp(v[i]).s0' 'x[i] * 2.0'; do
    name=${call%%(*}
    expect refuses kernel_symbols kernels/k.cl "$([ "$name" == "$call" ] && echo double || echo "$name")" < <(kernel "x[i] = $call;")
done
expect refuses kernel_symbols kernels/k.cl 'exp' < <(echo '#define HIDDEN(x) ex##p(x)'; kernel 'x[i] = HIDDEN(x[i]);')
expect refuses kernel_symbols kernels/k.cl 'fmuladd' < <(echo '#pragma OPENCL FP_CONTRACT ON'; kernel 'x[i] = x[i] * x[i + 1] + x[i + 2];')
expect refuses kernel_symbols kernels/render/k.cl 'lib/vec' < <(kernel 'if (any(v[i] < 0.0f)) x[i] = 0.0f;')

expect refuses kernel_contraction kernels/k.cl 'k.cl:2' < <(kernel 'x[i] = x[i] * x[i + 1] + x[i + 2];')
expect refuses kernel_contraction kernels/k.cl 'k.cl:2' < <(kernel 'v[i] = v[i + 2] - v[i] * v[i + 1];')
expect refuses kernel_contraction kernels/probe/k.cl 'no kernel file' < <(kernel 'x[i] = x[i] * x[i + 1] + x[i + 2];') # the probe is not looked at

if command -v clang-format-14 >/dev/null; then # else tests.cmake leaves this lint out
    expect accepts format runtime/a.cpp <<<'int f(int x) { return x; }'
    expect refuses format runtime/a.cpp 'clang-format-violations' <<<'int  f( int x ){return x;}'
    expect refuses format runtime/a.txt 'no C++ file' <<<'int  f( int x ){return x;}'
fi

expect accepts layers host/io/a.hpp <<<'#include "host/frame/frame.hpp"'
for case in 'runtime/a.cpp host/volume/voxels.hpp' 'runtime/system/a.cpp runtime/opencl/device.hpp' 'runtime/opencl/a.cpp runtime/trust/trust.hpp' \
    'host/volume/a.cpp host/appearance/transfer_function.hpp' 'host/phantom/a.cpp host/appearance/transfer_function.hpp' 'host/volume/a.cpp host/frame/frame.hpp' 'host/render/a.hpp host/io/picture/frame_file.hpp' \
    'host/io/a.cpp host/cli/commands.hpp' 'host/cli/a.cpp tests/reference/a.hpp' 'host/cli/a.cpp frame.hpp' 'kernels/lib/a.clh render/a.cl'; do
    expect refuses layers "${case% *}" "${case#* }" <<<"#include \"${case#* }\""
done
expect refuses layers host/cli/a.cpp 'only in runtime' <<<'#include <CL/opencl.hpp>'
expect refuses layers host/cli/a.cpp 'only in host/io' <<<'#include <tiffio.h>'
expect refuses layers host/cli/a.cpp 'steady_clock' <<<'auto now = std::chrono::system_clock::now();'
expect refuses layers runtime/a.cpp 'knows no volume' <<<'// for every Voxel'

expect accepts documents README.md <<<'# clvr'
expect accepts documents host/README.md < <(printf '# host\n\n## Frames\n\nSee host/README.md, "Frames", "host" and `host/README.md`.\n')
expect refuses documents host/a.hpp 'there is no host/README.md' <<<'/// host/README.md, "Frames"'
expect refuses documents host/README.md 'no section "Pictures"' < <(printf '## Frames\n`host/README.md`, "Frames" and "Pictures"\n')
expect refuses documents host/README.md 'no section "Two words"' < <(printf '## Words\nas host/README.md, "Two\nwords" says\n')
expect refuses documents host/README.md 'there is no host/gone.cpp' <<<'as `host/gone.cpp` does'
expect refuses documents kernels/lib/a.clh 'there is no host/gone.cpp' <<<'// As host/gone.cpp does it.'
for document in DESIGN.md 'SPEC section 3' 'FACTS.md' 'kernel_study/vec.clh'; do
    expect refuses documents kernels/lib/a.clh 'which no clone has' <<<"// as $document says"
done

[ "$failures" == 0 ] && echo "every lint refuses what it should"
