#!/bin/sh
# The Debian package in a clean root: installed with its dependencies, and a tiny study from `cutterflow new` to its report.
#   usage: cmake/check_package.sh PACKAGE.deb ROOT     as root; ROOT is a new folder, which is kept
# Prints the log that docs/results/package.md shows.
set -eu
package=$1
root=$2
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)

in_root() {
    printf '\n$ %s\n' "$1"
    "$here/clean_root.sh" run "$root" "$1" 2>&1
}

"$here/clean_root.sh" make "$root"
cp "$package" "$root/tmp/"
deb=/tmp/$(basename "$package")
in_root "dpkg -l | grep -c ^ii"
in_root "apt-get -q update >/tmp/update.log && apt-get -q -y --no-install-recommends install $deb >/tmp/install.log && tail -n 1 /tmp/install.log"
in_root "dpkg-deb -f $deb Package Version Architecture Depends"
in_root "useradd --create-home user"
as_user() { in_root "su user -c 'cd && $1'"; }
as_user "cutterflow --version"
as_user "cutterflow generate-cutter /usr/share/cutterflow/cases/examples/model_cutter/crown.toml -o head.stl"
as_user "cutterflow new --cutter head.stl --unit m study.toml"
# What a user edits: little rock, and a fiftieth of a revolution.
as_user 'sed -i -e "s/^flow_revolutions = .*/flow_revolutions = 0.01/" -e "s/^max_revolutions = .*/max_revolutions = 0.02/" -e "s/^count = .*/count = 20/" study.toml'
as_user "cutterflow check study.toml"
as_user "cutterflow run study.toml -o runs/tiny"
as_user "ls runs/tiny/report && cutterflow verify closures --fast -o runs/verification | tail -n 3"
