#!/bin/sh
# SPDX-License-Identifier: MIT
#
# brume surface and brume render --over as a user meets them: words, exit
# statuses, files. BUILD is the folder of brume, brume-bake and brume-cloud.
BUILD=${BUILD:-build}
. "$(dirname "$0")/lib.sh"
brume=$BUILD/brume
. "$(dirname "$0")/cli_lib.sh"
# shellcheck disable=SC2154 # of cli_lib.sh
volume=$work/cloud.brume

# surface ARGUMENT...: of a pyramid over a ground
surface()
{
    runs "$brume" surface "$volume" --set size=64x48 \
        --mesh "$work/good.obj" --area -90,-90,90,90 "$@"
}

# nothing STATUS PATTERN ARGUMENT...: and nothing is made
nothing()
{
    want=$1 pattern=$2
    shift 2
    fails "$want" "$pattern" "$brume" surface "$@" --depth "$none/d.pgm" \
        --colour "$none/c.png" --sun-map "$none/s.pgm"
}

same() { cmp "$work/$1" "$work/$2"; }

render()
{
    file=$1
    shift
    runs "$brume" render "$volume" --set size=64x48 "$@" -o "$work/$file"
}

test_help()
{
    runs "$brume" surface --help
    check "brume surface --help" grep -q '^usage: brume surface' "$out"
    runs "$brume" --help
    check "brume --help lists it" grep -q '^  surface ' "$out"
    runs "$brume" render --help
    check "brume render --help knows --over" grep -q -- '--over' "$out"
}

test_usage()
{
    good=$work/good.obj
    check "brume surface alone" fails 2 'no volume' "$brume" surface
    check "no things" nothing 2 'no things' "$volume"
    check "no output" fails 2 'no output' "$brume" surface "$volume" \
        --mesh "$good"
    check "unknown option" nothing 2 'unknown.*--bogus' "$volume" --bogus 1
    check "option without a value" fails 2 'no value after --mesh' \
        "$brume" surface "$volume" --mesh
    check "two volumes" nothing 2 'unexpected' "$volume" "$volume"
    while read -r option value; do
        check "$option $value" nothing 2 "$option is" "$volume" \
            --mesh "$good" "$option" "$value"
    done <<END
--size 10
--size 0x4
--size 16385x1
--area 1,2,3
--area 1,2,3,nan
--plane x
--rise 1,2
--bias -1
--albedo 1.5
--albedo 0.1,0.2
--albedo -0.1
--sky 17
--sky 1,2
--cover 1,2,3,4,5
--shadow-area 1,2,1,3
--samples 0
--samples 17
--threads 257
END
    check "--plane without --area" nothing 2 'say its --area' "$volume" \
        --mesh "$good" --plane 3
    check "--heights without --rise" nothing 2 'go together' "$volume" \
        --area 0,0,1,1 --heights x.pgm
    check "--area twice" nothing 2 'twice' "$volume" --area 0,0,1,1 \
        --area 0,0,1,1
    check "--shadow on hills" nothing 2 'level ground' "$volume" \
        --area 0,0,1,1 --heights x.pgm --rise 1 --shadow s.png
    check "--shadow-area alone" nothing 2 'without --shadow' "$volume" \
        --area 0,0,1,1 --shadow-area 0,0,1,1
    check "two outputs in one file" fails 2 'in one file' "$brume" surface \
        "$volume" --mesh "$good" --depth "$none/a.png" --colour "$none/a.png"
    check "a depth that is no grey picture" fails 2 'a .pgm or a .png' \
        "$brume" surface "$volume" --mesh "$good" --depth "$none/a.ppm"
    check "a colour that has none" fails 2 'a .ppm or a .pfm' \
        "$brume" surface "$volume" --mesh "$good" --colour "$none/a.pgm"
    check "a sun map without comments" fails 2 'is a .pgm' \
        "$brume" surface "$volume" --mesh "$good" --sun-map "$none/a.png"
}

