#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Tests of brume-bake --emission: the second grid, section EMIT. What is in it
# is compared with the dumps of both grids by brume-spec-dump, which was
# written from docs/SPEC.md alone. BUILD is the folder of the programs, DATA
# that of the real volumes: without them what needs them is skipped by name.
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

# refused TEXT STATUS PATTERN ARGUMENT...: brume-bake ends with that status, its
# first line that is no notice holds PATTERN, and it leaves nothing
refused() {
    text=$1 status=$2 pattern=$3
    shift 3
    rm -rf "$work/none" && mkdir "$work/none"
    "$bake" "$@" -o "$work/none/out.brume" >"$work/out" 2>"$work/err"
    got=$?
    if [ $got -eq "$status" ] && [ ! -s "$work/out" ] &&
        [ -z "$(ls -A "$work/none")" ] &&
        grep -v ': notice: ' "$work/err" | head -n 1 |
            grep -q "^brume-bake: .*$pattern"; then
        ok "$text"
    else
        not_ok "$text"
        echo "# status $got, left: $(ls -A "$work/none")"
        sed 's/^/# /' "$work/err"
    fi
}

# conforms NAME INPUT ARGUMENT...: to $work/NAME.brume, which is what SPEC.md
# says and what the dumps say
conforms() {
    name=$1
    shift
    "$bake" "$@" -o "$work/$name.brume" --report "$work/$name.json" \
        --dump-float "$work/density.float" --dump-emission "$work/heat.float" \
        >"$work/out" 2>"$work/err" ||
        { sed 's/^/# /' "$work/err"; return 1; }
    "$BUILD/brume-spec-dump" "$work/$name.brume" --check \
        --against "$work/density.float" --emission "$work/heat.float"
}

minor() { od -An -tu2 -j6 -N2 "$work/$1.brume" | tr -d ' '; }
notices() { grep -c ": notice: .*$1" "$work/err"; }

# The report's number for a key of its object "emission".
figure() {
    sed -n '/"emission": {/,/}/p' "$work/$1.json" |
        sed -n "s/^ *\"$2\": \"*\([^,\"]*\)\"*,*\$/\1/p"
}

same_section() {
    "$dump" section "$work/$1.brume" "$3" >"$work/a" &&
        "$dump" section "$work/$2.brume" "$3" >"$work/b" &&
        cmp "$work/a" "$work/b"
}

## Two grids

for format in u8 u8r u4r; do
    for apron in "" --apron; do
        # shellcheck disable=SC2086
        check "$format $apron: as SPEC.md says" conforms "$format$apron" \
            "$v/two.vdb" --emission heat --format $format $apron
    done
done
check "it says 1.2" test "$(minor u8)" = 2
"$bake" "$v/two.vdb" --format u8 -o "$work/plain.brume" >/dev/null
check "of two balls in one place CELL and POOL are as without" \
    same_section u8 plain CELL
check "  POOL" same_section u8 plain POOL
check "without it says 1.0" test "$(minor plain)" = 0
check "the report has its figures" test "$(figure u8 name)" = heat -a \
    "$(figure u8 max)" = 200 -a "$(figure u8 value_of_255)" = 200
for threads in 1 2 5; do
    "$bake" "$v/two.vdb" --emission heat --format u8 --threads $threads \
        -o "$work/threads.brume" >/dev/null
    check "$threads threads: the same bytes" \
        cmp "$work/threads.brume" "$work/u8.brume"
done
check "in another order of bricks" conforms linear "$v/two.vdb" \
    --emission heat --order linear
check "with sections for light" conforms light "$v/two.vdb" --emission heat \
    --mips --sun-cache 4 --sun 20,40 --sky-visibility --sky-extinction 0.01
check "a level of detail" conforms lod "$v/two.vdb" --emission heat --lod 1
check "the grids by number" conforms number "$v/two.vdb" --grid '#1' \
    --emission '#0' --format u8
check "  are those by name" cmp "$work/number.brume" "$work/u8.brume"
check "a grid that is both" conforms both "$v/two.vdb" --emission density
for budget in 40000 12000; do
    check "--budget $budget" conforms budget "$v/two.vdb" --emission heat \
        --budget $budget
    check "  is kept to" test "$(wc -c <"$work/budget.brume")" -le $budget
done
check "as C" "$bake" "$v/two.vdb" --emission heat --format u8 -o "$work/u8.c"
check "  whose comment has it" grep -q '^ \* emission  grid "heat"' "$work/u8.c"
check "  and whose array is as long" grep -q \
    "bytes\[$(wc -c <"$work/u8.brume" | tr -d ' ')\];" "$work/u8.c"

