#!/bin/bash
# Refuses kernels that clang warns about. Usage: kernel_syntax.sh ROOT
source "$(dirname "$0")/kernel_files.sh"

check() { kernel_clang "$1" "$2" -fsyntax-only -Wall -Wextra -Wdouble-promotion -Werror; }

for_each_kernel "$1"
