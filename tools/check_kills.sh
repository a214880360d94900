#!/bin/bash
# Kills render, pairs, train and downloads at random moments, the same ones in every run: nothing half-written may have a final name, and the
# next run begins cleanly or continues. Usage: check_kills.sh [KILLS] [FOLDER]
#   KILLS   in all, a quarter each (default 200)
#   FOLDER  with the built tests (default build/release, made by `cmake --preset release -DCLVR_TESTS=ON`)
set -euo pipefail
cd "$(dirname "$0")/.."
kills=${1:-200}
build=${2:-build/release}
export CLVR_KILLS=$(((kills + 3) / 4))
cmake --build "$build" --target test_cli_slow test_dataset_slow clvr
"$build/tests/test_cli_slow" --gtest_filter='Kills.*'
"$build/tests/test_dataset_slow" --gtest_filter='DownloadKills.*'
