#!/bin/sh
# SPDX-License-Identifier: MIT
# brume-monte-carlo and brume-octave-fit as commands: what they refuse, that a
# break or threads do not show, that a furnace is white.
set -eu
: "${BUILD:=build}"
. tests/lib.sh
work=$BUILD/monte_carlo
rm -rf "$work"
mkdir -p "$work"
"$BUILD/brume-cloud" --size 24 -o "$work/cloud.vdb" >/dev/null
"$BUILD/brume-bake" "$work/cloud.vdb" -o "$work/cloud.brume" \
    --dump-float "$work/cloud.float" >/dev/null
cat >"$work/scene" <<'SCENE'
size = 24x16
eye = 40,10,50
target = 12,7,12
fov = 30
sun = 60 30
density_scale = 0.5
light_density_scale = 0.5
filter = trilinear
phase = hg:0.7
step = 1
light = uniform
light_samples = 64
light_step = 1
SCENE

trace()
{
    "$BUILD/brume-monte-carlo" "$work/cloud.float" --scene "$work/scene" "$@" \
        >"$work/figures" 2>"$work/message"
}

# refused TEXT COMMAND...: status 2, one line that holds TEXT, no picture
refused()
{
    text=$1
    shift
    rm -f "$work/none.pfm"
    status=0
    "$@" >/dev/null 2>"$work/message" || status=$?
    [ $status = 2 ] && [ "$(wc -l <"$work/message")" = 1 ] &&
        grep -q "$text" "$work/message" && [ ! -e "$work/none.pfm" ]
}

program=$BUILD/brume-monte-carlo
draw="$program $work/cloud.float --scene $work/scene -o $work/none.pfm"
check "--help" sh -c "$program --help | grep -q usage"
check "no volume is refused" refused "needs VOLUME" "$program"
# shellcheck disable=SC2086
{
    check "passes that are no number" refused "many" $draw --passes many
    check "another extinction towards the sun" refused "must equal" \
        $draw --set light_density_scale=0.1
    check "ambient light" refused "ambient" $draw --set ambient=constant \
        --set ambient_colour=1,1,1
    check "no sun" refused "no sun" $draw --set light=none
    check "an unknown light" refused "moon" $draw --light moon
    check "an unknown key" refused "moon" $draw --set moon=1
}
check "draws" trace -o "$work/one.pfm" --passes 9 --threads 1
check "two threads" trace -o "$work/two.pfm" --passes 9 --threads 2
check "give the same bytes" cmp "$work/one.pfm" "$work/two.pfm"
check "four passes" trace -o "$work/part.pfm" --passes 4 --sums "$work/sums"
check "and five more" trace -o "$work/whole.pfm" --passes 9 --sums "$work/sums"
check "give the same bytes" cmp "$work/one.pfm" "$work/whole.pfm"
# shellcheck disable=SC2086
check "sums of another picture" refused "another picture" $draw \
    --passes 9 --sums "$work/sums" --set albedo=0.5
check "another extinction is fine for one order" trace -o "$work/x.pfm" \
    --order 1 --set light_density_scale=0.1
check "a furnace" trace -o "$work/white.pfm" --light environment --passes 3
# Each of 24 * 16 floats after the header is 1: 00 00 80 3f.
tail -c $((24 * 16 * 4)) "$work/white.pfm" | od -An -v -tx1 -w4 |
    sort -u >"$work/values"
check "is white" [ "$(cat "$work/values")" = " 00 00 80 3f" ]

fit=$BUILD/brume-octave-fit
check "brume-octave-fit --help" sh -c "$fit --help | grep -q usage"
check "no volumes to fit to" refused "needs NAME" "$fit"
check "no extinction" refused "expected NAME" "$fit" "a=$work/cloud.float"
check "no file" refused "cannot open" "$fit" "a=$work/none,1"
check "fits" sh -c "$fit --side 8 --passes 4 --phase isotropic \
    cloud=$work/cloud.float,0.5 >$work/tables.md"
check "prints a row for each albedo" [ \
    "$(grep -c '| 8, fit |' "$work/tables.md")" = 8 ]
finish
