#!/usr/bin/env bash
# Installs the packages into a clean Debian 12 and tries them: packaging/try_packages.sh FOLDER
#
# FOLDER has the .deb files (build/package). Needs root, mmdebstrap and the net. Prints what it tries, and ends with
# status 1 at the first thing that does not work.
set -euo pipefail
folder=$(realpath "$1")
root=$(mktemp -d)
trap 'umount -q "$root/proc" || true; rm -rf "$root"' EXIT
say() { printf '== %s\n' "$*"; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
files() { (cd "$root" && find usr etc var/lib/dpkg/info -not -name '*.pyc' -not -path '*/__pycache__*' | sort); }

say "a clean Debian 12"
mmdebstrap --quiet --variant=apt --mode=root bookworm "$root"
mount -t proc proc "$root/proc"
inside apt-get -qq update
inside apt-get -qq install -y --no-install-recommends man-db bash-completion gcc libc6-dev shared-mime-info libglib2.0-bin > /dev/null

mkdir "$root/debs"
cp "$folder"/*.deb "$root/debs"
say "apt install"
inside sh -c 'apt-get install -y --no-install-recommends libgl1-mesa-dri /debs/*.deb > /dev/null'
files > "$root/with"

dem=/usr/share/relevo/data/dem/jacksboro.tif
say "a picture"
inside relevo capture $dem -o /tmp/picture.png --size 320x256 --time 2026-06-21T20:00Z
inside test -s /tmp/picture.png
say "hours of sun"
inside relevo -q sun hours $dem --date 2026-06-21 -o /tmp/hours.tif
say "a program and a plugin against the headers"
inside sh -c 'cp -r /usr/share/doc/librelevo-dev/examples/library /tmp && gcc -std=c99 /tmp/library/picture.c -o /tmp/drawer -lrelevo && /tmp/drawer '$dem' 2026-06-21T20:00Z /tmp/picture.ppm && test -s /tmp/picture.ppm'
inside sh -c 'echo "#include <relevo/plugin.h>
RELEVO_PLUGIN_EXPORT const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;
relevo_status relevo_plugin_register(const relevo_host* host, relevo_module* module) { (void)host; module->id = \"quiet\"; return RELEVO_OK; }" > /tmp/quiet.c && gcc -shared -fPIC /tmp/quiet.c -o /tmp/quiet.so'
say "Python"
inside python3 -c "import relevo; print(relevo.open('$dem').capture(size=(64, 48)).shape)"
say "man relevo"
inside sh -c 'man relevo-sun-hours | grep -q "Hours of direct sun"'
say "completion"
inside bash -c 'source /usr/share/bash-completion/bash_completion; _completion_loader relevo; compopt() { :; }
    for line in "relevo capture --en" "relevo capture --enable sh"; do
        COMP_WORDS=($line); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMPREPLY=(); _relevo; echo "$line<TAB>: ${COMPREPLY[*]}"
    done' | tee "$root/completed"
grep -q -- 'sh<TAB>: shadows' "$root/completed"
say "a thumbnail, as file managers make them"
inside sh -c 'printf "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3\n2 3 4\n3 4 9\n" > "/tmp/a grid.asc"
    gio info -a standard::content-type "/tmp/a grid.asc" | grep -q x-esri-ascii-grid
    line=$(sed -n "s/^Exec=//p" /usr/share/thumbnailers/org.relevo.Relevo.thumbnailer)
    $(printf "%s" "$line" | sed "s#%s#128#; s#%u#file:///tmp/a%20grid.asc#; s#%o#/tmp/thumbnail.png#") && test -s /tmp/thumbnail.png'

say "removed again"
read -ra packages <<< "$(inside dpkg-query -W -f '${Package} ' '*relevo*')"
inside apt-get purge -y "${packages[@]}" > /dev/null
files > "$root/without"
left=$(grep -i relevo "$root/without" || true)
[ -z "$left" ] || { say "left: $left"; exit 1; }
say "all works"
