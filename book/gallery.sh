#!/bin/sh
# Renders the pictures of the gallery, and of the pages for an architect and an artist: one command each, without any tuning.
#
#     book/gallery.sh ../shared/scenes target/release/lightmesh
#
# The first argument is a folder with the models that book/src/gallery.md names, the second one the program. PYTHON is one with pillow.
set -eu
models=$1
program=$2
book=$(dirname "$0")
new=$(mktemp -d)
trap 'rm -rf "$new"' EXIT

picture() {
    name=$1
    shift
    "$program" render "$@" --size 640x480 -q -o "$new/$name.png"
}

picture gazebo builtin:gazebo
picture childpark builtin:childpark
picture garden builtin:garden
picture sponza "$models/sponza/sponza.obj" --camera "-13,3,0;10,5,0;60"
picture sponza_sky "$models/sponza/sponza.obj" --camera "-13,3,0;10,5,0;60" --sky "clear;sun=60,120"
picture childpark_sunset builtin:childpark --sky "clear;sun=8,250;alone"
picture interior "$book/../scenes/interior.toml"
picture arbour "$book/../scenes/arbour.toml" --bounces 2
picture bunny "$models/bunny/bunny.ply"
picture balloon "$models/balloon/scene.gltf"
picture chess "$models/chess/chess-board.glb"
picture house "$models/house/house.glb"
picture milk_truck "$models/milk_truck/CesiumMilkTruck.glb"
picture truck_sky "$models/milk_truck/CesiumMilkTruck.glb" --sky clear
picture bunny_sky "$models/bunny/bunny.ply" --sky "clear;sun=12,240"
picture truck_on_ground "$models/milk_truck/CesiumMilkTruck.glb" --no-studio --ground
"$program" render "$models/house/house.glb" --sun 55.03,82.92,2026-06-21+07:00,06:00-20:00/15m --size 640x480 -q \
    --sun-hours "$new/house_hours.png"
"${PYTHON:-python3}" "$book/shrink.py" "$book/src/gallery" "$new"/*.png
