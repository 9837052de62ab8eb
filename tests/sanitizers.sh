#!/usr/bin/env bash
# The tests under the address, undefined-behaviour and thread sanitizers.
#
# sanitizers.sh           every test: builds the presets asan and tsan as a whole (an hour on two cores)
# sanitizers.sh reduced   the program alone, driven by the tests of build/dev that tests/sanitized_tests.txt names
# sanitizers.sh small     readers of foreign bytes (dem, and the corpora of tests/fuzz) by the first two, the pool of threads
#                         and files (base) by all three; what .ci/run begins with
set -euo pipefail
cd "$(dirname "$0")/.."
source tools/phases.sh
export TSAN_OPTIONS=${TSAN_OPTIONS:-suppressions=$PWD/tests/tsan.txt}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/lsan.txt:print_suppressions=0}

# What the build itself runs (minutes under a sanitizer) is taken from the build of test.sh where there is one.
makers=()
[ -x build/dev/bin/relevo_make_ground ] && makers=(-DRELEVO_HOST_TOOLS="$PWD/build/dev/bin")

# In: preset, targets.
build() {
    [ -f "build/$1/build.ninja" ] || cmake --preset "$1" >/dev/null || return
    cmake --build --preset "$1" --target "${@:2}"
}

# In: asan or tsan. Tests of programs that are not built are not run.
run_small() {
    local layers=(base) targets=(test_base)
    if [ "$1" = asan ]; then
        layers+=(dem)
        targets+=(test_dem)
        if [ -f tests/fuzz/CMakeLists.txt ]; then
            layers+=(fuzz)
            targets+=(fuzz_replays)  # programs that read their corpora, each as the test fuzz.<target>
        fi
    fi
    phase "sanitizers: build" build "$1-small" "${targets[@]}"
    phase "sanitizers: run" ctest --preset "$1-small" -j "$(nproc)" --no-tests=error \
        -R "^($(IFS='|'; echo "${layers[*]}"))[.]"
}

for preset in asan tsan; do
    if [ "${1:-}" = small ]; then
        run_small $preset
        continue
    fi
    [ -f build/$preset/build.ninja ] || cmake --preset $preset "${makers[@]}" >/dev/null
    if [ "${1:-}" = reduced ]; then
        cmake --build --preset $preset --target relevo_program
        RELEVO_PROGRAM=$PWD/build/$preset/bin/relevo RELEVO_SHARE=$PWD/build/dev/share/relevo \
            build/dev/bin/test_cli --gtest_brief=1 \
            --gtest_filter="$(sed '/^#/d; /^$/d' tests/sanitized_tests.txt | paste -sd:)"
    else
        cmake --build --preset $preset
        ctest --preset $preset --no-tests=error
    fi
done
