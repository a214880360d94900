#!/bin/bash
# Tries README's two commands on a fresh Debian 12: the last commit, cloned into a copy of a bare system. Needs root, debootstrap and the network.
# Usage: check_fresh.sh [FOLDER]
#   FOLDER   where the bare Debian 12 lives (default /tmp/clvr-debian-12); made when absent, never changed. The copy in use is FOLDER.used.
set -euo pipefail
source "$(dirname "$0")/bare_debian.sh"
repository=$(cd "$(dirname "$0")/.." && pwd)
debian=${1:-/tmp/clvr-debian-12}
used=$debian.used

make_debian bookworm "$debian"
rm -rf "$used"
cp -a "$debian" "$used"
git clone -q "$repository" "$used/root/clvr"

SECONDS=0
inside "$used" bash /root/clvr/tools/demo.sh
is_png "$used/root/clvr/head.png" || { echo "no picture"; exit 1; }
echo "== tools/demo.sh: $SECONDS s from nothing to $used/root/clvr/head.png"
SECONDS=0
inside "$used" bash /root/clvr/tools/test.sh
echo "== tools/test.sh: $SECONDS s"
