#!/usr/bin/env bash
# Fuzzes readers of foreign bytes: docs/fuzzing.md. Usage: run.sh TARGET|all [SECONDS of each, default 60]
#
# Begins with tests/fuzz/corpus/TARGET and build/fuzz/found/TARGET, where new inputs go. Prints a row of the table of
# docs/fuzzing.md, and the lines that the inputs do not reach into build/fuzz/found/TARGET.missed. An input that is a
# finding becomes build/fuzz/found/TARGET.crash-..., and the target ends. A call that takes more than TIMEOUT_S of the
# environment (10 s of wall-clock time) is one: give more where other processes leave little processor time.
set -euo pipefail
cd "$(dirname "$0")/../.."
[ $# -ge 1 ] || { sed -n '2s/^# //p' "$0"; exit 2; }
seconds=${2:-60}
tools/install_packages.sh fuzz
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz >/dev/null
targets=$1
[ "$targets" != all ] || targets=$(sed -n 's/^relevo_fuzz(\([a-z_]*\) .*/\1/p' tests/fuzz/CMakeLists.txt)
# shellcheck disable=SC2086
cmake --build --preset fuzz --target $(printf 'fuzz_%s ' $targets) >build/fuzz/build.log ||
    { cat build/fuzz/build.log; exit 1; }

export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.txt:print_suppressions=0
# Freed memory is kept for 16 MiB only: it would count against the limit.
export ASAN_OPTIONS=quarantine_size_mb=16:detect_stack_use_after_return=0:allocator_may_return_null=1
export LLVM_PROFILE_FILE=/dev/null
[ -d /dev/shm ] && export TMPDIR=/dev/shm

# The words of a reader, as libFuzzer's dictionary has them.
words() {
    LC_ALL=C grep -ohE '"[]!#$&-[^-z|~]{2,40}"' "$@" | grep -v '[.]h"$' | sort -u
}

# Inputs that reach what all of them reach, as few and as short as can be.
minimise() {
    local corpus=$1 target=$2 new=$found/$2.new
    rm -rf "$new"
    mkdir "$new"
    # shellcheck disable=SC2086
    "build/fuzz/bin/fuzz_$target" $options -set_cover_merge=1 -use_counters=0 "$new" "$corpus" "$found/$target" \
        >"$found/$target.merge" 2>&1
    rm -rf "$corpus"
    mv "$new" "$corpus"
}

# Prints the percentage of lines of the reader's own files that the corpus reaches.
coverage() {
    local corpus=$1 target=$2 raw=$found/$2.profraw
    # shellcheck disable=SC2086
    LLVM_PROFILE_FILE=$raw "build/fuzz/bin/fuzz_$target" -runs=0 $options "$corpus" >/dev/null 2>&1
    llvm-profdata-16 merge -sparse "$raw" -o "$found/$target.profdata"
    rm "$raw"
    # shellcheck disable=SC2086
    llvm-cov-16 show "build/fuzz/bin/fuzz_$target" -instr-profile "$found/$target.profdata" $readers \
        | awk -v file="$PWD/$readers:" '/^\/.*:$/ { file = $0 } /^ *[0-9]+\| +0\|/ { print file $0 }' >"$found/$target.missed"
    # shellcheck disable=SC2086
    llvm-cov-16 report "build/fuzz/bin/fuzz_$target" -instr-profile "$found/$target.profdata" $readers \
        | awk '$1 == "TOTAL" { print $10 }'
}

found=build/fuzz/found
status=0
printf '| %-12s | %10s | %6s | %6s | %8s | %8s |\n' target executions edges inputs lines findings
for target in $targets; do
    # shellcheck disable=SC1090
    . "build/fuzz/tests/fuzz/$target.sh"
    options="-timeout=${TIMEOUT_S:-10} -malloc_limit_mb=272 -rss_limit_mb=448 -max_len=65536 $options"
    corpus=tests/fuzz/corpus/$target
    mkdir -p "$corpus" "$found/$target"
    # shellcheck disable=SC2086
    words $readers >"$found/$target.dict"
    log=$found/$target.log
    # shellcheck disable=SC2086
    nice -n 19 "build/fuzz/bin/fuzz_$target" $options -dict="$found/$target.dict" -max_total_time="$seconds" \
        -artifact_prefix="$found/$target." -print_final_stats=1 -reload=0 "$found/$target" "$corpus" >"$log" 2>&1 || status=1
    minimise "$corpus" "$target"
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    edges=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)
    findings=$(find "$found" -maxdepth 1 -name "$target.crash-*" -o -maxdepth 1 -name "$target.leak-*" \
        -o -maxdepth 1 -name "$target.oom-*" -o -maxdepth 1 -name "$target.timeout-*" | wc -l)
    printf '| %-12s | %10s | %6s | %6s | %8s | %8s |\n' "$target" "${executions:-?}" "$edges" \
        "$(find "$corpus" -type f | wc -l)" "$(coverage "$corpus" "$target")" "$findings"
done
exit $status
