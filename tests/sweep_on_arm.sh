#!/usr/bin/env bash
# Builds core/light/sweep for 64-bit ARM on Debian 12 for x86-64, and runs its tests in an emulator: they have hashes of what
# sweeps find on x86-64. Usage: sweep_on_arm.sh [--install]. With --install it first installs the packages that are missing.
#
# Sweeps are compiled for ARM's vectors of 4 floats (NEON); a second build has no vectors.
set -euo pipefail
cd "$(dirname "$0")/.."

packages="cmake ninja-build libglm-dev g++-aarch64-linux-gnu qemu-user libhwy-dev:arm64 libgtest-dev:arm64"
missing=$(for package in $packages; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || echo "$package"
done)
if [ -n "$missing" ] && [ "${1:-}" != --install ]; then
    echo "sweep_on_arm: packages are missing:" $missing >&2
    echo "tests/sweep_on_arm.sh --install adds the architecture arm64 to dpkg and installs them." >&2
    exit 1
fi
if [ -n "$missing" ]; then
    sudo=
    [ "$(id -u)" = 0 ] || sudo=sudo
    echo "Installing:" $missing
    export DEBIAN_FRONTEND=noninteractive
    $sudo dpkg --add-architecture arm64
    $sudo apt-get update -qq
    # shellcheck disable=SC2086
    $sudo apt-get install -y -qq --no-install-recommends --no-remove $missing >/dev/null
fi

for vectors in neon none; do
    flags=
    [ $vectors = neon ] || flags=-DHWY_COMPILE_ONLY_SCALAR
    cmake -S tests/sweep_on_arm -B build/arm_$vectors -G Ninja -DCMAKE_SYSTEM_NAME=Linux \
        -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_CXX_FLAGS=$flags >/dev/null
    cmake --build build/arm_$vectors
    echo "ARM, vectors: $vectors"
    qemu-aarch64 build/arm_$vectors/test_sweep_on_arm
done
