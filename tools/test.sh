#!/bin/bash
# Installs what is missing, builds everything and runs every test. The last lines are ctest's summary. Usage: tools/test.sh [OPTION of ctest...]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_packages.sh test
cmake --preset release -DCLVR_TESTS=ON
cmake --build --preset release
ctest --preset release -j "$(nproc)" "$@"
