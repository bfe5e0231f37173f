#!/bin/sh
# SPDX-License-Identifier: MIT
# The compressor of the hosts' PNGs gives the same bytes on the Linux targets
# whose tools are here, at three levels of optimisation: compilers have made
# streams of it that nobody could read (see struct code_table).
set -eu
: "${BUILD:=build}" "${CC:=cc}"
. tests/lib.sh
out=$BUILD/deflate
rm -rf "$out"
mkdir -p "$out"

# build FILE COMPILER FLAG...
build()
{
    program=$out/$1
    shift
    "$@" -std=c11 -D_POSIX_C_SOURCE=200809L -Icore -Iplatform/host \
        tests/targets/deflate.c platform/host/deflate*.c \
        platform/host/inflate.c platform/host/crc32.c platform/host/pool.c \
        -o "$program" -lpthread
}

# same NAME COMMAND...: prints what the host's program prints.
same()
{
    printed=$out/$1.txt
    shift
    "$@" >"$printed" && cmp "$printed" "$out/host.txt"
}

# shellcheck disable=SC2086 # CC may have words
check "it compiles" build host $CC -O2
"$out/host" >"$out/host.txt" || true
check "texts come back" [ "$(grep -c 'comes back$' "$out/host.txt")" = 2 ]
for target in platform/linux-*/conf.mk; do
    target=$(basename "$(dirname "$target")")
    eval "$(env -u CC -u CFLAGS make -s BUILD="$BUILD" CONF="$target" \
        target-info)"
    # shellcheck disable=SC2154 # of target-info
    for tool in $tools; do
        command -v "$tool" >/dev/null || {
            skip "$target: no $tool here"
            continue 2
        }
    done
    # shellcheck disable=SC2154,SC2086 # of target-info; CC may have words
    for level in -O1 -O2 -O3; do
        file=$target$level
        check "$target $level compiles" build "$file" $cc $level -static
        check "$target $level: the same bytes" same "$file" \
            $run "$out/$file"
    done
done
finish
