#!/bin/bash
# Refuses kernels that use what does not have the same bits on every device (kernels/README.md, "Arithmetic"): looks at what the compiled IR
# leaves unresolved, so it sees through macros and headers. Usage: kernel_symbols.sh ROOT
source "$(dirname "$0")/kernel_files.sh"

# Demangled declarations that are fine. A conversion with _sat from float differs between devices for NaN; min, max and clamp for floats' zeros.
allowed=(
    '(fma|floor|ceil|trunc|rint|fabs|sqrt|copysign)\('
    'convert_(?!\w*_sat\w*\(float)\w+\('
    '(vload|vstore)\d*\('
    '(get_\w+|barrier|mem_fence|read_mem_fence|write_mem_fence)\('
    '(atomic|atom)_\w+\('
    '(any|all|select|shuffle|shuffle2)\('
    '(min|max|clamp|abs|abs_diff|mul_hi|mul24|mad24|rotate|popcount|clz)\((?!.*float)'
    'llvm\.(memcpy|memset|memmove|lifetime|dbg)'
)
export fine="^($(IFS='|'; echo "${allowed[*]}"))"

check() { # FILE DEFINE...
    local ir refused fine=$fine
    [[ $1 != probe/* ]] || fine+='|^(read_imagef\(|__translate_sampler)' # how fast a device reads images is asked, what it reads is not used
    ir=$(kernel_clang "$@" -target spir64 -O0 -emit-llvm -S -o -)
    refused=$(grep -oP '^declare [^@]*@\K[\w.]+' <<<"$ir" | c++filt | grep -vP "$fine" | tr '\n' ' ') || true
    ! grep -qw double <<<"$ir" || refused+="double "
    [ -z "$refused" ] || { echo "$*: not on the list of what has the same bits everywhere: $refused"; return 1; }
}

# Masks are 1 at width 1 and -1 at width 16, so what reads them stays in one header.
masks=$(cd "$1/kernels" && grep -rnP '^((?!//).)*\b(any|all|select)\(' --include='*.cl' --include='*.clh' . | grep -vE '^\./lib/(vec|builtins)') || true
[ -z "$masks" ] || { echo "any, all and select belong in lib/vec*.clh only:"; echo "$masks"; exit 1; }

for_each_kernel "$1"
