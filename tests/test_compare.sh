#!/bin/sh
# SPDX-License-Identifier: MIT
# `brume compare`: what it prints, sequences, maps, formats, and what it says
# to bad input. The figures themselves are those of test_metrics and test_image.
set -u
: "${BUILD:=build}"
. tests/lib.sh
. tests/cli_lib.sh
brume=$BUILD/brume

# pgm NAME WIDTH HEIGHT VALUE: a flat grey picture
pgm()
{
    {
        printf 'P5\n%d %d\n255\n' "$2" "$3"
        head -c $(($2 * $3)) /dev/zero | tr '\0' "$(printf '\\%03o' "$4")"
    } >"$work/$1"
}

# pfm NAME MAGIC SCALE FLOATS: two pixels, FLOATS as octal escapes of bytes
pfm() { printf '%s\n2 1\n%s\n%b' "$2" "$3" "$4" >"$work/$1"; }

# is NAME VALUE: what the last command printed
is()
{
    grep -qx "$1=$2" "$out" && return
    echo "# wanted $1=$2, got $(grep "^$1=" "$out")"
    return 1
}

# compares A B NAME VALUE: one figure of two pictures
compares()
{
    runs "$brume" compare "$work/$1" "$work/$2" --metrics "$3" && is "$3" "$4"
}

test_pair()
{
    a=$work/a.pgm b=$work/b.pgm
    pgm a.pgm 32 24 100
    pgm b.pgm 32 24 120
    check "all metrics of a pair" runs "$brume" compare "$a" "$b"
    names=$(sed 's/=.*//' "$out" | tr '\n' ' ')
    check "one a line" [ "$names" = \
        "rmse mean psnr max worst_tile ssim flip flip_max sharpness " ]
    check "mean of B - A" is mean 20.000000
    check "ssim of flat pictures" is ssim 0.983611
    check "a list" runs "$brume" compare "$a" "$b" --metrics max,rmse
    check "and nothing else" [ "$(tr '\n' ' ' <"$out")" = \
        "rmse=20.000000 max=20.000000 " ]
    check "0 within the limit" runs "$brume" compare "$a" "$b" --max-rmse 20
    "$brume" compare "$a" "$b" --max-rmse 19.9 >"$out" 2>"$err"
    status=$?
    check "1 above it" [ "$status" -eq 1 ]
}

test_maps()
{
    pgm a.pgm 32 24 100
    pgm b.pgm 32 24 120
    check "heat and flip" runs "$brume" compare "$work/a.pgm" "$work/b.pgm" \
        --heat "$work/heat.png" --flip "$work/flip.png" --heat-max 40
    check "they are pictures" runs "$brume" compare "$work/heat.png" \
        "$work/flip.png"
    # 20 of 40 lies half way between the fifth and the sixth colour
    {
        printf 'P6\n32 24\n255\n'
        i=0
        while [ $i -lt 768 ]; do
            printf '\266\070\170'
            i=$((i + 1))
        done
    } >"$work/half.ppm"
    check "half of --heat-max is the middle of magma" \
        compares half.ppm heat.png max 0.000000
    fails_pair "--heat not a png" 'must end in .png' --heat "$none/h.ppm"
    fails_pair "--flip of no format" 'unknown extension' --flip "$none/h"
    fails_pair "--heat-max alone" 'needs --heat' --heat-max 3
    fails_pair "a folder that is not there" 'cannot write' \
        --heat "$none/no/h.png"
}

# fails_pair NAME PATTERN OPTIONS...
fails_pair()
{
    name=$1 pattern=$2
    shift 2
    check "refused: $name" fails 2 "$pattern" "$brume" compare \
        "$work/a.pgm" "$work/b.pgm" "$@"
}

