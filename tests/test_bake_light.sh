#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Tests of brume-bake's sections for light: --mips, --sun-cache and
# --sky-visibility. What is in them is compared with the voxels by
# brume-spec-dump, which was written from docs/SPEC.md alone. BUILD is the
# folder of the programs, DATA that of the real volumes: without them what
# needs them is skipped by name.
LC_ALL=C
export LC_ALL
BUILD=${BUILD:-build}
DATA=${DATA:-../shared/data}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
bake=$BUILD/brume-bake dump=$BUILD/tests/section_dump
. tests/bake_lib.sh

if [ ! -x "$bake" ]; then
    not_ok "$bake is there"
    echo "$passed passed, $failed failed, $skipped skipped"
    exit 1
fi
v=$work/vdb
mkdir "$v"
"$BUILD/tests/make_vdbs" "$v" || exit 1

# refused TEXT STATUS PATTERN ARGUMENT...: brume-bake of the ball ends with
# that status and one line that holds PATTERN, and leaves nothing
refused() {
    text=$1 status=$2 pattern=$3
    shift 3
    rm -rf "$work/none" && mkdir "$work/none"
    "$bake" "$v/float.vdb" "$@" -o "$work/none/out.brume" >"$work/out" \
        2>"$work/err"
    got=$?
    if [ $got -eq "$status" ] && [ ! -s "$work/out" ] &&
        [ -z "$(ls -A "$work/none")" ] && [ "$(wc -l <"$work/err")" -eq 1 ] &&
        grep -q "^brume-bake: .*$pattern" "$work/err"; then
        ok "$text"
    else
        not_ok "$text"
        echo "# status $got, left: $(ls -A "$work/none")"
        sed 's/^/# /' "$work/err"
    fi
}

# baked NAME INPUT ARGUMENT...: to $work/NAME.brume, report in NAME.json
baked() {
    name=$1
    shift
    "$bake" "$@" -o "$work/$name.brume" --report "$work/$name.json" \
        >"$work/out" 2>"$work/err"
}

# conforms NAME INPUT ARGUMENT...: and it is what SPEC.md says
conforms() {
    baked "$@" && "$BUILD/brume-spec-dump" "$work/$1.brume" --check
}

# bytes_of NAME ID: of a section
bytes_of() { "$dump" section "$work/$1.brume" "$2" | wc -c; }

# of NAME KEY: the report's number for a key
of() { sed -n "s/^ *\"$2\": \([^,]*\),*\$/\1/p" "$work/$1.json" | head -n 1; }

minor() { od -An -tu2 -j6 -N2 "$work/$1.brume" | tr -d ' '; }

same_section() {
    "$dump" section "$work/$1.brume" "$3" >"$work/a" &&
        "$dump" section "$work/$2.brume" "$3" >"$work/b" &&
        cmp "$work/a" "$work/b"
}

sun="--sun-cache 4 --sun=-60,10"
sky="--sky-visibility --sky-extinction 0.02"
all="--mips $sun $sky"

## Options ##

refused "a sun cache without a sun" 2 "sun-cache needs --sun" --sun-cache 4
refused "a sun without a cache" 2 "sun needs --sun-cache" --sun 10,20
for bad in 0 1 3 16 4x ''; do
    refused "--sun-cache '$bad'" 2 "sun-cache takes 2, 4 or 8" \
        --sun-cache "$bad" --sun 10,20
done
for bad in 10 10, ,20 '10 20' 10,20x nan,0 0,inf 3601,0 0,-3601 '' x,y; do
    refused "--sun '$bad'" 2 "sun takes azimuth,elevation" --sun-cache 4 \
        --sun "$bad"
done
refused "a sky without its extinction" 2 "visibility needs --sky-extinction" \
    --sky-visibility
refused "an extinction without a sky" 2 "extinction needs --sky-visibility" \
    --sky-extinction 0.1
for bad in 0 -1 nan inf 1x ''; do
    refused "--sky-extinction '$bad'" 2 "takes a number above 0" \
        --sky-visibility --sky-extinction "$bad"
done
"$bake" --help >"$work/help"
for option in --mips --sun-cache --sun --sky-visibility --sky-extinction; do
    check "--help has $option" grep -q -e "^  $option " "$work/help"
done

## Sections ##

baked plain "$v/float.vdb"
check "without them the asset says version 1.0" test "$(minor plain)" = 0
for f in u8 u8r u4r; do
    for apron in "" --apron; do
        # shellcheck disable=SC2086
        check "$f${apron:+ with apron}: as SPEC.md says" \
            conforms f "$v/float.vdb" $all --format $f $apron
    done
done
# shellcheck disable=SC2086
baked all "$v/float.vdb" $all
check "with them it says 1.1" test "$(minor all)" = 1
for id in CELL POOL NAME; do
    check "  $id is as without" same_section plain all $id
done
check "  the report is JSON" "$dump" json "$work/all.json"
check "  with the bytes of each" test "$(of all mips_bytes) $(
    of all sun_cache_bytes) $(of all sky_visibility_bytes)" = "$(
    bytes_of all MIPS) $(bytes_of all SUNC) $(bytes_of all AMBI)"
# 5 x 5 x 5 cells, then 3 x 3 x 3, 2 x 2 x 2 and 1.
check "  the ball has 5 x 5 x 5 cells" test "$(
    "$dump" header "$work/all.brume" | grep cells)" = "cells=5,5,5"
check "  72 means a brick, and 125 + 27 + 8 + 1" test \
    "$(bytes_of all MIPS)" -eq $((72 * $(of all bricks) + 161))
