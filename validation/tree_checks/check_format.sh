#!/bin/sh
# Every tracked source is formatted as .clang-format says. 77: cannot be checked here.
#   usage: check_format.sh ROOT
set -eu
cd "$1"
command -v clang-format-14 >/dev/null || { echo "clang-format-14 is not installed (Debian package clang-format-14)"; exit 77; }
git rev-parse --is-inside-work-tree >/dev/null 2>&1 || { echo "$1 is no clone of the repository"; exit 77; }
git ls-files -z -- '*.cpp' '*.hpp' | xargs -0 clang-format-14 --dry-run --Werror
echo "formatted: $(git ls-files -- '*.cpp' '*.hpp' | wc -l) sources"
