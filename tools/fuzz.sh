#!/bin/bash
# Runs the readers under libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer, as many at once as there are cores. The last lines say
# what each did; exit code 1 where there is a finding. Usage: tools/fuzz.sh [SECONDS] [TARGET...]
#   SECONDS   for each target (default 600)
#   TARGET    readers by name (default: all)
# Below build/fuzz/run: corpus/TARGET (begun from the tests' samples, kept for the next run), TARGET.log, findings/TARGET. To see a finding again:
# build/fuzz/run/fuzz_TARGET build/fuzz/run/findings/TARGET/crash-...
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-600}
[[ $seconds =~ ^[1-9][0-9]*$ ]] || { echo "usage: tools/fuzz.sh [SECONDS] [TARGET...]" >&2; exit 2; }
shift || true

compiler=()
command -v clang++-14 >/dev/null || compiler=(-DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++)
cmake --preset fuzz -DCMAKE_UNITY_BUILD=ON "${compiler[@]}" >/dev/null
cmake --build --preset fuzz

run=$PWD/build/fuzz/run
program=$PWD/build/fuzz/tests/fuzz/clvr_fuzz
TMPDIR=$(mktemp -d -p /dev/shm clvr-fuzz-XXXXXX) # the readers take files: in memory
trap 'rm -rf "$TMPDIR"' EXIT
export TMPDIR run seconds
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
mapfile -t all < <("$program" --targets)
[ $# -gt 0 ] || set -- "${all[@]}"
mkdir -p "$run/samples" "$run/findings"
build/fuzz/tests/fuzz/clvr_fuzz_corpus "$run/samples"

fuzz() {
    local target=$1
    ln -sf "$program" "$run/fuzz_$target"
    mkdir -p "$run/corpus/$target" "$run/findings/$target"
    # No reader needs 512 MiB at once for 32 KiB of input. 30 s, because on a busy machine a child may wait for 15 s.
    "$run/fuzz_$target" -max_total_time="$seconds" -max_len=32768 -rss_limit_mb=2048 -malloc_limit_mb=512 -timeout=30 -print_final_stats=1 \
        -dict="$run/samples/$target.dict" -artifact_prefix="$run/findings/$target/" "$run/corpus/$target" "$run/samples/$target" \
        >"$run/$target.log" 2>&1 || echo "$target" >>"$TMPDIR/found"
}
export -f fuzz
export program
printf '%s\n' "$@" | xargs -P "$(nproc)" -I{} bash -c 'fuzz {}'

for target in "$@"; do
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$run/$target.log")
    covered=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$run/$target.log" | tail -1)
    verdict="no finding"
    if grep -qxs "$target" "$TMPDIR/found"; then
        verdict=$(grep -m1 -aE 'SUMMARY|ERROR: libFuzzer|runtime error|what\(\)' "$run/$target.log" || echo "did not run: see $run/$target.log")
    fi
    printf '%-20s %10s inputs  %6s edges  %s\n' "$target" "${executions:-?}" "${covered:-?}" "$verdict"
done
[ ! -e "$TMPDIR/found" ]