check "  the summary tells of them" grep -q '^light: mips [0-9]* bytes, ' \
    "$work/out"
for s in 2 8; do
    check "points $s voxels apart" conforms s "$v/float.vdb" --sun-cache $s \
        --sun 200,-35
done
for angles in 0,90 0,-90 0,0 90,0 180,0 45,45; do
    check "a sun at $angles" conforms s "$v/float.vdb" --sun-cache 4 \
        --sun "$angles"
done
check "shared bricks" conforms tiles "$v/tiles.vdb" --mips --lod 1
check "a level of detail, limited" conforms lod "$v/float.vdb" --mips \
    --sun-cache 2 --sun 30,40 --lod 1 --max-density 50
check "  from another order of bricks" sh -c "
    '$bake' '$v/float.vdb' -o '$work/lin.brume' --mips --sun-cache 2 \
        --sun 30,40 --lod 1 --max-density 50 --order linear >'$work/out' &&
    '$BUILD/brume-spec-dump' '$work/lin.brume' --check"
check "  the same depths" same_section lod lin SUNC
for n in 1 2 5; do
    # shellcheck disable=SC2086
    baked n$n "$v/float.vdb" $all --threads $n
done
check "threads 1, 2 and 5 agree" sh -c \
    "cmp '$work/n1.brume' '$work/n2.brume' &&
     cmp '$work/n1.brume' '$work/n5.brume'"

# The sun's direction is in world axes. direction NAME: of SUNC, in pool axes
direction() {
    "$dump" section "$work/$1.brume" SUNC | od -An -td4 -j4 -N12
}
baked flat "$v/float.vdb" --sun-cache 8 --sun 25,35
check "a sun at 25,35" sh -c "echo $(direction flat) | awk '{
    r = atan2(0, -1) / 180
    x = \$1 / 2^30 - cos(35 * r) * sin(25 * r)
    y = \$2 / 2^30 - sin(35 * r)
    z = \$3 / 2^30 - cos(35 * r) * cos(25 * r)
    exit !(x * x + y * y + z * z < 1e-17) }'"
check "in a turned volume" conforms turned "$v/rotated.vdb" --sun-cache 8 \
    --sun 25,35
world=$("$dump" header "$work/turned.brume" | sed -n 's/^world=//p' |
    tr ',' ' ')
check "  it is turned too" sh -c "echo $(direction turned) $world | awk '{
    r = atan2(0, -1) / 180
    for (i = 0; i < 3; i++) {
        w = (\$(4 + 4 * i) * \$1 + \$(5 + 4 * i) * \$2 + \$(6 + 4 * i) * \$3)
        s[i] = w / 0.25 / 2^30
    }
    x = s[0] - cos(35 * r) * sin(25 * r)
    y = s[1] - sin(35 * r)
    z = s[2] - cos(35 * r) * cos(25 * r)
    exit !(x * x + y * y + z * z < 1e-15) }'"

## Other outputs, and the budget ##

# shellcheck disable=SC2086
check "as C" "$bake" "$v/float.vdb" -o "$work/c.c" $all
check "  whose comment has them" test "$(grep -c '^ \* light ' "$work/c.c")" \
    -eq 3
for budget in 20000 8192 4096; do
    # shellcheck disable=SC2086
    check "--budget $budget with all of them" conforms b "$v/float.vdb" $all \
        --budget $budget
    check "  is kept to" test "$(wc -c <"$work/b.brume")" -le $budget
    # shellcheck disable=SC2086
    check "  and is what --lod and --format make" sh -c "
        '$bake' '$v/float.vdb' -o '$work/same.brume' $all \
            --lod $(of b lod) --format $(of b format) >'$work/out' &&
        cmp '$work/b.brume' '$work/same.brume'"
done
# shellcheck disable=SC2086
refused "no room for anything" 1 "the smallest asset has [0-9]* (" $all \
    --budget 300
least=$(sed -n 's/.*smallest asset has \([0-9]*\) .*/\1/p' "$work/err")
# shellcheck disable=SC2086
check "the smallest size it names can be had" conforms b "$v/float.vdb" $all \
    --budget "$least"
# shellcheck disable=SC2086
refused "one byte less cannot" 1 "smallest asset has $least" $all \
    --budget $((least - 1))

## Real volumes ##

# percent NAME KEY LEAST MOST: a section's bytes, of the asset without it
percent() {
    awk -v part="$(of "$1" "$2")" -v all="$(of "$1" bytes)" -v least="$3" \
        -v most="$4" 'BEGIN { p = 100 * part / (all - part)
        print p " %"; exit !(p >= least && p <= most) }'
}

cloud=$DATA/wdas_cloud_sixteenth.vdb
if [ -e "$cloud" ]; then
    check "the Disney cloud with mips" conforms mips "$cloud" --format u8 \
        --mips
    check "  14 to 15 % more" percent mips mips_bytes 14 15
    for s in 2 4 8; do
        check "with depths every $s voxels" conforms sun "$cloud" --format u8 \
            --sun-cache $s --sun=-60,10
    done
    check "with the sky" conforms sky "$cloud" --format u8 --sky-visibility \
        --sky-extinction 0.5
else
    skip "needs $cloud"
fi
smoke=$DATA/openvdb_smoke1.vdb
if [ -e "$smoke" ]; then
    # shellcheck disable=SC2086
    check "the smoke with all" conforms smoke "$smoke" --format u8r $all
else
    skip "needs $smoke"
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
