#!/bin/bash
# Tries Intel's OpenCL runtime for CPUs, a compiler of its own that runs on AMD's processors too: its packages are fetched from PyPI (pip, 0.8 GB
# unpacked), put into a folder beside the other drivers, and `clvr selftest` must give the golden bits on it. Nothing is installed.
# Usage: check_intel.sh [PROGRAM] [FOLDER]
#   PROGRAM  default build/release/clvr
#   FOLDER   where the runtime lies, fetched when absent (default ${XDG_CACHE_HOME:-~/.cache}/clvr-intel)
set -euo pipefail
program=$(realpath "${1:-$(dirname "$0")/../build/release/clvr}")
folder=${2:-${XDG_CACHE_HOME:-$HOME/.cache}/clvr-intel}
if [ ! -e "$folder/libintelocl.so" ]; then
    wheels=$(mktemp -d)
    trap 'rm -rf "$wheels"' EXIT
    python3 -m pip download -q -d "$wheels/packed" intel-opencl-rt intel-cmplr-lib-rt
    for wheel in "$wheels"/packed/*.whl; do python3 -m zipfile -e "$wheel" "$wheels/unpacked"; done
    mkdir -p "$folder"
    # Its compiler's built-in functions (.rtl, .o) and settings beside the libraries; not its libOpenCL, as the system has one.
    find "$wheels/unpacked" -type f \( -name '*.so*' -o -name '*.rtl' -o -name '*.o' -o -name cl.cfg \) ! -name 'libOpenCL.so*' -exec cp {} "$folder/" \;
    [ -e "$folder/libintelocl.so" ] || { echo "$0: the packages hold no libintelocl.so" >&2; exit 1; }
fi
mkdir -p "$folder/vendors"
echo "$folder/libintelocl.so" >"$folder/vendors/intel.icd"
export LD_LIBRARY_PATH=$folder${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} OCL_ICD_VENDORS=$folder/vendors
"$program" devices
"$program" selftest --device intel
