#!/bin/bash
# Tries the tarball where nothing else is: a bare Debian 13 with PoCL as its only further package. Needs root, debootstrap and the network.
# Usage: check_package.sh TARBALL [FOLDER]
#   TARBALL  what `cpack` or `cmake --workflow --preset release` wrote
#   FOLDER   where the Debian 13 lives (default /tmp/clvr-debian-13); made when absent (a minute, 1 GB), kept for the next time
# Checks that every library is found there, that `clvr devices` sees PoCL, and that `clvr render demo:head` writes the picture that it writes here.
set -euo pipefail
source "$(dirname "$0")/bare_debian.sh"
tarball=$(realpath "$1")
debian=${2:-/tmp/clvr-debian-13}

make_debian trixie "$debian"
inside "$debian" dpkg-query -W pocl-opencl-icd >/dev/null 2>&1 ||
    inside "$debian" sh -c 'apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends pocl-opencl-icd' >"$debian.log" 2>&1 ||
    { tail "$debian.log"; exit 1; }

rm -rf "$debian/opt/clvr" "$debian"/root/head*.png
mkdir -p "$debian/opt/clvr"
tar -xzf "$tarball" -C "$debian/opt/clvr" --strip-components=1
inside "$debian" sh -c 'if ldd /opt/clvr/bin/clvr | grep "not found"; then exit 1; fi'
inside "$debian" /opt/clvr/bin/clvr devices
render=(render demo:head --spp 4 --size 160x160)
inside "$debian" /opt/clvr/bin/clvr "${render[@]}" -o /root/head.png
"$debian/opt/clvr/bin/clvr" "${render[@]}" -o "$debian/root/head_here.png"
cmp "$debian/root/head.png" "$debian/root/head_here.png"
is_png "$debian/root/head.png" || { echo "no picture"; exit 1; }
echo "$(basename "$tarball") ($(($(stat -c %s "$tarball") / 1000000)) MB) runs on Debian $(cat "$debian/etc/debian_version")"
