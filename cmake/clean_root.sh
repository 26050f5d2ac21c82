#!/bin/sh
# A bare Debian bookworm in a folder, and commands in it, for checks of what an installation needs. As root.
#   usage: cmake/clean_root.sh make ROOT          debootstrap, with the machine's own Debian sources
#          cmake/clean_root.sh run ROOT COMMAND   sh -c COMMAND in ROOT, with /proc, /sys, /dev and the machine's name servers; prints its processor time
set -eu
action=$1
root=$2
case $action in
    make)
        [ ! -e "$root" ] || { echo "clean_root: $root is there already; name a new folder" >&2; exit 2; }
        debootstrap --variant=minbase bookworm "$root" "${DEBIAN_MIRROR:-http://deb.debian.org/debian}" >"$root.log"
        rm -f "$root/etc/apt/sources.list"
        for list in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
            if [ -f "$list" ] && grep -q 'deb.*debian\.org\|bookworm-security' "$list"; then
                cp "$list" "$root/etc/apt/sources.list.d/"
            fi
        done
        ;;
    run)
        # Mounts of a namespace of its own: they end with the command.
        unshare --mount sh -eu -c '
            mount -t proc proc "$1/proc"
            mount --rbind /sys "$1/sys"
            mount --rbind /dev "$1/dev"
            mount --bind /etc/resolv.conf "$1/etc/resolv.conf" 2>/dev/null || cp /etc/resolv.conf "$1/etc/resolv.conf"
            exec chroot "$1" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
                DEBIAN_FRONTEND=noninteractive sh -eu -c "$2"' sh "$root" "$3"
        times >"$root.times"
        awk -F '[ms ]+' 'NR == 2 { printf "[%.1f s of processor time]\n", 60 * ($1 + $3) + $2 + $4 }' "$root.times"
        ;;
    *) echo "clean_root: unknown action $action" >&2; exit 2 ;;
esac
