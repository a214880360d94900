#!/bin/bash
# From nothing to a picture: installs what is missing, builds clvr, renders a head that clvr computes itself. Usage: tools/demo.sh [OPTION of clvr render...]
set -euo pipefail
cd "$(dirname "$0")/.."
tools/install_packages.sh build
cmake --preset release -DCLVR_TESTS=OFF -DCMAKE_UNITY_BUILD=ON -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF # another compiler may warn of more
cmake --build --preset release
build/release/clvr render demo:head --spp 8 --denoise -o head.png "$@"
echo "The picture is $PWD/head.png. For a volume of your own: $PWD/build/release/clvr render VOLUME -o OUT.png"
