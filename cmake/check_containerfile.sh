#!/bin/sh
# The Containerfile's steps without a container engine: its RUN lines in clean roots, one for each FROM.
#   usage: cmake/check_containerfile.sh ROOTS     as root, from a clone; ROOTS is a new folder, which is kept
# Prints every step with the last lines that it says; docs/results/package.md shows such a log.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
roots=$1
[ ! -e "$roots" ] || { echo "check_containerfile: $roots is there already; name a new folder" >&2; exit 2; }
mkdir -p "$roots"
stage=0
root=
folder=/

run() { # what is shown, command
    printf '\n[stage %s] %s\n' "$stage" "$1"
    "$here/clean_root.sh" run "$root" "$2"
}

while read -r word rest; do
    case $word in
        FROM)
            stage=$((stage + 1))
            root=$roots/stage_$stage
            folder=/
            "$here/clean_root.sh" make "$root"
            ;;
        WORKDIR) folder=$rest ;;
        COPY)
            case $rest in
                --from=*) cp "$roots"/stage_1/src/build/cutterflow_*.deb "$root/tmp/" ;;
                *) mkdir -p "$root/src" && git -C "$here/.." archive HEAD | tar -x -C "$root/src" ;;
            esac
            ;;
        RUN) run "$rest" "cd $folder && { $rest ; } >/tmp/step.log 2>&1 || { tail -n 30 /tmp/step.log; exit 1; }; tail -n 2 /tmp/step.log" ;;
        ENTRYPOINT) run "cutterflow --version" "cutterflow --version" ;;
    esac
done <"$here/../Containerfile"
