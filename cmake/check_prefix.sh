#!/bin/sh
# An installation may stand anywhere and be moved: installs into a folder, moves it, and uses what is there.
#   usage: cmake/check_prefix.sh BUILD CMAKE
set -eu
build=$1
cmake=$2

fail() {
    echo "check_prefix: $1" >&2
    exit 1
}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
DESTDIR='' "$cmake" --install "$build" --prefix "$folder/first" >"$folder/install.log" || { cat "$folder/install.log"; fail "the installation failed"; }
mv "$folder/first" "$folder/moved here"
prefix="$folder/moved here"
program="$prefix/bin/cutterflow"
cd "$folder"

"$program" --version | grep -q '^CGAL  *[0-9]' || fail "--version names no CGAL"
readme="$prefix/share/cutterflow/validation/cases/closures/README.md"
sed -i '1s/.*/# The title of the moved copy/' "$readme"
"$program" verify --list | grep -q 'The title of the moved copy' || fail "verify --list reads other cases than those installed"
"$program" verify closures --fast -o verification >verify.log 2>&1 || { cat verify.log; fail "verify closures did not pass"; }
"$program" generate-cutter "$prefix/share/cutterflow/cases/examples/model_cutter/crown.toml" -o crown.stl || fail "the example's crown could not be made"
cp -r "$prefix/share/cutterflow/cases/examples/rock_in_a_box" example
sed -i 's/^endTime .*/endTime 0.02;/' example/system/controlDict  # test_examples runs it to its end
env -u WM_PROJECT_DIR PATH="$prefix/bin:$PATH" example/Allrun >example.log 2>&1 || { cat example.log example/log.*; fail "the example rock_in_a_box did not run"; }
code=0
"$program" verify --publish -o verification >publish.log 2>&1 || code=$?
[ $code -eq 2 ] || fail "verify --publish ended with $code: an installation keeps no results"
[ -f "$prefix/share/doc/cutterflow/docs/user/study_file.md" ] || fail "the user's pages are not in share/doc"

# Nobody's name for the machine's folders: what is installed names neither the source tree nor the build.
source_folder=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")
if grep -rlF "$source_folder/share" "$prefix" || grep -rlF "$source_folder/validation" "$prefix" || grep -rlF "$source_folder/docs" "$prefix"; then
    fail "these files name the source tree"
fi
echo "installed, moved and used"
