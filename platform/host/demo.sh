#!/bin/sh
# SPDX-License-Identifier: MIT
# `make demo`: a cloud (or $VDB), baked, and pictures of it in $BUILD/demo.
set -eu
: "${BUILD:=build}" "${VDB:=}"
out=$BUILD/demo
mkdir -p "$out"

# draw NAME VOLUME OPTIONS...
draw()
{
    picture=$out/$1.png volume=$2
    shift 2
    "$BUILD/brume" render "$volume" "$@" -o "$picture"
    pictures="$pictures
  $picture"
}

pictures=
if [ -n "$VDB" ]; then
    name=$(basename "${VDB%.*}")
    "$BUILD/brume-bake" "$VDB" -o "$out/$name.brume"
    draw "$name" "$out/$name.brume" --set size=1280x720
    draw "${name}_low_sun" "$out/$name.brume" --set size=1280x720 \
        --set sun=-100,8 --set background=0.045,0.06,0.11
else
    name=cumulus
    "$BUILD/brume-cloud" -o "$out/cumulus.vdb" --size 256
    "$BUILD/brume-bake" "$out/cumulus.vdb" -o "$out/cumulus.brume"
    draw cumulus "$out/cumulus.brume" --scene scenes/cumulus.scene
    draw cumulus_low_sun "$out/cumulus.brume" \
        --scene scenes/cumulus_low_sun.scene
    draw cumulus_default "$out/cumulus.brume"
fi
echo "pictures:$pictures"
echo "try:
  $BUILD/brume render $volume --set sun=60,20 -o cloud.png
  $BUILD/brume info $volume"
