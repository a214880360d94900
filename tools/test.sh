#!/bin/bash
# Installs what is missing, builds everything, runs every reader under libFuzzer for a second and every test. The last lines are ctest's summary.
# Usage: tools/test.sh [OPTION of ctest...]; with options there is no fuzzing.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_packages.sh test
cmake --preset release -DCLVR_TESTS=ON -DCMAKE_UNITY_BUILD=ON # files compiled by eights: headers cost more than what includes them
cmake --build --preset release
[ $# -gt 0 ] || tools/fuzz.sh 1
ctest --preset release -j "$(nproc)" "$@"
