#!/bin/bash
# Refuses C++ and shared headers that clang-format-14 would change. Usage: format.sh ROOT
set -euo pipefail
cd "$1"
mapfile -t files < <(find runtime host tests tools kernels/shared \( -name '*.cpp' -o -name '*.hpp' -o -name '*.h' \) 2>/dev/null | sort)
[ "${#files[@]}" -gt 0 ] || { echo "format: no C++ file under $PWD"; exit 1; }
clang-format-14 --dry-run --Werror "${files[@]}"
