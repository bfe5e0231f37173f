#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Tests of brume-bake. BUILD is the folder of brume-bake, tests/make_vdbs and
# tests/section_dump, DATA that of the real volumes: without them what needs
# them is skipped by name.
BUILD=${BUILD:-build}
DATA=${DATA:-../shared/data}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
bake=$BUILD/brume-bake
. tests/bake_lib.sh

# refused TEXT STATUS PATTERN ARGUMENT...: brume-bake ends with that status,
# says PATTERN in its first line on stderr that is not a notice, the only one
# unless grids are listed, and leaves no file behind
refused() {
    text=$1 status=$2 pattern=$3
    shift 3
    rm -rf "$work/none" && mkdir "$work/none"
    "$bake" "$@" -o "$work/none/out.brume" >"$work/out" 2>"$work/err"
    got=$?
    grep -v ': notice: ' "$work/err" >"$work/lines"
    if [ $got -eq "$status" ] && [ ! -s "$work/out" ] &&
        [ -z "$(ls -A "$work/none")" ] &&
        head -n 1 "$work/lines" | grep -q "^brume-bake: .*$pattern" &&
        { [ "$status" -eq 2 ] || [ "$(wc -l <"$work/lines")" -eq 1 ]; }; then
        ok "$text"
    else
        not_ok "$text"
        echo "# status $got, left: $(ls -A "$work/none")"
        sed 's/^/# /' "$work/err"
    fi
}

# baked NAME ARGUMENT...: bake to $work/NAME.brume, stderr to $work/err
baked() {
    name=$1
    shift
    "$bake" "$@" -o "$work/$name.brume" >"$work/out" 2>"$work/err" ||
        { sed 's/^/# /' "$work/err"; return 1; }
}

header() { "$dump" header "$work/$1.brume" | grep "^$2=" | cut -d= -f2-; }

# The report's number for a key.
figure() { sed -n "s/^ *\"$2\": \([^,]*\),*\$/\1/p" "$work/$1" | head -n 1; }

same_section() {
    "$dump" section "$work/$1.brume" "$3" >"$work/a" &&
        "$dump" section "$work/$2.brume" "$3" >"$work/b" &&
        cmp "$work/a" "$work/b"
}

# same_bricks A B: equal cells, bricks and ranges (u8 has no ranges)
same_bricks() {
    same_section "$1" "$2" CELL && same_section "$1" "$2" POOL || return 1
    [ "$(header "$1" format)" = 1 ] || same_section "$1" "$2" RNGE
}

# a and b agree to 1 part in 10^4: for figures printed with fewer digits
near() {
    awk -v a="$1" -v b="$2" 'BEGIN {
        d = a - b; m = a < 0 ? -a : a
        exit !((d < 0 ? -d : d) <= 1e-4 * m + 1e-12) }'
}

if [ ! -x "$bake" ]; then
    not_ok "$bake is there"
    echo "$passed passed, $failed failed, $skipped skipped"
    exit 1
fi
dump=$BUILD/tests/section_dump
make_vdbs=$BUILD/tests/make_vdbs
v=$work/vdb
mkdir "$v"
"$make_vdbs" "$v" || exit 1

## Options ##

check "--help" sh -c "'$bake' --help | grep -q '^usage: brume-bake'"
refused "no input" 2 "no input file"
refused "unknown option" 2 "unknown option --frmat" "$v/float.vdb" --frmat u8
refused "two inputs" 2 "two inputs" "$v/float.vdb" "$v/half.vdb"
refused "unknown format" 2 "format is auto, u8, u8r or u4r" \
    "$v/float.vdb" --format u16
refused "lod out of range" 2 "lod takes a number from 0 to 8" \
    "$v/float.vdb" --lod 9
refused "lod not a number" 2 "lod takes a number" "$v/float.vdb" --lod 1x
refused "max-density not positive" 2 "max-density takes" \
    "$v/float.vdb" --max-density 0
