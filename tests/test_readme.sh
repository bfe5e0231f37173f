#!/bin/sh
# SPDX-License-Identifier: MIT
# The README's C example compiles without a warning, runs, and draws what the
# command draws; the commands that it shows exist.
set -eu
: "${BUILD:=build}" "${CC:=cc}"
. tests/lib.sh
out=$BUILD/readme
rm -rf "$out"
mkdir -p "$out"

sed -n '/^```c$/,/^```$/p' README.md | sed '/^```/d' >"$out/example.c"
check "the example is 25 to 40 lines" \
    test "$(wc -l <"$out/example.c")" -ge 25 -a \
    "$(wc -l <"$out/example.c")" -le 40
check "it compiles" $CC -std=c99 -O2 -Wall -Wextra -Wshadow -Wconversion \
    -Werror -Icore "$out/example.c" core/*.c -o "$out/example"

"$BUILD/brume-cloud" -o "$out/cloud.vdb" --size 64 >/dev/null
"$BUILD/brume-bake" "$out/cloud.vdb" -o "$out/cloud.brume" >/dev/null
"$BUILD/brume" render "$out/cloud.brume" --set size=320x240 -o "$out/brume.ppm"
draws_the_same()
{
    "$out/example" "$out/cloud.brume" >"$out/example.ppm" &&
        cmp "$out/example.ppm" "$out/brume.ppm"
}
check "it draws what brume render draws" draws_the_same
refuses()
{
    ! "$out/example" README.md 2>"$out/error" >/dev/null &&
        grep -q "not a brume asset" "$out/error"
}
check "it refuses what is no asset" refuses

for target in demo test help install clean golden bench; do
    check "make $target is a target" grep -q "^$target:.*## " Makefile \
        bench/bench.mk
done
installs()
{
    make -s install PREFIX="$PWD/$out/prefix" BUILD="$BUILD" >/dev/null &&
        $CC -std=c99 "$out/example.c" -I"$out/prefix/include" \
            -L"$out/prefix/lib" -lbrume -o "$out/installed" &&
        "$out/prefix/bin/brume" --version | grep -q '^brume [0-9]'
}
check "make install PREFIX= gives a library that links" installs
# With all that any of them asks for.
"$BUILD/brume-bake" "$out/cloud.vdb" --mips --emission density \
    -o "$out/all.brume" >/dev/null
for scene in scenes/*.scene; do
    check "$scene is read" "$BUILD/brume" render "$out/all.brume" \
        --scene "$scene" --set size=32x18 -o "$out/scene.png"
done
finish
