#!/bin/sh
# Fetches the source package of Debian's openfoam and lays its headers out as flat include folders of links,
# one per library (what `wmakeLnInclude` does), because Debian ships OpenFOAM's libraries without headers.
#
#   usage: cmake/fetch_openfoam_headers.sh <folder>
#
# Result: <folder>/src (the unpacked sources) and <folder>/include/<library> (links), <folder>/version.
# Cheap to repeat: nothing is done when <folder>/version names the installed package.
# The system's own apt lists and sources stay untouched: a private list of sources is used.
set -eu

target=${1:?usage: fetch_openfoam_headers.sh FOLDER}
mkdir -p "$target"
target=$(cd "$target" && pwd)

version=$(dpkg-query -W -f='${source:Version}' libopenfoam 2>/dev/null || true)
if [ -z "$version" ]; then
    echo "error: Debian's package libopenfoam is not installed. Run ./bootstrap, which installs it." >&2
    exit 3
fi
if [ -f "$target/version" ] && [ "$(cat "$target/version")" = "$version" ]; then
    exit 0
fi

private=$target/apt
mkdir -p "$private/lists/partial" "$private/archives/partial" "$private/sources.d"
# Every deb entry of the system, as a deb-src entry (one-line and deb822 forms).
: > "$private/sources.list"
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list; do
    [ -f "$list" ] && sed -n -e '/debian/s/^deb \(.*\)/deb-src \1/p' "$list" >> "$private/sources.list"
done
for list in /etc/apt/sources.list.d/*.sources; do
    [ -f "$list" ] && grep -qi 'debian' "$list" || continue
    sed -e 's/^Types:.*/Types: deb-src/' "$list" > "$private/sources.d/$(basename "$list")"
done

apt_options="-o Dir::Etc::SourceList=$private/sources.list -o Dir::Etc::SourceParts=$private/sources.d
 -o Dir::State::Lists=$private/lists -o Dir::Cache::Archives=$private/archives -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
 -o APT::Sandbox::User=root -o Acquire::Retries=3"
cd "$target"
# shellcheck disable=SC2086
apt-get $apt_options -q update >"$private/update.log" 2>&1 ||
    { echo "error: the package lists for source packages could not be read; see $private/update.log" >&2; exit 3; }
# shellcheck disable=SC2086
apt-get $apt_options -q source --download-only "openfoam=$version" >"$private/source.log" 2>&1 ||
    { echo "error: the source package openfoam=$version could not be fetched; see $private/source.log" >&2; exit 3; }

rm -rf src include
dpkg-source --no-check -x openfoam_*.dsc src >"$private/unpack.log" 2>&1 ||
    { echo "error: the source package could not be unpacked; see $private/unpack.log" >&2; exit 3; }

# One flat folder of links per library: the folder that holds a Make/files.
find src/src -type f -path '*/Make/files' | while read -r files; do
    library=$(dirname "$(dirname "$files")")
    flat=include/${library#src/src/}
    mkdir -p "$flat"
    find "$library" -type d \( -name Make -o -name lnInclude \) -prune -o -type f \( -name '*.H' -o -name '*.C' -o -name '*.h' -o -name '*.hpp' \) -print |
        while read -r header; do
            ln -sf "$target/$header" "$flat/$(basename "$header")"
        done
done
rm -f openfoam_*.tar.* openfoam_*.dsc
echo "$version" > version
