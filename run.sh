#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds Relevo and takes a first picture. Run it again at any time:
# it does no needless work.
set -euo pipefail
cd "$(dirname "$0")"
tools/install_packages.sh
[ -f build/release/build.ninja ] || cmake --preset release >/dev/null
cmake --build --preset release --target relevo_program
relevo=build/release/bin/relevo
picture=build/first-picture.png
$relevo -q capture build/release/share/relevo/data/dem/jacksboro.tif -o $picture --overwrite
cat <<EOT

The Cumberland Mountains, Tennessee: $picture

Next, with a DEM of yours:
  $relevo info DEM.tif
  $relevo capture DEM.tif --time 2026-12-21T09:00 --tz Europe/Zurich -o picture.png
  $relevo sun position --at 46.95,7.45 --time 2026-06-21T12:00+02:00
  $relevo --help-all
EOT
