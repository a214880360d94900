#!/bin/bash
# Installs the Debian packages that are missing (Debian 12 or newer). Usage: install_packages.sh [build|test]
#   build   what the program needs to be built and to run (default)
#   test    the same, and what the tests and lints need
# Asks the network only when something is missing; uses sudo when not root.
set -euo pipefail

build=(build-essential cmake ninja-build
    ocl-icd-opencl-dev opencl-clhpp-headers pocl-opencl-icd           # OpenCL, and a device that every machine has
    libgdcm-dev libtiff-dev libhdf5-dev libpugixml-dev                # volume files
    zlib1g-dev libbz2-dev liblz4-dev libdeflate-dev libminizip-dev    # what they are packed with
    libopenexr-dev libpng-dev libturbojpeg0-dev                       # pictures
    libtbb-dev                                                        # work on all cores
    libclblast-dev                                                    # matrix products in training
    libcurl4-openssl-dev libboost-dev                                 # downloads; the server of clvr view (headers alone)
    libcli11-dev nlohmann-json3-dev libfmt-dev libspdlog-dev libssl-dev) # command line, JSON, text, checksums
test=(libgtest-dev libgmock-dev 'clang-14|clang' 'libclang-rt-14-dev|libclang-rt-dev' 'clang-format-14|' gcovr 'oclgrind|' mesa-opencl-icd 'chromium|') # A|B: A, else B; A|: A where there is one

case ${1:-build} in
    build) wanted=("${build[@]}") ;;
    test) wanted=("${build[@]}" "${test[@]}") ;;
    *) echo "usage: $0 [build|test]" >&2; exit 2 ;;
esac

command -v dpkg-query >/dev/null || { echo "$0: no dpkg here; install by hand what corresponds to: ${wanted[*]}" >&2; exit 1; }
installed=" $(dpkg-query -W -f '${db:Status-Status} ${Package} ' | sed 's/\binstalled //g') "
missing=()
for package in "${wanted[@]}"; do
    IFS='|' read -ra choices <<<"$package"
    for choice in "${choices[@]}"; do
        [[ $installed != *" $choice "* ]] || continue 2
    done
    missing+=("$package")
done
[ "${#missing[@]}" -gt 0 ] || exit 0

root=()
if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || { echo "$0: run as root: apt-get install ${missing[*]}" >&2; exit 1; }
    root=(sudo)
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() { "$@" >"$log" 2>&1 || { cat "$log" >&2; return 1; }; }
quietly "${root[@]}" apt-get update -q
chosen=()
for package in "${missing[@]}"; do
    IFS='|' read -ra choices <<<"$package"
    for choice in "${choices[@]}"; do
        apt-cache show "$choice" >/dev/null 2>&1 || continue
        chosen+=("$choice")
        continue 2
    done
    [[ $package == *'|' ]] || { echo "$0: this system has no package ${package//|/ or }" >&2; exit 1; }
done
[ "${#chosen[@]}" -gt 0 ] || exit 0
echo "installing ${#chosen[@]} packages: ${chosen[*]}"
quietly "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${chosen[@]}"
