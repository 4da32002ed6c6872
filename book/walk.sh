#!/bin/sh
# Renders the pictures of "Light your own model", whose commands are those between the anchors.
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

# ANCHOR: size
export LIGHTMESH_SIZE=640x480       # every flag can be a variable; this is --size 640x480 for all commands below
# ANCHOR_END: size

# ANCHOR: info
lightmesh info chair.obj
# ANCHOR_END: info

# ANCHOR: first
lightmesh render chair.obj -o first.png
# ANCHOR_END: first

# ANCHOR: ground
lightmesh render chair.obj --ground -o ground.png
# ANCHOR_END: ground

# ANCHOR: camera
VIEW="1.5,0.95,2;0.15,0.38,-0.05;32"        # position; what it looks at; vertical field of view in degrees
lightmesh render chair.obj --ground --camera "$VIEW" --light "-1.5,2.4,1.2;0.9;0.02" -o small.png
# ANCHOR_END: camera

# ANCHOR: large
lightmesh render chair.obj --ground --camera "$VIEW" --light "-1.5,2.4,1.2;0.9;0.4" -o large.png
# ANCHOR_END: large

# ANCHOR: two
KEY="-1.2,2,1;0.95,0.86,0.72;0.15"          # position; colour; radius
FILL="2,1.4,-0.6;0.3,0.4,0.55;0.5"
lightmesh render chair.obj --ground --camera "$VIEW" --light "$KEY" --light "$FILL" --background 0.6 -o two.png
# ANCHOR_END: two

# ANCHOR: lamps
lightmesh render chair.obj --ground --camera "$VIEW" --light "-0.5,1.6,0.8;40,30,20;0.06" --light "2,1.2,-1;6,8,12;0.3" \
    --falloff inverse-square --exposure auto --view agx --background 2 -o lamps.png
# ANCHOR_END: lamps

# ANCHOR: sky
lightmesh render chair.obj --ground --camera "1.5,0.5,2;0.15,0.38,-0.05;40" --sky "clear;sun=12,240" -o sky.png
# ANCHOR_END: sky

# ANCHOR: sun
lightmesh render chair.obj --ground --camera "1.5,0.9,2;0.15,0.3,-0.05;40" --sun 55.03,82.92,2026-06-21+07:00,06:00-20:00/10m \
    --sun-hours hours.png
# ANCHOR_END: sun

# ANCHOR: cutout
lightmesh render chair.obj --ground --camera "$VIEW" --light "$KEY" --light "$FILL" --background transparent \
    --layers chair.exr -o cutout.png
# ANCHOR_END: cutout

# ANCHOR: final
lightmesh render chair.obj --ground --camera "$VIEW" --light "$KEY" --light "$FILL" --background 0.6 --quality final -o final.png
# ANCHOR_END: final

rm cutout.png final.png
"${PYTHON:-python3}" "$book/shrink.py" "$book/src/walk" "$new"/*.png
