#!/usr/bin/env bash
# Installs the packages of tools/packages.txt that are missing. Usage: install_packages.sh [test|fuzz|--list]
# --list prints them instead.
set -euo pipefail
list=$(dirname "$0")/packages.txt
wanted=$(sed -n "s/^\(${1:-} \)\{0,1\}\([a-z0-9][^ ]*\)$/\2/p" "$list")
missing=$(for package in $wanted; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || echo "$package"
done)
[ -z "$missing" ] && exit 0
[ "${1:-}" = --list ] && { echo $missing; exit 0; }
sudo=
[ "$(id -u)" = 0 ] || sudo=sudo
echo "Installing:" $missing
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -qq
# shellcheck disable=SC2086
$sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
