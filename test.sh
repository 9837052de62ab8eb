#!/usr/bin/env bash
# Installs what is missing (Debian 12), builds Relevo for development and runs every test.
set -euo pipefail
cd "$(dirname "$0")"
source tools/phases.sh
tools/install_packages.sh test
configure_and_build() {
    [ -f build/dev/build.ninja ] || cmake --preset dev >/dev/null || return
    cmake --build --preset dev
}
phase "build" configure_and_build
phase "tests" ctest --preset dev -j "$(nproc)" "$@"
