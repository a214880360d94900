#!/bin/bash
# Refuses kernels that clang warns about. Usage: kernel_syntax.sh ROOT
source "$(dirname "$0")/kernel_files.sh"

# Unused parameters and functions are fine: stages share argument lists (PATH_ARGS), and a variant need not use all of a file.
check() { kernel_clang "$@" -fsyntax-only -Wall -Wextra -Wno-unused-parameter -Wno-unused-function -Wdouble-promotion -Werror; }

inlines=$(cd "$1/kernels" && grep -rnP '^\s*inline\b' .) || true
[ -z "$inlines" ] || { echo "write static inline (C99's inline alone leaves no function where a compiler does not inline):"; echo "$inlines"; exit 1; }

for_each_kernel "$1"
