#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds Relevo for development and runs every test.
set -euo pipefail
cd "$(dirname "$0")"
tools/install_packages.sh test
[ -f build/dev/build.ninja ] || cmake --preset dev >/dev/null
cmake --build --preset dev
ctest --preset dev -j "$(nproc)" "$@"