test_usage()
{
    fails_pair "three pictures" 'more than two' "$work/a.pgm"
    fails_pair "no such metric" "no metric 'rsme'" --metrics rmse,rsme
    fails_pair "an empty list" "no metric ''" --metrics ''
    fails_pair "--metrics without a list" 'needs a list' --metrics
    fails_pair "--ppd 0" 'from 1 up' --ppd 0
    fails_pair "--ppd 201" 'at most 200' --ppd 201
    fails_pair "--csv of a pair" 'needs --frames' --csv "$none/t.csv"
    for frames in 3:1 a:b 1 1: :2 -1:2 0:4294967296; do
        fails_pair "--frames $frames" "frames $frames: must be" \
            --frames "$frames"
    done
    fails_pair "frames without a pattern" 'needs a name with %d' --frames 0:1
    check "refused: two numbers in a name" fails 2 'no other %' "$brume" \
        compare "$work/%d_%d.pgm" "$work/a.pgm" --frames 0:1
    check "refused: --heat of frames" fails 2 'not of --frames' "$brume" \
        compare "$work/%d.pgm" "$work/a.pgm" --frames 0:1 \
        --heat "$none/h.png"
    pgm large.pgm 33 24 100
    check "refused: another size" fails 2 'a.pgm and .*large.pgm: sizes' \
        "$brume" compare "$work/a.pgm" "$work/large.pgm"
}

test_sequence()
{
    for k in 0 1 2 3; do
        pgm "ref_0$k.pgm" 16 16 $((50 + 10 * k))
        pgm "late_0$k.pgm" 16 16 $((40 + 10 * k))
        pgm "blink_0$k.pgm" 16 16 $((50 + 6 * (k % 2)))
    done
    pgm still.pgm 16 16 53
    check "a sequence" runs "$brume" compare "$work/ref_%02d.pgm" \
        "$work/late_%02d.pgm" --frames 0:3 --csv "$work/table.csv"
    check "a frame late" is lag 1.000000
    check "it ghosts" is ghosting 10.000000
    check "and does not flicker" is flicker 0.000000
    check "tpsnr" is tpsnr inf
    check "five more metrics" [ "$(wc -l <"$out")" -eq 14 ]
    check "a line for each frame" [ "$(wc -l <"$work/table.csv")" -eq 5 ]
    check "as CSV" grep -q '^2,10.000000,-10.000000,' "$work/table.csv"
    check "one picture for all frames" runs "$brume" compare \
        "$work/still.pgm" "$work/blink_%02d.pgm" --frames 0:3
    check "flicker of 6" is flicker 6.000000
    check "deviation of 3" is deviation 3.000000
    check "rmse over all" is rmse 3.000000
    check "frames from 2 on" runs "$brume" compare "$work/ref_%02d.pgm" \
        "$work/blink_%02d.pgm" --frames 2:2 --metrics mean
    check "are those" is mean -20.000000
    check "refused: a frame that is not there" fails 2 'ref_04' "$brume" \
        compare "$work/ref_%02d.pgm" "$work/still.pgm" --frames 0:4 \
        --csv "$none/t.csv"
    pgm ref_01.pgm 16 17 0
    pgm late_01.pgm 16 17 0
    check "refused: another size in time" fails 2 'ref_01.*before it' \
        "$brume" compare "$work/ref_%02d.pgm" "$work/late_%02d.pgm" \
        --frames 0:3
}

test_floats()
{
    pgm one.pgm 2 1 255
    pfm le.pfm Pf -1.0 '\0\0\0200\077\0\0\0200\077'
    pfm be.pfm Pf 1.0 '\077\0200\0\0\077\0200\0\0'
    one='\0\0\0200\077'
    pfm rgb.pfm PF -1 "$one$one$one$one$one$one"
    pfm nan.pfm Pf -1.0 '\0\0\0200\077\0\0\0300\0177'
    pfm inf.pfm Pf 1.0 '\0177\0200\0\0\077\0200\0\0'
    check "255 is 1.0, little-endian" compares one.pgm le.pfm max 0.000000
    check "big-endian" compares one.pgm be.pfm max 0.000000
    check "RGB floats" compares one.pgm rgb.pfm max 0.000000
    check "refused: NaN, with its place" fails 2 'nan.pfm.*row 0, column 1' \
        "$brume" compare "$work/le.pfm" "$work/nan.pfm"
    check "refused: infinity, with its place" fails 2 \
        'inf.pfm.*row 0, column 0' "$brume" compare "$work/le.pfm" \
        "$work/inf.pfm"
}

pgm a.pgm 32 24 100
pgm b.pgm 32 24 120
mkdir "$none"
test_pair
test_maps
test_usage
test_sequence
test_floats
finish
