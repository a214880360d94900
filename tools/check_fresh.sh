#!/bin/bash
# Tries README's two commands on a fresh Debian 12: the last commit, cloned into a copy of a bare system. Needs root, debootstrap and the network.
# Usage: check_fresh.sh [FOLDER]
#   FOLDER   where the bare Debian 12 lives (default /tmp/clvr-debian-12); made when absent, never changed. The copy in use is FOLDER.used.
set -euo pipefail
cd "$(dirname "$0")/.."
debian=${1:-/tmp/clvr-debian-12}
used=$debian.used

[ -x "$debian/usr/bin/apt-get" ] || debootstrap --variant=minbase bookworm "$debian" http://deb.debian.org/debian >"$debian.log" 2>&1 || { tail "$debian.log"; exit 1; }
rm -rf "$used"
cp -a "$debian" "$used"
git clone -q . "$used/root/clvr"

# PoCL finds no device without /proc and /sys. A mount namespace of our own: nothing stays mounted.
inside() { unshare --mount bash -c 'mount --bind /proc "$0/proc" && mount --bind /sys "$0/sys" && mount --bind /dev "$0/dev" && exec chroot "$0" /usr/bin/env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root "$@"' "$used" "$@"; }
SECONDS=0
inside bash /root/clvr/tools/demo.sh
[ "$(head -c 4 "$used/root/clvr/head.png" | tail -c 3)" == PNG ] || { echo "no picture"; exit 1; }
echo "== tools/demo.sh: $SECONDS s from nothing to $used/root/clvr/head.png"
SECONDS=0
inside bash /root/clvr/tools/test.sh
echo "== tools/test.sh: $SECONDS s"
