#!/bin/bash
# Tries README's two commands on fresh Debian 12 and 13: the last commit, cloned into a copy of a bare system, built with g++ and with clang++. Needs
# root, debootstrap and the network.
# Usage: check_fresh.sh [SUITE:COMPILER...]
#   bookworm:g++ bookworm:clang++ trixie:g++ trixie:clang++   what is tried (default: all)
# The bare systems live in ${CLVR_DEBIAN:-/tmp/clvr-debian}-SUITE: made when absent, never changed. The copy in use has .used after it. tools/test.sh runs
# with g++ only, Debian's own compiler; with clang++ only the picture is made, which must have the same bits.
set -euo pipefail
source "$(dirname "$0")/bare_debian.sh"
repository=$(cd "$(dirname "$0")/.." && pwd)
[ $# -gt 0 ] || set -- bookworm:g++ bookworm:clang++ trixie:g++ trixie:clang++

first=
for try in "$@"; do
    suite=${try%%:*} compiler=${try#*:}
    debian=${CLVR_DEBIAN:-/tmp/clvr-debian}-$suite
    used=$debian.used
    make_debian "$suite" "$debian"
    rm -rf "$used"
    cp -a "$debian" "$used"
    git clone -q "$repository" "$used/root/clvr"
    [ "$compiler" == g++ ] || install_inside "$used" clang

    SECONDS=0
    inside "$used" CXX="$compiler" bash /root/clvr/tools/demo.sh
    is_png "$used/root/clvr/head.png" || { echo "no picture"; exit 1; }
    echo "== $try: tools/demo.sh: $SECONDS s from nothing to $used/root/clvr/head.png"
    sum=$(sha256sum <"$used/root/clvr/head.png")
    [ "$sum" == "${first:=$sum}" ] || { echo "$try: another picture than that of $1"; exit 1; }
    [ "$compiler" == g++ ] || continue
    SECONDS=0
    inside "$used" bash /root/clvr/tools/test.sh
    echo "== $try: tools/test.sh: $SECONDS s"
done