refused "unknown order" 2 "order is morton or linear" \
    "$v/float.vdb" --order hilbert
refused "threads out of range" 2 "threads takes" "$v/float.vdb" --threads 0
"$bake" "$v/float.vdb" >"$work/out" 2>"$work/err"
check "no output named" test $? -eq 2
"$bake" "$v/float.vdb" --report >"$work/out" 2>"$work/err"
check "an option without its value" test $? -eq 2
cp "$v/float.vdb" "$work/self.vdb"
"$bake" "$work/self.vdb" -o "$work/self.vdb" >"$work/out" 2>"$work/err"
check "the input is not overwritten" test $? -eq 2
check "and still whole" cmp "$v/float.vdb" "$work/self.vdb"

## Files ##

refused "missing file" 1 "No such file" "$work/nowhere.vdb"
refused "a directory" 1 "is a directory" "$v"
: >"$work/zero.vdb"
refused "an empty file" 1 "is empty" "$work/zero.vdb"
printf 'VOL\003 and more' >"$work/other.vol"
refused "an unknown type" 1 "neither" "$work/other.vol"
"$bake" "$v/float.vdb" -o "$work/missing/x.brume" 2>"$work/err"
check "an output folder that is missing" test $? -eq 1
"$bake" "$v/float.vdb" -o "$work" 2>"$work/err"
check "an output that is a directory" test $? -eq 1
bad=
for kind in float half none stream; do
    size=$(wc -c <"$v/$kind.vdb")
    for cut in 4 9 40 60 100 200 400 800 1000 2000 4000 8000; do
        for n in $cut $((size - cut)); do
            [ "$n" -gt 0 ] && [ "$n" -lt "$size" ] || continue
            head -c "$n" "$v/$kind.vdb" >"$work/cut.vdb"
            rm -f "$work/cut.brume"
            "$bake" "$work/cut.vdb" -o "$work/cut.brume" >"$work/out" \
                2>"$work/err"
            [ $? -eq 1 ] && [ "$(wc -l <"$work/err")" -eq 1 ] &&
                [ ! -e "$work/cut.brume" ] || bad="$bad $kind:$n"
        done
    done
done
check "truncated files are refused in one line:$bad" test -z "$bad"

## Types and encodings ##

baked float "$v/float.vdb"
for kind in double int32 int64 half none stream inactive; do
    check "$kind values bake as float ones do" \
        baked $kind "$v/$kind.vdb"
    check "  to the same bytes" cmp "$work/float.brume" "$work/$kind.brume"
done
baked bool "$v/bool.vdb" && baked mask "$v/mask.vdb"
check "a mask bakes as bools do" same_bricks bool mask
check "  to density 1" test "$(header bool density_max)" = 1
baked tiles "$v/tiles.vdb" && baked filled "$v/filled.vdb"
check "tiles bake as voxels do" cmp "$work/tiles.brume" "$work/filled.brume"
check "origin and box" test \
    "$(header float origin) $(header float box_min) $(header float box_max)" \
    = "-16,-24,0 7,7,8 31,31,32"
baked one "$v/float.vdb" --threads 1 && baked two "$v/float.vdb" --threads 2
check "threads 1 and 2 agree" cmp "$work/one.brume" "$work/two.brume"
refused "vectors" 1 "vec3s" "$v/points.vdb"
refused "an empty grid" 1 "no active voxels" "$v/empty.vdb"
refused "nothing positive" 1 "no voxel with density" "$v/negative.vdb"
refused "too large for any memory" 1 "GiB\|cells" "$v/huge.vdb"
refused "too wide for the format" 1 "5002 x 2 x 2 cells" "$v/wide.vdb"
check "--lod makes it fit" baked wide "$v/wide.vdb" --lod 1
check "NaN, infinity and negatives are taken as 0" \
    baked bad "$v/bad.vdb" --report "$work/bad.json"
