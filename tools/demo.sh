#!/bin/bash
# From nothing to a picture: installs what is missing, builds clvr, renders a head that clvr computes itself. Usage: tools/demo.sh [OPTION of clvr render...]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_packages.sh build
[ -f build/demo/build.ninja ] || cmake -S . -B build/demo -G Ninja -DCMAKE_BUILD_TYPE=Release -DCLVR_TESTS=OFF
cmake --build build/demo
build/demo/clvr render demo:head -o head.png "$@"
echo "the picture is $PWD/head.png; for your own volume: $PWD/build/demo/clvr render VOLUME -o OUT.png"
