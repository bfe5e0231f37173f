#!/bin/sh
# SPDX-License-Identifier: MIT
# composed.sh: volumes and fog among solid things, in $BUILD/demo: light through
# a window of bars, a street of lamps, a cloud and its shadow. Each is `brume
# surface`, whose files `brume render` ends its rays at and draws over.
set -eu
cd "$(dirname "$0")/.."
: "${BUILD:=build}"
brume=$BUILD/brume out=$BUILD/demo cloud=$BUILD/demo/cumulus.brume
mkdir -p "$out"

# As `make demo` makes it: the cloud of the last picture, and the world of all.
if [ ! -f "$cloud" ]; then
    "$BUILD/brume-cloud" -o "$out/cumulus.vdb" --size 256
    "$BUILD/brume-bake" "$out/cumulus.vdb" -o "$cloud"
fi

# things NAME OPTION...: depth and colour of a scene's things
things()
{
    name=$1
    shift
    "$brume" surface "$cloud" --scene "scenes/$name.scene" "$@" \
        --depth "$out/${name}_depth.png" --colour "$out/${name}_colour.png"
}

# compose NAME OPTION...: the scene over them
compose()
{
    name=$1
    shift
    echo "drawing $out/$name.png"
    "$brume" render "$cloud" --scene "scenes/$name.scene" \
        --set surface="$out/${name}_depth.png" \
        --over "$out/${name}_colour.png" "$@" -o "$out/$name.png"
}

sh scenes/things.sh bars >"$out/bars.obj"
things bars_fog --albedo 0.25 --mesh "$out/bars.obj" \
    --albedo 0.2 --plane 0 --area -600,-600,600,600 --samples 4 \
    --sun-map "$out/bars_fog_sun.pgm" --size 2048x1024 \
    --cover -300,0,-300,300,130,10
compose bars_fog --set sun_map="$out/bars_fog_sun.pgm"

sh scenes/things.sh posts >"$out/posts.obj"
things lamp_street --albedo 0.15 --plane 0 --area -600,-600,600,1200 \
    --albedo 0.1 --mesh "$out/posts.obj" --samples 4
compose lamp_street

area=$("$brume" shadow "$cloud" --scene scenes/cloud_plane.scene \
    --plane -50 --size 512x512 -o "$out/cloud_plane_shadow.png" |
    sed -n 's/^area=//p')
things cloud_plane --albedo 0.025,0.04,0.015 --plane -50 \
    --area -30000,-30000,30000,30000 --samples 2 \
    --shadow "$out/cloud_plane_shadow.png" --shadow-area "$area"
compose cloud_plane