check "  and counted in a notice" grep -q \
    "notice: 1 NaN, 1 infinite and 2 negative voxels" "$work/err"
check "  and in the report" test "$(figure bad.json nan) $(figure bad.json \
    infinite) $(figure bad.json negative)" = "1 1 2"

## Transforms ##

check "a rotation is used as it is" baked rotated "$v/rotated.vdb"
check "  to the same bricks" same_bricks float rotated
check "stretched voxels are resampled" baked stretched "$v/stretched.vdb"
check "  and reported" grep -q "notice: .*resampled to cubes" "$work/err"
check "  to twice the length along y" \
    test "$(header stretched cells)" = "5,8,5"
check "sheared voxels are resampled" baked sheared "$v/sheared.vdb"
refused "a frustum" 1 "frustum" "$v/frustum.vdb"

## Choice of grid ##

check "the grid named density is taken" baked two "$v/two.vdb"
check "  as if alone" cmp "$work/two.brume" "$work/float.brume"
refused "no density: a list" 2 "no grid named" "$v/fire.vdb"
check "  of both" test "$(grep -c '^  #[01]' "$work/err")" -eq 2
check "a grid by name" baked flame "$v/fire.vdb" --grid flame
check "a grid by index" baked index "$v/fire.vdb" --grid '#1'
check "  is the same" cmp "$work/flame.brume" "$work/index.brume"
refused "an index too high" 2 "no grid #2" "$v/fire.vdb" --grid '#2'
check "an odd name" baked name "$v/name.vdb" --report "$work/name.json"
check "  makes valid JSON" "$dump" json "$work/name.json"

## Formats, levels of detail, apron ##

for f in u8 u8r u4r; do
    for apron in "" --apron; do
        label="$f${apron:+ with apron}"
        check "$label bakes" baked f "$v/float.vdb" --format $f $apron \
            --report "$work/f.json" --dump-float "$work/f.raw"
        check "  distances, empty border, box, apron" \
            "$dump" verify "$work/f.brume"
        "$dump" verify "$work/f.brume" "$work/f.raw" >"$work/errors"
        rmse=$(sed -n 's/^rmse=//p' "$work/errors")
        # The largest density of the ball is 200.
        check "  the report's error is the dump's" near \
            "$(figure f.json rmse)" "$(awk "BEGIN { print 200 * $rmse }")"
        check "  the report is JSON" "$dump" json "$work/f.json"
    done
done
baked linear "$v/float.vdb" --order linear
check "linear order: other file, same size" test \
    "$(wc -c <"$work/linear.brume")" -eq "$(wc -c <"$work/float.brume")"
check "  and sound" "$dump" verify "$work/linear.brume"
check "linear order numbers cells as they come" sh -c \
    "'$dump' section '$work/linear.brume' CELL | od -An -v -tu4 -w4 |
     awk '\$1 < 2147483648 { if (\$1 > n) exit 1; if (\$1 == n) n++ }'"
check "--lod 1" baked lod "$v/tiles.vdb" --lod 1
check "  halves the box" test \
    "$(header tiles box_max) $(header lod box_max)" = "324,324,324 166,166,166"
check "  and moves the transform by half a voxel" test \
    "$(header lod world)" = "2,0,0,0.5,0,2,0,0.5,0,0,2,0.5"
check "--max-density" baked most "$v/float.vdb" --max-density 50.5
check "  becomes the maximum" test "$(header most density_max)" = 50.5
check "--max-density above the maximum" baked most "$v/float.vdb" \
    --max-density 1000
check "  changes nothing" cmp "$work/most.brume" "$work/float.brume"

## Real volumes ##

need() {
    [ -e "$DATA/$1" ] && return 0
    skip "needs $DATA/$1"
    return 1
}

