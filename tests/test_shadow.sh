#!/bin/sh
# SPDX-License-Identifier: MIT
#
# brume shadow as a user meets it: words, exit statuses, files, and where in the
# world the shadow falls. BUILD is the folder of brume, brume-bake and
# brume-cloud.
BUILD=${BUILD:-build}
. "$(dirname "$0")/lib.sh"
brume=$BUILD/brume
. "$(dirname "$0")/cli_lib.sh"
# shellcheck disable=SC2154 # of cli_lib.sh
volume=$work/cloud.brume

# shadow OUT ARGUMENT...: a map of the volume
shadow()
{
    file=$1
    shift
    runs "$brume" shadow "$volume" "$@" -o "$work/$file"
}

# no_map STATUS PATTERN ARGUMENT...
no_map()
{
    want=$1 pattern=$2
    shift 2
    fails "$want" "$pattern" "$brume" shadow "$@" -o "$none/out.png"
}

same() { cmp "$work/$1" "$work/$2"; }

# pgm FILE: width, height and grey values of a binary PGM of 8 bits, one a line
pgm()
{
    sed -n '2s/ /\n/p' "$1" && tail -c +"$(($(head -n 3 "$1" | wc -c) + 1))" \
        "$1" | od -An -v -tu1 -w1
}

# middle FILE: column and row of the shadow's centre, in thousandths
middle()
{
    pgm "$1" | awk 'NR == 1 { w = $1 } NR == 2 { h = $1 }
        NR > 2 { i = NR - 3; d = 255 - $1; n += d; x += d * (i % w + 0.5)
                 y += d * (int(i / w) + 0.5) }
        END { if (n) printf "%d %d\n", 1000 * x / n / w, 1000 * y / n / h }'
}

# near A B: pairs that differ by 30 at most
near()
{
    echo "$1 $2" | awk '{ x = $1 - $3; y = $2 - $4
        exit !(NF == 4 && x * x <= 900 && y * y <= 900) }' && return
    echo "# $1 is not $2"
    return 1
}

test_help()
{
    runs "$brume" shadow --help
    check "brume shadow --help" grep -q '^usage: brume shadow' "$out"
    runs "$brume" --help
    check "brume --help lists it" grep -q '^  shadow ' "$out"
}

test_usage()
{
    check "brume shadow alone" fails 2 'no volume' "$brume" shadow
    check "no output" fails 2 'no -o' "$brume" shadow "$volume"
    check "unknown option" no_map 2 'unknown.*--bogus' "$volume" --bogus
    check "option without a value" fails 2 'no value after --plane' \
        "$brume" shadow "$volume" --plane
    check "two volumes" no_map 2 'unexpected' "$volume" "$volume"
    for size in 10 10x 0x10 10x16385 10x10x10 -1x10 axb 1e1x10; do
        check "--size $size" no_map 2 '--size is WxH' "$volume" --size $size
    done
    for area in 1,2,3 1,2,3,4,5 1,2,3,x 1,2,3,inf ''; do
        check "--area '$area'" no_map 2 '--area is' "$volume" --area "$area"
    done
    for plane in x 1x nan ''; do
        check "--plane '$plane'" no_map 2 '--plane is' "$volume" \
            --plane "$plane"
    done
    check "--threads 0" no_map 2 '--threads is 1 to 256' "$volume" --threads 0
    check "--heights alone" no_map 2 'go together' "$volume" --heights x.pgm
    check "--rise alone" no_map 2 'go together' "$volume" --rise 3
    check "--heights and --size" no_map 2 'that of --heights' "$volume" \
        --heights x.pgm --rise 3 --size 3x3
}

test_input()
{
    check "no such volume" no_map 2 'none.brume' "$work/none.brume"
    check "bad key" no_map 2 'bogus' "$volume" --set bogus=1
    check "no such scene" no_map 2 'none.scene' "$volume" \
        --scene "$work/none.scene"
    check "no such heights" no_map 2 'none.pgm' "$volume" \
        --heights "$work/none.pgm" --rise 1
    printf 'P6\n1 1\n255\nabc' >"$work/colour.ppm"
    check "heights with colour" no_map 2 'grey picture' "$volume" \
        --heights "$work/colour.ppm" --rise 1
    check "an extension that is none of a map" fails 2 'png or a .pgm' \
        "$brume" shadow "$volume" -o "$none/out.pfm"
    check "depth that is no .pgm" no_map 2 'depths are a .pgm' "$volume" \
        --depth "$none/depth.png"
    check "no folder for the depth: no map" no_map 1 'none/none' "$volume" \
        --depth "$none/none/depth.pgm"
    check "the sun on the horizon" no_map 2 'on the horizon' "$volume" \
        --set sun=0,0
    check "the sun below the ground" no_map 2 'sun is below it' "$volume" \
        --set sun=0,-30
    check "ground above the volume" no_map 2 'sun is above it' "$volume" \
        --plane 1e6
    check "an area out of reach" no_map 2 'can be reached' "$volume" \
        --area 0,0,1e9,1
}

# Where the shadow of a ball falls: away from the sun, further on a lower plane.
# Its centre is at 15.5 on all axes, the map 128 wide around there.
test_place()
{
    while read -r sun plane want; do
        runs "$brume" shadow "$work/ball.brume" --set sun="$sun" \
            --set light_density_scale=1 --plane "$plane" \
            --area -48.5,-48.5,79.5,79.5 --size 64x64 -o "$work/map.pgm"
        check "sun at $sun, plane at $plane" \
            near "$(middle "$work/map.pgm")" "$want"
    done <<END
0,90 -16.5 500 500
90,45 -16.5 250 500
-90,45 -16.5 750 500
0,45 -16.5 500 250
180,45 -16.5 500 750
90,45 -0.5 375 500
0,-45 47.5 500 250
END
}

test_same()
{
    shadow a.png --threads 1 --depth "$work/a.pgm" --front "$work/a2.pgm"
    shadow b.png --threads 7 --depth "$work/b.pgm" --front "$work/b2.pgm"
    check "any number of threads gives the same map" same a.png b.png
    check "and the same depths" same a.pgm b.pgm
    check "and the same fronts" same a2.pgm b2.pgm
    shadow b.png --set skip=off
    check "skip on and off" same a.png b.png
    shadow a.pgm
    check "the map says where it lies" grep -qx 'size=[0-9]*x[0-9]*' "$out"
    # shellcheck disable=SC2046
    set -- $(tr '=,x' '   ' <"$out" | awk '{ $1 = ""; print }')
    shadow b.pgm --plane "$1" --area "$2,$3,$4,$5" --size "$6x$7"
    check "which gives the same again" same a.pgm b.pgm
    awk -v w="$6" -v h="$7" 'BEGIN { printf "P5\n%d %d\n255\n", w, h
        for (i = 0; i < w * h; i++) printf "~" }' >"$work/flat.pgm"
    shadow b.pgm --plane "$1" --area "$2,$3,$4,$5" --heights "$work/flat.pgm" \
        --rise 0
    check "flat heights are a plane" same a.pgm b.pgm
}

# make NAME OPTION...: a cloud, baked
make()
{
    name=$1
    shift
    "$BUILD/brume-cloud" "$@" -o "$work/$name.vdb" >/dev/null &&
        "$BUILD/brume-bake" "$work/$name.vdb" -o "$work/$name.brume" \
            >/dev/null
}

check "a cloud" make cloud --size 48
check "a ball" make ball --size 32 --type sphere
test_help
test_usage
test_input
test_place
test_same
finish
