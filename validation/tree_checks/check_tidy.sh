#!/bin/sh
# clang-tidy over the folders that every other one uses and that compile fast. 77: cannot be checked here.
#   usage: check_tidy.sh ROOT BUILD
set -eu
cd "$1"
command -v clang-tidy-14 >/dev/null || { echo "clang-tidy-14 is not installed (Debian package clang-tidy-14)"; exit 77; }
# -w: warnings of the compiler are g++'s matter; clang's own -Wshadow differs.
find geometry/base solver/physics solver/ports -name '*.cpp' -not -path '*/tests/*' -print0 |
    xargs -0 -P 2 -n 4 clang-tidy-14 --quiet --extra-arg=-w -p "$2"
