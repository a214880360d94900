# Sourced by check_package.sh and check_fresh.sh: bare Debian systems in folders. Needs root, debootstrap and the network.

# make_debian SUITE FOLDER: the smallest Debian, unless it is there already (a minute, 200 MB).
make_debian() {
    [ -x "$2/usr/bin/apt-get" ] || debootstrap --variant=minbase "$1" "$2" http://deb.debian.org/debian >"$2.log" 2>&1 || { tail "$2.log"; return 1; }
}

# inside FOLDER COMMAND...: runs it there as root. PoCL finds no device without /proc and /sys; a mount namespace of our own, so nothing stays mounted.
inside() {
    unshare --mount bash -c 'for d in proc sys dev; do mount --bind /$d "$0/$d" || exit 1; done; exec chroot "$0" /usr/bin/env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root "$@"' "$@"
}

# install_inside FOLDER PACKAGE...: by apt-get, with no more than they need.
install_inside() {
    inside "$1" sh -c 'apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$@"' sh "${@:2}" >"$1.log" 2>&1 ||
        { tail "$1.log"; return 1; }
}

# is_png FILE
is_png() { [ "$(head -c 4 "$1" | tail -c 3)" == PNG ]; }
