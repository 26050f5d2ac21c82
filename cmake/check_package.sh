#!/bin/sh
# The Debian package in a clean root: installed with its dependencies, and a tiny study from `cutterflow new` to its report.
#   usage: cmake/check_package.sh PACKAGE.deb ROOT     as root; ROOT is a new folder, which is kept
# Prints every command and what it says; docs/results/package.md shows such a log.
set -eu
package=$1
root=$2
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
deb=/tmp/$(basename "$package")

in_root() { # user, command: by that user, in their home
    printf '\n%s$ %s\n' "$1" "$2"
    printf 'cd\n%s\n' "$2" >"$root/tmp/command.sh"
    "$here/clean_root.sh" run "$root" "su $1 -c 'sh -eu /tmp/command.sh'" 2>&1
}

"$here/clean_root.sh" make "$root"
cp "$package" "$root/tmp/"
in_root root "dpkg --list | grep -c ^ii"
in_root root "dpkg-deb --field $deb Package Version Architecture Installed-Size Depends && du --apparent-size -h $deb"
in_root root "apt-get -q update >update.log && apt-get -q -y --no-install-recommends install $deb >install.log
grep -e 'newly installed' -e 'After this operation' install.log && dpkg --list | grep -c ^ii"
in_root root "useradd --create-home user"
in_root user "cutterflow --version"
in_root user "cutterflow generate-cutter /usr/share/cutterflow/cases/examples/model_cutter/crown.toml -o head.stl"
in_root user "cutterflow new --cutter head.stl --unit m study.toml"
# What a user edits: little rock, and a tenth of a revolution.
in_root user 'sed -i -e "s/^flow_revolutions = .*/flow_revolutions = 0.02/" -e "s/^max_revolutions = .*/max_revolutions = 0.1/" \
    -e "s/^count = .*/count = 20/" study.toml && grep -e _revolutions -e ^count study.toml'
in_root user "cutterflow check study.toml"
in_root user "cutterflow run study.toml -o runs/tiny"
in_root user "ls runs/tiny/report && sed -n -e '/\"conservation\"/,/}/p' -e '/\"fates\"/,/}/p' -e '/\"placed\"/p' runs/tiny/report/results.json"
in_root user "cp -r /usr/share/cutterflow/cases/examples/rock_in_a_box . && rock_in_a_box/Allrun
cut -d , -f 1-3 rock_in_a_box/postProcessing/balance/0/balance.csv | sed -n -e 1p -e '\$p'"
in_root user "cutterflow verify closures --fast -o runs/verification"
