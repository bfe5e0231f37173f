#!/bin/sh
# SPDX-License-Identifier: MIT
# A fire from frame to frame: an asset for each, the same bytes by threads and
# kernels, history that goes on where pools begin elsewhere, frames in which
# nothing burns. BUILD is the folder of the programs, DATA that of the volumes.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
. tests/cli_lib.sh
brume=$BUILD/brume fire=$DATA/embergen_fire/embergen_fire_a

if [ ! -f "${fire}_70.vdb" ]; then
    skip "the fire: embergen_fire_a_70.vdb absent"
    finish
fi

# bake FRAME NAME OPTIONS...
bake()
{
    frame=$1 name=$2
    shift 2
    "$BUILD/brume-bake" "${fire}_$frame.vdb" -o "$work/$name.brume" \
        --grid flames --emission-max 1.3 --mips --format u8 "$@" \
        >/dev/null 2>&1
}
for n in 70 71 72 73 74; do
    bake $n fire_$n --emission temperature
done
bake 0 burn_69 --emission temperature --allow-empty
cp "$work/fire_70.brume" "$work/burn_70.brume"
small="--scene scenes/fire.scene --set size=60x75 --set step=2"

# hashes OPTIONS...: of all frames
hashes()
{
    # shellcheck disable=SC2086
    "$brume" render "$work/fire_%d.brume" --frames 70:74 $small --hash "$@"
}
hashes >"$work/all"
check "five frames, five pictures" [ "$(cut -d= -f3 "$work/all" | sort -u |
    wc -l)" -eq 5 ]
each()
{
    for n in 70 71 72 73 74; do
        # shellcheck disable=SC2086
        "$brume" render "$work/fire_$n.brume" $small --set frame=$n \
            --set emission_scale=0.01 --hash | sed "s/^/frame=$n /"
    done >"$work/each"
    cmp "$work/all" "$work/each"
}
check "each is that of its own asset" each
for temporal in none ema taa; do
    hashes --set temporal=$temporal --threads 1 --kernel scalar >"$work/a"
    hashes --set temporal=$temporal --threads 3 >"$work/b"
    check "temporal = $temporal: threads and kernels agree" \
        cmp "$work/a" "$work/b"
done
# shellcheck disable=SC2086
check "a frame that is missing, before anything is drawn" \
    fails 2 'fire_75\.brume: No such file' "$brume" render \
    "$work/fire_%d.brume" --frames 70:75 $small -o "$none/%d.png"
# shellcheck disable=SC2086
check "from a frame in which nothing burns" runs "$brume" render \
    "$work/burn_%d.brume" --frames 69:70 $small --set temporal=taa \
    -o "$work/burn_%d.ppm"
dark()
{
    # filmic of the background, nearly black, everywhere
    tail -c 13500 "$work/burn_69.ppm" | od -An -v -tu1 -w3 | sort -u |
        awk 'NR > 1 || $1 + $2 + $3 > 60 { bad = 1 } END { exit bad }'
}
check "  it is dark" dark

# The same smoke in pools that begin elsewhere: with the second grid, whose box
# is larger, and without. What history makes of it is what it makes of the same
# pool with bricks in another order, which is another asset, too. Not by cones:
# the cubes of mips lie on the pool's own grid.
bake 70 still_1 --emission none
bake 70 still_2 --emission none --order linear
bake 70 other_2 --emission temperature
cp "$work/still_1.brume" "$work/other_1.brume"
origin() { "$brume" info "$work/$1.brume" | sed -n 's/^origin=//p'; }
check "the pools begin elsewhere" [ "$(origin other_1)" != \
    "$(origin other_2)" ]
for temporal in ema taa; do
    for name in still other; do
        # shellcheck disable=SC2086
        "$brume" render "$work/${name}_%d.brume" --frames 1:2 $small \
            --set emission=none --set sun_colour=1 --set light=log \
            --set temporal=$temporal -o "$work/${name}_%d.png"
    done
    "$brume" compare "$work/still_2.png" "$work/other_2.png" >"$work/metrics"
    rmse=$(sed -n 's/^rmse=//p' "$work/metrics")
    check "$temporal: history goes on, rmse $rmse of 255" \
        awk "BEGIN { exit !($rmse < 0.1) }"
done
finish
