#!/bin/bash
# Tries a package where nothing else is: on bare Debian 12 and 13. Needs root, debootstrap and the network.
# Usage: check_package.sh PACKAGE...
#   PACKAGE  a tarball or a .deb that `cpack` or `cmake --workflow --preset release` wrote. A tarball gets PoCL as the only further package; a .deb is
#            installed by apt-get, which must find all that it needs.
# The bare systems live in ${CLVR_DEBIAN:-/tmp/clvr-debian}-SUITE: made when absent (a minute, 200 MB), never changed. The copy in use has .used after it.
# Checks that every library is found there, that `clvr devices` sees PoCL, that manual page and completion are there, and that `clvr render demo:head`
# writes the same picture on all.
set -euo pipefail
source "$(dirname "$0")/bare_debian.sh"
[ $# -gt 0 ] || { echo "usage: $0 PACKAGE..." >&2; exit 2; }

first=
for package in "$@"; do
    package=$(realpath "$package")
    for suite in bookworm trixie; do
        debian=${CLVR_DEBIAN:-/tmp/clvr-debian}-$suite
        used=$debian.used
        make_debian "$suite" "$debian"
        rm -rf "$used"
        cp -a "$debian" "$used"
        if [[ $package == *.deb ]]; then
            prefix=/usr
            cp "$package" "$used/root/clvr.deb"
            install_inside "$used" /root/clvr.deb
        else
            prefix=/opt/clvr
            mkdir -p "$used/opt/clvr"
            tar -xzf "$package" -C "$used/opt/clvr" --strip-components=1
            install_inside "$used" pocl-opencl-icd
        fi
        inside "$used" sh -c "if ldd $prefix/bin/clvr $prefix/bin/clvr-bench | grep 'not found'; then exit 1; fi"
        inside "$used" "$prefix/bin/clvr" devices
        for file in man/man1/clvr.1 man/man1/clvr-render.1 bash-completion/completions/clvr zsh/vendor-completions/_clvr; do
            # A minimal Debian's dpkg may be told to leave manual pages out; then the package must have them at least.
            [ -s "$used$prefix/share/$file" ] || { [[ $package == *.deb ]] && dpkg-deb -c "$package" | grep -q "share/$file"; } ||
                { echo "no $file"; exit 1; }
        done
        inside "$used" "$prefix/bin/clvr" demo:head --spp 4 --size 160x160 # writes head.png where it runs, in /
        is_png "$used/head.png" || { echo "no picture"; exit 1; }
        sum=$(sha256sum <"$used/head.png")
        [ "$sum" == "${first:=$sum}" ] || { echo "another picture than on the first system"; exit 1; }
        echo "== $(basename "$package") ($(($(stat -c %s "$package") / 1000000)) MB) runs on Debian $(cat "$used/etc/debian_version")"
    done
done
