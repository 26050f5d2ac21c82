#!/bin/sh
# Configures the build without OpenFOAM and LIGGGHTS, looks for their libraries in what it links, and builds and runs one small test of it.
# usage: cmake/check_without_solver.sh FOLDER
set -eu
[ $# -eq 1 ] || { echo "usage: $0 FOLDER" >&2; exit 2; }
source=$(cd "$(dirname "$0")/.." && pwd)
cmake -S "$source" -B "$1" -G Ninja -DCUTTERFLOW_WITH_SOLVER=OFF
if grep -E 'lib(OpenFOAM|finiteVolume|Pstream|liggghts|mpi(_cxx)?)\.so' "$1/build.ninja"; then
    echo "$0: these lines link OpenFOAM, LIGGGHTS or MPI. With CUTTERFLOW_WITH_SOLVER=OFF nothing does. Move the target behind the option." >&2
    exit 4
fi
ninja -C "$1" test_physics
"$1/tests/test_physics" --gtest_brief=1
