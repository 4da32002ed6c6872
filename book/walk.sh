#!/bin/sh
# Runs the commands of "Light your own model" as they stand in the page, and renders its pictures.
#
#     book/walk.sh target/release/lightmesh
#
# PYTHON is one with pillow.
set -eu
program=$(realpath "$1")
book=$(realpath "$(dirname "$0")")
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT
cp "$book"/models/chair.* "$new"
cd "$new"

lightmesh() {
    "$program" "$@"
}

# The blocks of commands, one after the other.
awk '/^```sh$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$book/src/light_your_model.md" > commands.sh
. ./commands.sh

rm cutout.png final.png
"${PYTHON:-python3}" "$book/shrink.py" "$book/src/walk" "$new"/*.png
