#!/bin/sh
# SPDX-License-Identifier: MIT
# One image: the core compiled in many ways gives the golden hashes, and small
# configurations give those of the scenes that they support.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
. tests/volumes.sh
out=$BUILD/builds
mkdir -p "$out"
files="core/*.c tests/support/asset_builder.c tests/support/asset_light.c
    tests/support/lighting.c tests/support/scenes.c tests/support/volumes.c
    tests/hash_scenes.c"

# build NAME COMPILER FLAGS...: the hashes go to $out/NAME.txt.
build()
{
    name=$1
    shift
    rm -f "$out/$name.txt"
    # shellcheck disable=SC2086
    "$@" -std=c11 -Icore -Itests $files -o "$out/$name" 2>"$out/$name.log" &&
        "./$out/$name" $volumes >"$out/$name.txt" 2>>"$out/$name.log"
}

same_hashes()
{
    # What the build cannot do, or has no volume for, is no difference.
    grep -Ev ' (feature|absent)$' "$out/$1.txt" >"$out/$1.has" || return 1
    [ "$(wc -l <"$out/$1.has")" -ge "$2" ] || return 1
    if grep -vxFf tests/golden/hashes.txt "$out/$1.has"; then
        return 1
    fi
}

# try NAME LEAST COMPILER FLAGS...: builds in the background, two at a time.
# judge then says of all that were tried what came of them.
tried=
running=0
try()
{
    name=$1 least=$2
    shift 2
    if ! command -v "$1" >/dev/null; then
        skip "$name: no $1 here"
        return
    fi
    tried="$tried $name=$least"
    build "$name" "$@" &
    running=$((running + 1))
    [ $((running % 2)) != 0 ] || wait
}