## Scale

check "--emission-max above" conforms above "$v/two.vdb" --emission heat \
    --emission-max 400 --format u8
check "  is what 255 stands for" test "$(figure above value_of_255)" = 400
check "--emission-max below" conforms below "$v/two.vdb" --emission heat \
    --emission-max 100
check "  is said" test "$(notices 'maximum of 200 is limited to 100')" = 1
check "the asset's number is that of its voxels, or the one asked for" \
    sh -c "'$BUILD/brume' info '$work/u8.brume' | grep -qx emission_max=200 &&
    '$BUILD/brume' info '$work/above.brume' | grep -qx emission_max=400"

## Places

check "moved by whole voxels" conforms moved "$v/heat_moved.vdb" \
    --emission heat
check "  is resampled, and said" test "$(notices 'resampled to the voxels')" = 1
check "  as with an apron" conforms moved_apron "$v/heat_moved.vdb" \
    --emission heat --apron
check "  the same voxels" test "$(figure moved voxels)" = \
    "$(figure u8 voxels)" -a "$(figure moved max)" = 200
check "half as wide voxels" conforms finer "$v/heat_finer.vdb" --emission heat
refused "a frustum" 1 "frustum" "$v/heat_frustum.vdb" --emission heat

## What is missing, or bad

check "a grid that is not there is 0" conforms missing "$v/two.vdb" \
    --emission fog --format u8
check "  and said" test "$(notices 'has no grid "fog"')" = 1
check "  POOL is as without" same_section missing plain POOL
check "a density that is not there" conforms dark "$v/heat_only.vdb" \
    --emission heat
check "  is said, too" test "$(notices 'has no grid "density"')" = 1
for apron in "" --apron; do
    # shellcheck disable=SC2086
    check "a second grid without voxels $apron" conforms none \
        "$v/heat_none.vdb" --emission heat $apron
done
check "bad values" conforms bad "$v/heat_bad.vdb" --emission heat
check "  are said of the grid" \
    test "$(notices 'grid "heat": 1 NaN, 0 infinite and 1 negative')" = 1
check "  and reported" test "$(figure bad nan)" = 1 -a \
    "$(figure bad negative)" = 1
refused "neither grid" 2 'has no grid named "fog"' "$v/two.vdb" --grid fog \
    --emission smoke
refused "no voxel in either" 1 "see --allow-empty" "$v/nothing.vdb" \
    --emission heat
for form in u8 "u8r --apron" u4r; do
    # shellcheck disable=SC2086
    check "--allow-empty, $form" conforms empty "$v/nothing.vdb" \
        --emission heat --allow-empty --format $form
    check "  opens" "$BUILD/brume" info "$work/empty.brume"
    check "  and is drawn" "$BUILD/brume" render "$work/empty.brume" \
        --set emission=blackbody:900,2000,1 --set eye=0,0,90 \
        --set target=0,0,0 --set size=8x8 -o "$work/empty.png"
done
check "--allow-empty without a second grid" "$bake" "$v/empty.vdb" \
    --allow-empty -o "$work/one.brume"
refused "without it" 1 "has no active voxels" "$v/empty.vdb"
refused "a scale without a grid" 2 "needs --emission" "$v/two.vdb" \
    --emission-max 1
refused "a dump without a grid" 2 "needs --emission" "$v/two.vdb" \
    --dump-emission "$work/x"
for bad in 0 -1 nan x ""; do
    refused "--emission-max $bad" 2 "takes a number above 0" "$v/two.vdb" \
        --emission heat --emission-max "$bad"
done
if [ -f "$DATA/robustness/openvdb_sphere.vdb" ]; then
    refused "a level set that glows" 1 "level set" \
        "$DATA/robustness/openvdb_sphere.vdb" --emission '#0'
else
    skip "a level set that glows: openvdb_sphere.vdb absent"
fi

## The fire

fire=$DATA/embergen_fire/embergen_fire_a
if [ -f "${fire}_70.vdb" ]; then
    for frame in 0 60 70 71 72 73 74; do
        check "frame $frame of the fire" conforms "fire_$frame" \
            "${fire}_$frame.vdb" --grid flames --emission temperature \
            --emission-max 1.3 --allow-empty --format u8
    done
    check "temperature alone, with an apron" conforms hot "${fire}_70.vdb" \
        --grid none --emission temperature --apron
    check "within 600000 bytes" conforms small "${fire}_70.vdb" \
        --grid flames --emission temperature --budget 600000
else
    skip "the fire: embergen_fire_a_70.vdb absent"
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
