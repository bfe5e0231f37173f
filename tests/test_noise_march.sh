#!/bin/sh
# SPDX-License-Identifier: MIT
# What docs/noise.md says of noises under a real march: the integrands of
# jittered view rays are periodic, those of light rays are not, and so which
# noise is best differs.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
. tests/volumes.sh
out=$BUILD/noise_march
mkdir -p "$out"

# row FILE NAME COLUMN: a figure of a noise.
row()
{
    awk -v name="$2" -v column="$3" '$1 == name { print $column }' "$out/$1"
}

# below FILE NAME OTHER COLUMN FACTOR: at most that factor of the other's.
below()
{
    awk -v a="$(row "$1" "$2" "$4")" -v b="$(row "$1" "$3" "$4")" -v f="$5" '
        BEGIN { print a, b; exit !(a > 0 && b > 0 && a <= f * b) }'
}

# The correlation at a lag of 15/16, the 16th of the lags.
correlation()
{
    awk -v low="$2" -v high="$3" '
        $1 == "march" { c = $17; print c }
        END { exit !(c >= low && c <= high) }' "$out/$1"
}

measure()
{
    file=$1
    shift
    "$BUILD/tests/noise_march" "$@" golden fast stbn >"$out/$file"
}

if [ -z "$volumes" ]; then
    skip "noises under a march: needs real volumes"
    finish
fi
disney=$BUILD/volumes/wdas_u8.brume
measure view "$disney" primary 8 &
measure light "$disney" light 1 || true
wait
measured()
{
    grep -q '^stbn ' "$out/$1"
}
check "Disney cloud, view rays: measured" measured view
check "Disney cloud, light rays: measured" measured light
check "view rays: a lag of 15/16 correlates by 0.7 to 1" \
    correlation view 0.7 1
check "light rays: a lag of 15/16 anticorrelates by 1 to 2" \
    correlation light -2 -1
check "view rays, ema: golden leaves at most 0.32 of white's error" \
    below view golden white 3 0.32
check "view rays, ema and gauss1: golden at most 0.8 of fast" \
    below view golden fast 4 0.8
check "view rays, ema and gauss1: golden at most 0.55 of stbn" \
    below view golden stbn 4 0.55
check "light rays, ema and gauss1: fast at most 0.6 of golden" \
    below light fast golden 4 0.6
check "light rays, ema and gauss1: fast at most 0.65 of stbn" \
    below light fast stbn 4 0.65
finish
