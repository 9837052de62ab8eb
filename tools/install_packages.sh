#!/usr/bin/env bash
# Installs the packages of tools/packages.txt that are missing. Usage: install_packages.sh [test]
set -euo pipefail
list=$(dirname "$0")/packages.txt
wanted=$(sed -n 's/^\([a-z0-9].*\)$/\1/p' "$list" | { [ "${1:-}" = test ] && sed 's/^test //' || grep -v '^test '; })
missing=$(for package in $wanted; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || echo "$package"
done)
[ -z "$missing" ] && exit 0
sudo=
[ "$(id -u)" = 0 ] || sudo=sudo
echo "Installing:" $missing
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -qq
# shellcheck disable=SC2086
$sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
