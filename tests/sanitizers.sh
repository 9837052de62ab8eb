#!/usr/bin/env bash
# The tests under the address, undefined-behaviour and thread sanitizers.
#
# sanitizers.sh           every test: builds the presets asan and tsan as a whole (an hour on two cores)
# sanitizers.sh reduced   the program alone, driven by the tests of build/dev that tests/sanitized_tests.txt names
# sanitizers.sh small     the pool of threads and files (base) by all three, and what reads foreign bytes (dem) by the first two
set -euo pipefail
cd "$(dirname "$0")/.."
export TSAN_OPTIONS=${TSAN_OPTIONS:-suppressions=$PWD/tests/tsan.txt}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/lsan.txt:print_suppressions=0}

# What the build itself runs (minutes under a sanitizer) is taken from the build of test.sh where there is one.
makers=()
[ -x build/dev/bin/relevo_make_ground ] && makers=(-DRELEVO_HOST_TOOLS="$PWD/build/dev/bin")

for preset in asan tsan; do
    [ -f build/$preset/build.ninja ] || cmake --preset $preset "${makers[@]}" >/dev/null
    if [ "${1:-}" = reduced ]; then
        cmake --build --preset $preset --target relevo_program
        RELEVO_PROGRAM=$PWD/build/$preset/bin/relevo RELEVO_SHARE=$PWD/build/dev/share/relevo \
            build/dev/bin/test_cli --gtest_brief=1 \
            --gtest_filter="$(sed '/^#/d; /^$/d' tests/sanitized_tests.txt | paste -sd:)"
    elif [ "${1:-}" = small ]; then
        layers=(base)
        [ $preset = asan ] && layers+=(dem)
        cmake --build --preset $preset --target "${layers[@]/#/test_}"
        ctest --preset $preset -j "$(nproc)" --no-tests=error -R "^($(IFS='|'; echo "${layers[*]}"))[.]"
    else
        cmake --build --preset $preset
        ctest --preset $preset --no-tests=error
    fi
done
