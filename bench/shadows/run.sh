#!/bin/sh
# Measures occluder lists, and whole frames with the default settings, against their rivals in five scenes: the built-in ones, Sponza, and the Stanford bunny on a plane.
#
#     bench/shadows/run.sh MODELS [flags of `lightmesh bench shadows`]
#
# MODELS is a folder with sponza/sponza.obj, sponza/sponza.mtl and bunny/bunny.ply. LIGHTMESH is the program, if it is not on the path.
set -eu
here=$(dirname "$0")
models=$1
shift
scenes=$(mktemp -d)
trap 'rm -rf "$scenes"' EXIT
cp "$here"/*.toml "$models"/sponza/sponza.obj "$models"/sponza/sponza.mtl "$models"/bunny/bunny.ply "$scenes"
"${LIGHTMESH:-lightmesh}" bench shadows --scene builtin:gazebo --scene builtin:childpark --scene builtin:garden \
    --scene "$scenes"/sponza.toml --scene "$scenes"/bunny_on_a_plane.toml "$@"
