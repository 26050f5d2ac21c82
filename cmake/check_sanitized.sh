#!/bin/sh
# Builds everything without OpenFOAM and LIGGGHTS under AddressSanitizer and UndefinedBehaviorSanitizer, runs the unit tests and the fuzzer.
# usage: cmake/check_sanitized.sh FOLDER [INPUTS]    build folder; inputs of the fuzzer, 100000 by default
set -eu
[ $# -ge 1 ] && [ $# -le 2 ] || { echo "usage: $0 FOLDER [INPUTS]" >&2; exit 2; }
build=$1
inputs=${2:-100000}
source=$(cd "$(dirname "$0")/.." && pwd)
[ ! -e "$build/fuzz_findings" ] || { echo "$0: $build/fuzz_findings is there. Findings are not overwritten. Move it away." >&2; exit 2; }
cmake -S "$source" -B "$build" -G Ninja -DCUTTERFLOW_WITH_SOLVER=OFF -DCUTTERFLOW_SANITIZE=ON
ninja -C "$build"
ASAN_OPTIONS=detect_leaks=0 ctest --test-dir "$build" -L unit -E 'fuzz_short' --output-on-failure
"$build/fuzz/fuzz" --inputs "$inputs" -o "$build/fuzz_findings"
