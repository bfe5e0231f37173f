#!/bin/sh
# SPDX-License-Identifier: MIT
# scenes/composed.sh makes its three pictures, small; with a volume of the
# user's, and with the Disney cloud where $DATA has it.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
out=$BUILD/composed
rm -rf "$out"
mkdir -p "$out"

composed() { OUT=$out SIZE=64x36 sh scenes/composed.sh "$@" >"$out/log"; }

# pictured NAME THINGS: there is more in a picture than the things alone.
pictured()
{
    "$BUILD/brume" compare "$out/$1" "$2" >"$out/compare" &&
        awk -F= '$1 == "rmse" && $2 > 1 { found = 1 } END { exit !found }' \
            "$out/compare"
}

helps() { composed --help && grep -q '^composed.sh' "$out/log"; }
check "--help" helps
check "it runs" composed
for name in bars_fog lamp_street cloud_plane; do
    cp "$out/$name.png" "$out/$name.first.png"
done
check "light through bars" pictured bars_fog.png "$out/bars_fog_colour.png"
check "lamps in fog" pictured lamp_street.png "$out/lamp_street_colour.png"
check "a cloud above a plain" pictured cloud_plane.png \
    "$out/cloud_plane_colour.png"

# Fitted to the cumulus, the scene of the cumulus says what it said.
view() { grep -E '^(eye|target|fog)' "$1"; }
fits()
{
    view scenes/cloud_plane.scene >"$out/want" &&
        view "$out/cloud_plane.scene" | cmp - "$out/want"
}
check "with the cumulus as a volume" composed "$out/cumulus.vdb"
check "the scene fits it" fits
"$BUILD/brume-cloud" -o "$out/small.vdb" --size 48 >/dev/null
check "with one of another size" composed "$out/small.vdb"
check "which is in the picture" pictured cloud_plane.png \
    "$out/cloud_plane_colour.png"
check "with a scene" composed "$out/cumulus.vdb" scenes/cloud_plane.scene
check "which gives the first picture" \
    cmp "$out/cloud_plane.png" "$out/cloud_plane.first.png"
refuses()
{
    ! composed "$out/none.vdb" 2>"$out/error" &&
        grep -q 'cannot read.*none.vdb' "$out/error"
}
check "no such volume" refuses

disney=$DATA/wdas_cloud_sixteenth.vdb
if [ -f "$disney" ]; then
    check "with the Disney cloud" composed "$disney"
    check "which is in the picture" pictured cloud_plane.png \
        "$out/cloud_plane_colour.png"
else
    skip "the Disney cloud is not in $DATA"
fi
finish