judge()
{
    wait
    for build in $tried; do
        name=${build%=*} least=${build#*=}
        [ -s "$out/$name.txt" ] || cat "$out/$name.log"
        check "$name: at least $least scenes have the golden hash" \
            same_hashes "$name" "$least"
    done
}

sanitize="-g -fsanitize=address,undefined -fno-sanitize-recover=all"
try gcc_O0 22 gcc -O0
try gcc_Os 22 gcc -Os
try gcc_O3_native 22 gcc -O3 -march=native
try gcc_unsigned_char 22 gcc -O2 -funsigned-char -fwrapv
try gcc_unrolled 22 gcc -O2 -DBRUME_UNROLL_LIGHT=1
try gcc_mul32 22 gcc -O2 -DBRUME_MUL64=0 -DBRUME_CLZ=0
# shellcheck disable=SC2086
try gcc_sanitizers 22 gcc -O1 $sanitize
try gcc_checked 22 gcc -O2 -DBRUME_FIXED_DEBUG
try clang_O0 22 clang -O0
try clang_O3 22 clang -O3
# shellcheck disable=SC2086
try clang_sanitizers 22 clang -O1 $sanitize -DBRUME_FIXED_DEBUG

# The configurations that docs/TARGETS.md offers: the scenes that each supports,
# at least so many.
for config in smallest=20 u4r_nearest=2 u8r_trilinear=4 preview=23 full=53; do
    try "config_${config%=*}" "${config#*=}" gcc -Os \
        -DBRUME_CONFIG="\"targets/configs/${config%=*}.h\""
done

# Parts of what sequences need, with one format and lookup.
for part in TEMPORAL=32 TAA=37 SPATIAL=33 RESOLUTION=39 NOISE=5; do
    try "without_$(echo "${part%=*}" | tr A-Z a-z)" "${part#*=}" gcc -Os \
        -DBRUME_WITH_U8R=0 -DBRUME_WITH_U4R=0 -DBRUME_WITH_TRILINEAR=0 \
        -DBRUME_WITH_UNIFORM=0 -DBRUME_WITH_APRON=0 \
        "-DBRUME_WITH_${part%=*}=0"
done

# Parts of lighting, likewise; each with the scenes that do not need it.
for part in AMBIENT=40 COLOUR=40 CONE=40 CACHE=40 STOCHASTIC=40 SKY=40 TONE=40 \
    DITHER=40 SHADOW=40 LAMPS=40 FOG=40 SURFACE=40 EMISSION=40; do
    try "without_$(echo "${part%=*}" | tr A-Z a-z)" "${part#*=}" gcc -Os \
        -DBRUME_WITH_U8R=0 -DBRUME_WITH_TRILINEAR=0 -DBRUME_WITH_UNIFORM=0 \
        "-DBRUME_WITH_${part%=*}=0"
done

judge

# Truncated, flipped and forged assets, where a bad access would trap.
hostile_assets()
{
    # shellcheck disable=SC2086
    gcc -std=c11 -D_POSIX_C_SOURCE=200809L -O1 $sanitize -Icore -Itests \
        "tests/$1.c" tests/support/asset_builder.c \
        tests/support/asset_light.c core/*.c \
        -o "$out/hostile" && "./$out/hostile" >"$out/hostile.log" 2>&1 ||
        { tail -n 20 "$out/hostile.log"; return 1; }
}
check "hostile assets under ASan and UBSan" hostile_assets test_asset
check "hostile sections for light, too" hostile_assets test_asset_light
hostile_emission()
{
    # shellcheck disable=SC2086
    gcc -std=c11 -D_POSIX_C_SOURCE=200809L -O1 $sanitize -Icore -Itests \
        -Itables tests/test_emission.c tests/support/asset_builder.c \
        tests/support/asset_light.c tests/support/lighting.c \
        tests/support/lit.c tests/support/scenes.c core/*.c \
        -o "$out/hostile" -lm && "./$out/hostile" >"$out/hostile.log" 2>&1 ||
        { tail -n 20 "$out/hostile.log"; return 1; }
}
check "hostile second grids, too" hostile_emission

# mono.h has no colour: grey pixels, against those of the full configuration.
build config_mono gcc -Os -DBRUME_CONFIG='"targets/configs/mono.h"' ||
    cat "$out/config_mono.log"
same_greys()
{
    # shellcheck disable=SC2086
    "./$out/config_full" --grey $volumes >"$out/greys.txt"
    # shellcheck disable=SC2086
    "./$out/config_mono" --grey $volumes >"$out/config_mono.txt"
    grep -Ev ' (feature|absent)$' "$out/config_mono.txt" >"$out/mono.has"
    [ "$(wc -l <"$out/mono.has")" -ge 1 ] &&
        ! grep -vxFf "$out/greys.txt" "$out/mono.has"
}
check "config_mono: at least 1 scene has the full configuration's greys" \
    same_greys

# refuses FLAGS PATTERN: the preprocessor stops, and says why.
refuses()
{
    # shellcheck disable=SC2086
    ! gcc -fsyntax-only -Icore $1 core/brume.c 2>"$out/refused.log" &&
        grep -q "#error \"brume: $2" "$out/refused.log"
}
no_format="-DBRUME_WITH_U8=0 -DBRUME_WITH_U8R=0 -DBRUME_WITH_U4R=0"
check "no format: an #error" refuses "$no_format" "no format"
check "no lookup: an #error" refuses \
    "-DBRUME_WITH_NEAREST=0 -DBRUME_WITH_TRILINEAR=0" "no lookup"
check "taa alone: an #error" refuses \
    "-DBRUME_WITH_TEMPORAL=0 -DBRUME_WITH_TAA=1" "BRUME_WITH_TAA needs"
check "sequences without the whole: an #error" refuses \
    "-DBRUME_WITH_SEQUENCES=0 -DBRUME_WITH_SPATIAL=1" "set BRUME_WITH_SEQ"
for limit in MAX_SIZE=16385 MAX_SIZE=0 MAX_LOG_SAMPLES=17 \
    MAX_UNIFORM_SAMPLES=4097 SPAN=65 SPAN=0; do
    check "$limit: an #error" refuses "-DBRUME_$limit" "BRUME_${limit%=*} is"
done

every_configuration_is_tried()
{
    for header in tests/targets/configs/*.h; do
        [ -f "$out/config_$(basename "$header" .h).txt" ] || return 1
    done
}
check "every header of tests/targets/configs is tried" \
    every_configuration_is_tried
finish