test_input()
{
    check "no such volume" nothing 2 'none.brume' "$work/none.brume" \
        --mesh "$work/good.obj"
    check "no such mesh" nothing 2 'none.obj' "$volume" \
        --mesh "$work/none.obj"
    check "a mesh that is a folder" nothing 2 'cannot read' "$volume" \
        --mesh "$work"
    check "bad key" nothing 2 'bogus' "$volume" --set bogus=1 \
        --mesh "$work/good.obj"
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n' >"$work/bad.obj"
    check "a bad line is named" nothing 2 'bad.obj:3: not a finite' "$volume" \
        --mesh "$work/good.obj" --mesh "$work/bad.obj"
    : >"$work/empty.obj"
    check "an empty mesh" nothing 2 'empty.obj: no faces' "$volume" \
        --mesh "$work/empty.obj"
    head -c 100000 /dev/zero >"$work/zero.obj"
    check "a mesh of zeros" nothing 2 'zero.obj:1: ' "$volume" \
        --mesh "$work/zero.obj"
    printf 'P5 60000 60000 65535\nxx' >"$work/huge.pgm"
    check "heights cut short" nothing 2 'huge.pgm: truncated' "$volume" \
        --area 0,0,1,1 --heights "$work/huge.pgm" --rise 1
    printf 'P6\n1 1\n255\nabc' >"$work/colour.ppm"
    check "heights with colour" nothing 2 'neither a .pgm nor a .png' \
        "$volume" --area 0,0,1,1 --heights "$work/colour.ppm" --rise 1
    check "a shadow with colour" nothing 2 'grey picture' "$volume" \
        --area 0,0,1,1 --shadow "$work/colour.ppm"
    check "things out of the sun map's reach" nothing 2 'can be reached' \
        "$volume" --area -1e6,0,1e6,1
    check "no folder for one: none of all" fails 1 'none/none' "$brume" \
        surface "$volume" --mesh "$work/good.obj" --depth "$none/d.pgm" \
        --sun-map "$none/none/s.pgm"
    i=0
    set -- "$volume"
    while [ $i -lt 33 ]; do
        set -- "$@" --mesh "$work/good.obj"
        i=$((i + 1))
    done
    check "33 things" nothing 2 'more than 32' "$@"
}

test_same()
{
    surface --threads 1 --samples 2 --depth "$work/a.pgm" \
        --colour "$work/a.png" --sun-map "$work/a_sun.pgm" --size 100x70
    check "it counts triangles" grep -qx 'triangles=8' "$out"
    surface --threads 3 --samples 2 --depth "$work/b.pgm" \
        --colour "$work/b.png" --sun-map "$work/b_sun.pgm" --size 100x70
    check "any number of threads gives the same depth" same a.pgm b.pgm
    check "the same picture" same a.png b.png
    check "the same sun map" same a_sun.pgm b_sun.pgm
    check "the sun map says where it is" grep -qa '^# brume-sun-map 1$' \
        "$work/a_sun.pgm"
    surface --depth "$work/c.png" --colour "$work/c.ppm"
    surface --depth "$work/d.png" --colour "$work/d.pfm"
    check "depth as a PNG" [ -s "$work/c.png" ]
    render flat.ppm --set density_scale=0 --over "$work/c.ppm"
    check "what nothing covers comes back" same c.ppm flat.ppm
    render wide.ppm --set density_scale=0 --over "$work/d.pfm" \
        --set background=0
    check "as linear floats too" same c.ppm wide.ppm
}

# Over a picture of one colour, a volume looks as before that background. Codes
# 64, 128 and 188 in linear light, as near as a scene says it.
test_over()
{
    background=0.051269531,0.215866089,0.502883911
    render plain.png --set background=$background --set density_scale=0
    while read -r name options; do
        # shellcheck disable=SC2086
        render want.png --set background=$background $options
        # shellcheck disable=SC2086
        render over.png --over "$work/plain.png" $options
        check "over a plain picture: $name" same want.png over.png
    done <<END
alone
filters --set spatial=bilateral15
history --set temporal=ema
halves --set resolution=half --set upsample=aware
tone --set output=filmic --set exposure=2
colour --set sun_colour=2,1,0.5 --set haze=100
panel --pixels rgb565
END
    check "over a picture of another size" fails 2 '32x16' "$brume" render \
        "$volume" --set size=32x16 --over "$work/plain.png" -o "$none/a.png"
    check "over no picture" fails 2 'none.png' "$brume" render "$volume" \
        --over "$work/none.png" -o "$none/a.png"
    for pixels in l4 l1 rgba8888; do
        check "over a picture, in $pixels" fails 2 'over takes' "$brume" \
            render "$volume" --set size=64x48 --over "$work/plain.png" \
            --pixels $pixels -o "$none/a.png"
    done
}