robust=$DATA/robustness
if need wdas_cloud_sixteenth.vdb && need wdas_cloud_sixteenth_filled.vdb; then
    check "the Disney cloud" baked wdas "$DATA/wdas_cloud_sixteenth.vdb"
    check "  as u8" test "$(header wdas format)" = 1
    check "  sound" "$dump" verify "$work/wdas.brume"
    baked fill "$DATA/wdas_cloud_sixteenth_filled.vdb" --threads 1
    check "  voxelised: the same file" cmp "$work/wdas.brume" \
        "$work/fill.brume"
fi
if need openvdb_smoke1.vdb && need fvdb_smoke-blosc.nvdb; then
    check "the smoke" baked smoke "$DATA/openvdb_smoke1.vdb"
    check "  as u8r" test "$(header smoke format)" = 2
    check "the smoke as NanoVDB" baked nano "$DATA/fvdb_smoke-blosc.nvdb"
    check "  the same bricks" same_bricks smoke nano
    bad=
    for n in 4 12 100 190 1000 100000 2000000; do
        head -c $n "$DATA/fvdb_smoke-blosc.nvdb" >"$work/cut.nvdb"
        "$bake" "$work/cut.nvdb" -o "$work/c.brume" >"$work/out" 2>"$work/err"
        [ $? -eq 1 ] && [ "$(wc -l <"$work/err")" -eq 1 ] || bad="$bad $n"
    done
    check "truncated NanoVDB files are refused:$bad" test -z "$bad"
fi
fire=embergen_fire/embergen_fire_a
if need ${fire}_73.vdb; then
    refused "fire needs a choice" 2 "no grid named" "$DATA/${fire}_73.vdb"
    check "its flames" baked fire "$DATA/${fire}_73.vdb" --grid flames
    check "its temperature" baked heat "$DATA/${fire}_73.vdb" \
        --grid temperature
fi
if need ${fire}_0.vdb; then
    refused "fire without voxels" 1 "no active voxels" \
        "$DATA/${fire}_0.vdb" --grid flames
fi
if need robustness/scivis_grid0.vdb; then
    check "a grid with NaN and negatives" baked scivis \
        "$robust/scivis_grid0.vdb"
    check "  counted" grep -q "1 NaN, 0 infinite and 265260 negative" \
        "$work/err"
fi
if need robustness/arnoldusd_grids.vdb; then
    refused "three grids of one name" 2 "3 grids named" \
        "$robust/arnoldusd_grids.vdb"
    check "  listed" test "$(grep -c '^  #[012]  density' "$work/err")" -eq 3
    check "  the second" baked third "$robust/arnoldusd_grids.vdb" --grid '#1'
    refused "  by name" 2 "3 grids named" "$robust/arnoldusd_grids.vdb" \
        --grid density
fi
if need robustness/serg_box.vdb; then
    check "background 1" baked sbox "$robust/serg_box.vdb"
    check "  is noted" grep -q "notice: the background is 1" "$work/err"
    check "  inside the box" test "$(header sbox voxels)" = 9261
fi
if need robustness/serg_dragon_with_xform.vdb; then
    check "an affine transform" baked dragon \
        "$robust/serg_dragon_with_xform.vdb"
fi
if need robustness/openvdb_sphere.vdb; then
    refused "a level set" 1 "is a level set" "$robust/openvdb_sphere.vdb"
    check "  converted on demand" baked sphere \
        "$robust/openvdb_sphere.vdb" --level-set-to-fog
    check "  to densities up to 1" test "$(header sphere density_max)" = 1
fi
if need robustness/zeno_vel.vdb; then
    refused "velocities" 1 "vec3s" "$robust/zeno_vel.vdb"
fi
if need robustness/teapot_cloud-RENDER-0.85.nvdb; then
    refused "an old NanoVDB file" 1 "NanoVDB version" \
        "$robust/teapot_cloud-RENDER-0.85.nvdb"
fi
if need robustness/mitsuba_smoke.vol; then
    refused "a Mitsuba volume" 1 "neither" "$robust/mitsuba_smoke.vol"
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
