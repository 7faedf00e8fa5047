#!/bin/bash
# Installs the packages of a folder in a clean Debian 12, renders a report with each, serves one, removes them, and fails
# if anything is left but the data. As root. SHEER_MIRROR names a mirror of Debian, SHEER_ROOT a root made before.
set -euo pipefail
packages=$(realpath "$1")
root=${SHEER_ROOT:-$(mktemp -d)}
service=
# Apt downloads as a user of its own.
chmod 755 "$root"

clean_up() {
    if [[ $service ]]; then kill "$service" 2>/dev/null || true; fi
    umount "$root/proc" 2>/dev/null || true
    if [[ ! ${SHEER_ROOT:-} ]]; then rm -rf --one-file-system "$root"; fi
}
trap clean_up EXIT

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp LC_ALL=C.UTF-8 "$@"; }
as_nobody() { inside setpriv --reuid 65534 --regid 65534 --clear-groups "$@"; }
# Files that only belong to a package's being installed, not to the package.
files_of() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./tmp -o -path ./var/log -o -path ./var/cache -o -path ./var/lib/dpkg -o -path ./var/lib/apt \) -prune -o -print | sort); }

if [[ ! -e $root/bin/sh ]]; then
    debootstrap --variant=minbase --include=ca-certificates,curl bookworm "$root" "${SHEER_MIRROR:-http://deb.debian.org/debian}" >/dev/null
fi
mount -t proc proc "$root/proc"
cp "$packages"/*.deb "$root/tmp"
if [[ -e /etc/resolv.conf ]]; then cp /etc/resolv.conf "$root/etc/resolv.conf"; fi
inside apt-get -qq update >/dev/null

# What the packages need comes first, so that only they differ below.
needed=$(for deb in "$packages"/*.deb; do dpkg-deb -f "$deb" Depends; done | tr ',' '\n' | sed 's/(.*//; s/|.*//; s/ //g' | sort -u)
# shellcheck disable=SC2086  # a list of words
inside env DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o Dpkg::Use-Pty=0 --no-install-recommends install $needed >/dev/null
files_of >"$root/tmp/before"

inside sh -c 'DEBIAN_FRONTEND=noninteractive apt-get -qq -y -o Dpkg::Use-Pty=0 --no-install-recommends install /tmp/sheer_*.deb /tmp/sheer-bench_*.deb' >/dev/null
# shellcheck disable=SC2016  # dpkg-query expands it
echo "installed: $(inside dpkg-query -W -f '${Package} ${Version}, ${Installed-Size} KiB; ' sheer sheer-bench)"
inside test -s /usr/share/man/man1/sheer.1.gz
inside test -s /usr/share/bash-completion/completions/sheer
inside install -d -o 65534 -g 65534 /var/lib/sheer /tmp/out
as_nobody sheer compare /usr/share/sheer/configs/specs/layers.json -q --out /tmp/out
inside test -s /tmp/out/report.html
as_nobody sheer-bench /usr/share/sheer/configs/specs/layers.json >/dev/null
echo "rendered a report with sheer and one with sheer-bench"

chroot "$root" setpriv --reuid 65534 --regid 65534 --clear-groups env -i PATH=/usr/bin:/bin HOME=/tmp \
    sheer serve --config /etc/sheer/server.json --listen 127.0.0.1:0 --data /var/lib/sheer >"$root/tmp/listens" 2>"$root/tmp/log" &
service=$!
url=
for ((tenths = 0; tenths < 300 && ${#url} == 0; ++tenths)); do
    sleep 0.1
    url=$(sed -n 's/^Sheer listens on //p' "$root/tmp/listens")
done
status=$(inside curl -s --noproxy '*' --json @/usr/share/sheer/configs/specs/layers.json -H 'Prefer: wait=120' \
    -o /tmp/report.json -w '%{http_code}' "$url/api/v1/reports")
[[ $status == 200 ]] || { cat "$root/tmp/log" >&2 && exit 1; }
grep -q '"status":"done"' "$root/tmp/report.json"
kill "$service" && wait "$service"
service=
echo "the service rendered a report"

inside apt-get -qq -y -o Dpkg::Use-Pty=0 purge sheer sheer-bench >/dev/null
files_of >"$root/tmp/after"
left=$(diff "$root/tmp/before" "$root/tmp/after" | sed -n 's/^> //p' | grep -v '^./var/lib/sheer' || true)
[[ ! $left ]] || { echo "left after removal: $left" >&2 && exit 1; }
inside test -s /var/lib/sheer/archive.sqlite
echo "removed; only the data in /var/lib/sheer is left"