# A shadow that takes all of the sun leaves the sky's light.
test_shadow()
{
    printf 'P5\n2 1\n255\n\377\000' >"$work/half.pgm"
    runs "$brume" surface "$volume" --set size=64x48 --set eye=0,50,0 \
        --set target=0,0,0 --set up=0,0,-1 --set fov=80 --set sun=0,90 \
        --area -60,-60,60,60 --albedo 0.2 --shadow "$work/half.pgm" \
        --colour "$work/half.ppm"
    # 0.2 * (4 + 0.1) and 0.2 * 0.1: codes 233.65 and 38.68
    check "half of the ground is in shadow" [ "$(tail -c 192 "$work/half.ppm" |
        od -An -v -tu1 -w192 | awk '{ print $1, $190 }')" = "234 39" ]
    runs "$brume" surface "$volume" --set size=64x48 --set eye=0,50,0 \
        --set target=0,0,0 --set up=0,0,-1 --set fov=80 --set sun=0,90 \
        --area -900,-900,900,900 --albedo 0.2 --shadow "$work/half.pgm" \
        --shadow-area -60,-60,60,60 --colour "$work/wide.ppm"
    check "its area may be a part of the ground" same half.ppm wide.ppm
}

# What the files are for: a wall before the volume hides it, one behind it does
# not; under a roof it has the light of no sun, under one that is elsewhere that
# of all.
test_core()
{
    view="--set eye=16,16,-60 --set target=16,16,16 --set fov=50"
    sun="--set sun=0,90 --set ambient=constant"
    for wall in "before -40" "behind 60"; do
        name=${wall% *} z=${wall#* }
        printf 'v -200 -200 %d\nv 200 -200 %d\nv 0 400 %d\nf 1 2 3\n' \
            "$z" "$z" "$z" >"$work/$name.obj"
        # shellcheck disable=SC2086
        runs "$brume" surface "$volume" --set size=64x48 $view --mesh \
            "$work/$name.obj" --depth "$work/$name.png" \
            --colour "$work/$name.ppm"
        # shellcheck disable=SC2086
        render "${name}_ends.ppm" $view --over "$work/$name.ppm" \
            --set surface="$work/$name.png"
        # shellcheck disable=SC2086
        render "${name}_all.ppm" $view --over "$work/$name.ppm"
    done
    check "a wall before the volume hides it" same before.ppm before_ends.ppm
    check "one behind it does not" same behind_all.ppm behind_ends.ppm
    check "of which there is something" differs behind.ppm behind_all.ppm
    for roof in "over 0" "aside 1000"; do
        name=${roof% *} x=${roof#* }
        printf 'v %d 90 -300\nv %d 90 -300\nv %d 90 500\nf 1 2 3\n' \
            $((x - 300)) $((x + 300)) "$x" >"$work/$name.obj"
        # shellcheck disable=SC2086
        runs "$brume" surface "$volume" --set size=64x48 $view $sun \
            --mesh "$work/$name.obj" --sun-map "$work/$name.pgm" --size 300x300
        # shellcheck disable=SC2086
        render "$name.ppm" $view $sun --set sun_map="$work/$name.pgm"
    done
    # shellcheck disable=SC2086
    render dark.ppm $view $sun --set sun_colour=0
    # shellcheck disable=SC2086
    render light.ppm $view $sun
    check "under a roof there is no sun" same over.ppm dark.ppm
    check "under one that is elsewhere there is" same aside.ppm light.ppm
    check "which tells" differs light.ppm dark.ppm
}

differs() { ! cmp -s "$work/$1" "$work/$2"; }

"$BUILD/brume-cloud" -o "$work/cloud.vdb" --size 32 >/dev/null &&
    "$BUILD/brume-bake" "$work/cloud.vdb" -o "$volume" >/dev/null || exit 1
cat >"$work/good.obj" <<END
# a pyramid
v 0 0 0
v 30 0 0
v 30 0 30
v 0 0 30
v 15 40 15
f 1 2 3 4
f 1/1 5/2 2/3
f 2 5 3
f 3//1 5//1 4//1
f -2 -1 -5
END
test_help
test_usage
test_input
test_same
test_over
test_shadow
test_core
finish
