#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Tests of brume-bake's other outputs, C and assembly, and of --budget. BUILD
# is the folder of brume-bake, tests/make_vdbs and tests/section_dump, DATA
# that of the real volumes: without them what needs them is skipped by name.
LC_ALL=C
export LC_ALL
BUILD=${BUILD:-build}
DATA=${DATA:-../shared/data}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
case $BUILD in /*) ;; *) BUILD=$PWD/$BUILD ;; esac
case $DATA in /*) ;; *) DATA=$PWD/$DATA ;; esac
bake=$BUILD/brume-bake
. tests/bake_lib.sh

# refused TEXT STATUS PATTERN FILE ARGUMENT...: brume-bake -o FILE in an empty
# folder ends with that status and one line that holds PATTERN, and leaves
# nothing
refused() {
    text=$1 status=$2 pattern=$3 file=$4
    shift 4
    rm -rf "$work/none" && mkdir "$work/none"
    "$bake" "$@" -o "$work/none/$file" >"$work/out" 2>"$work/err"
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

if [ ! -x "$bake" ]; then
    not_ok "$bake is there"
    echo "$passed passed, $failed failed, $skipped skipped"
    exit 1
fi
dump=$BUILD/tests/section_dump
v=$work/vdb
mkdir "$v"
"$BUILD/tests/make_vdbs" "$v" || exit 1
CC=${CC:-gcc}
strict='-pedantic -Wall -Wextra -Werror'

# Writes the asset to stdout; fails when it is not aligned or its size wrong.
cat >"$work/main.c" <<'END'
#include <stdint.h>
#include <stdio.h>
#ifdef __cplusplus
extern "C" {
#endif
extern const union SYMBOL_asset {
    unsigned char bytes[SIZE];
    uint32_t align;
} SYMBOL;
extern const uint32_t SYMBOL_size;
#ifdef __cplusplus
}
#endif
int main(void)
{
    if ((uintptr_t)&SYMBOL % 4 != 0 || SYMBOL_size != sizeof SYMBOL.bytes)
        return 1;
    return fwrite(SYMBOL.bytes, 1, SYMBOL_size, stdout) != SYMBOL_size;
}
END

# dumps FILE SYMBOL ASSET COMPILER...: main.c and FILE, compiled and linked,
# write out ASSET
dumps() {
    file=$1 symbol=$2 asset=$3
    shift 3
    sed "s/SYMBOL/$symbol/g; s/SIZE/$(($(wc -c <"$asset")))/" "$work/main.c" \
        >"$work/dump_main.c"
    # The folder is for .incbin.
    "$@" -I"$(dirname "$file")" -o "$work/dumper" "$work/dump_main.c" \
        "$file" && "$work/dumper" >"$work/dumped" &&
        cmp "$work/dumped" "$asset"
}

## C ##

mkdir "$work/o"
"$bake" "$v/float.vdb" -o "$work/o/cloud.brume" >"$work/out" || exit 1
check "-o cloud.c" "$bake" "$v/float.vdb" -o "$work/o/cloud.c"
check "-o cloud.S" "$bake" "$v/float.vdb" -o "$work/o/sub.S"
check "  writes the asset too" cmp "$work/o/sub.brume" "$work/o/cloud.brume"
check "  and nothing else stays" test "$(ls "$work/o" | tr '\n' ' ')" = \
    "cloud.brume cloud.c sub.S sub.brume "
for cc in gcc clang; do
    if ! command -v $cc >/dev/null; then
        skip "$cc: C and assembly"
        continue
    fi
    for std in c99 c11; do
        check "$cc -std=$std: the C is the asset, without a warning" \
            dumps "$work/o/cloud.c" cloud "$work/o/cloud.brume" \
            $cc -std=$std $strict
    done
    check "$cc: the assembly is the asset" dumps "$work/o/sub.S" sub \
        "$work/o/cloud.brume" $cc -std=c99 $strict
done
for cxx in g++ clang++; do
    if ! command -v $cxx >/dev/null; then
        skip "$cxx: C as C++"
        continue
    fi
    check "$cxx: the C is C++ too" dumps "$work/o/cloud.c" cloud \
        "$work/o/cloud.brume" $cxx -x c++ -std=c++17 $strict
done
cp "$work/o/sub.S" "$work/o/sub.s"
check "as needs no preprocessor" dumps "$work/o/sub.s" sub \
    "$work/o/cloud.brume" "$CC"

# symbols OBJECT NM: names and sizes of the two symbols, which must be global.
# (The section may differ: gcc for PowerPC puts the size near other small data.)
symbols() {
    $2 -S "$1" | awk '$3 != "r" { print $2, $4 }' | sort -k2
}
for target in arm-none-eabi aarch64-linux-gnu riscv64-unknown-elf \
    riscv64-linux-gnu powerpc-linux-gnu s390x-linux-gnu m68k-linux-gnu \
    mips-linux-gnu i686-linux-gnu; do
    if ! command -v "$target-gcc" >/dev/null; then
        skip "$target-gcc: C and assembly"
        continue
    fi
    cat "$work/o/cloud.c" >"$work/o/sub.c"
    sed -i 's/\bcloud/sub/g' "$work/o/sub.c"
    check "$target: the assembly assembles" "$target-gcc" -I"$work/o" \
        -c "$work/o/sub.S" -o "$work/s.o"
    check "$target: the C compiles" "$target-gcc" -ffreestanding -std=c99 \
        -pedantic -Wall -Wextra -Werror -c "$work/o/sub.c" -o "$work/c.o"
    symbols "$work/s.o" "$target-nm" >"$work/s.nm"
    symbols "$work/c.o" "$target-nm" >"$work/c.nm"
    check "  with the same symbols" cmp "$work/s.nm" "$work/c.nm"
    check "  aligned to 4" sh -c "'$target-objdump' -h '$work/c.o' |
        awk '\$2 == \".rodata\" { exit !(\$NF >= \"2**2\") }'"
done
if command -v clang >/dev/null; then
    for target in armv6m-none-eabi armv7em-none-eabi aarch64-none-elf \
        riscv32-none-elf riscv64-none-elf i686-linux-gnu s390x-linux-gnu; do
        check "clang for $target assembles it" clang --target=$target \
            -I"$work/o" -c "$work/o/sub.S" -o "$work/s.o"
    done
fi

## Comment, licence, names ##

check "the comment has the figures" sh -c "grep -q '^ \* grid      \"density\"\
 of float.vdb\$' '$work/o/cloud.c' && grep -q '^ \* format    u8, .* bytes' \
    '$work/o/cloud.c' && grep -q '^ \* error     rmse' '$work/o/cloud.c'"
check "the same one in assembly" grep -q '^ \* error     rmse' "$work/o/sub.S"
check "no licence: it says so" grep -q 'licence   none was given' \
    "$work/o/cloud.c"
nasty='CC */ BY /* 4.0 \
second ??/
third (c) '"$(printf 'caf\303\251 \342\200\256 \377 \001')"' \'
"$bake" "$v/float.vdb" -o "$work/o/nasty.c" --licence "$nasty" >"$work/out"
"$bake" "$v/float.vdb" -o "$work/o/nasty_s.S" --licence "$nasty" >"$work/out"
for cc in gcc clang; do
    command -v $cc >/dev/null || continue
    check "$cc: no licence breaks the C" dumps "$work/o/nasty.c" nasty \
        "$work/o/cloud.brume" $cc -std=c99 $strict
    check "$cc: nor the assembly" dumps "$work/o/nasty_s.S" nasty_s \
        "$work/o/cloud.brume" $cc -std=c99
done
check "its lines are there" grep -q "^ \*           third (c) caf" \
    "$work/o/nasty.c"
"$bake" "$v/licensed.vdb" -o "$work/o/l.c" >"$work/out"
check "a licence of the grid" grep -q '^ \* licence   CC0 of the grid$' \
    "$work/o/l.c"
"$bake" "$v/licensed_file.vdb" -o "$work/o/l.c" >"$work/out"
check "a licence of the file" grep -q '^ \* licence   CC0 of the file$' \
    "$work/o/l.c"
"$bake" "$v/licensed.vdb" -o "$work/o/l.c" --licence MIT >"$work/out"
check "--licence goes first" grep -q '^ \* licence   MIT$' "$work/o/l.c"
"$bake" "$v/name.vdb" -o "$work/o/odd.c" >"$work/out"
check "an odd grid name" "$CC" -std=c99 -pedantic -Wall -Wextra -Werror \
    -c "$work/o/odd.c" -o "$work/c.o"

# named FILE SYMBOL: both forms of that name link with that symbol
named() {
    for form in c S; do
        check "\"$1.$form\" is $2" "$bake" "$v/float.vdb" \
            -o "$work/o/$1.$form"
        check "  and works" dumps "$work/o/$1.$form" "$2" \
            "$work/o/cloud.brume" "$CC"
    done
}
named 'a b' a_b
named "it's \"odd\" (2) \\ \$x" it_s_odd_2_x
named '9lives' asset_9lives
named 'int' asset_int
named 'class' asset_class
named 'linux' asset_linux
named 'r0' asset_r0
named '__x__' x
named "$(printf 'd\303\251j\303\240')" d_j
named '---' asset
named '%d%s' d_s
named 'two.dots' two_dots
check "--symbol" "$bake" "$v/float.vdb" -o "$work/o/s.c" --symbol My_cloud2
check "  is used" dumps "$work/o/s.c" My_cloud2 "$work/o/cloud.brume" "$CC"
refused "--symbol with a space" 2 "symbol takes" x.c "$v/float.vdb" \
    --symbol 'a b'
refused "--symbol that is a keyword" 2 "symbol takes" x.c "$v/float.vdb" \
    --symbol while
refused "--symbol for a plain asset" 2 "need -o FILE.c" x.brume \
    "$v/float.vdb" --symbol a
refused "--licence for a plain asset" 2 "need -o FILE.c" x.brume \
    "$v/float.vdb" --licence a
check "--threads 1: the same C" sh -c "'$bake' '$v/float.vdb' \
    -o '$work/t1.c' --symbol x --threads 1 && '$bake' '$v/float.vdb' \
    -o '$work/t2.c' --symbol x --threads 2 &&
    sed 's/t1\.c/t2.c/' '$work/t1.c' | cmp - '$work/t2.c'"

## Failure ##

refused "an empty grid leaves neither file" 1 "no active voxels" x.S \
    "$v/empty.vdb"
refused "nor a C file" 1 "no active voxels" x.c "$v/empty.vdb"
"$bake" "$v/float.vdb" -o "$work/nowhere/x.S" >"$work/out" 2>"$work/err"
check "a folder that is missing" test $? -eq 1
mkdir -p "$work/d/x.brume"
"$bake" "$v/float.vdb" -o "$work/d/x.S" >"$work/out" 2>"$work/err"
check "x.brume is a folder" test $? -eq 1
check "  so no x.S" test "$(ls -A "$work/d")" = x.brume
mkdir "$work/ro"
chmod 555 "$work/ro"
ro=$work/ro
# root may write to it, but nobody makes files in /proc.
[ "$(id -u)" -ne 0 ] || ro=/proc
if [ -d "$ro" ]; then
    for file in x.c x.S x.brume; do
        "$bake" "$v/float.vdb" -o "$ro/$file" >"$work/out" 2>"$work/err"
        check "a folder that cannot be written to: $file" test $? -eq 1
        check "  one line" grep -c "x\.[a-zA-Z]*: cannot be written:" "$work/err"
    done
else
    skip "a folder that cannot be written to: this is root, without /proc"
fi
mkdir "$work/keep"
for f in x.c x.S x.brume; do echo "old $f" >"$work/keep/$f"; done
for form in c S; do
    "$bake" "$v/empty.vdb" -o "$work/keep/x.$form" >"$work/out" 2>"$work/err"
done
check "what was there stays when a bake fails" test \
    "$(cat "$work/keep/x.c" "$work/keep/x.S" "$work/keep/x.brume")" = \
    "$(printf 'old x.c\nold x.S\nold x.brume')"
cp "$v/float.vdb" "$work/keep/y.brume"
"$bake" "$work/keep/y.brume" -o "$work/keep/y.S" >"$work/out" 2>"$work/err"
check "the input is not overwritten by the included asset" test $? -eq 2
check "  and still whole" cmp "$v/float.vdb" "$work/keep/y.brume"
"$bake" "$v/float.vdb" -o "$work/keep/y.S" --report "$work/keep/y.brume" \
    >"$work/out" 2>"$work/err"
check "nor does the report take its name" test $? -eq 2

# A rename() that fails for names that end in .S: the second of two.
cat >"$work/shim.c" <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <string.h>
int rename(const char *from, const char *to)
{
    const size_t n = strlen(to);
    int (*next)(const char *, const char *);
    void *symbol = dlsym(RTLD_NEXT, "rename");
    memcpy(&next, &symbol, sizeof next);
    if (n > 2 && !strcmp(to + n - 2, ".S")) {
        errno = EIO;
        return -1;
    }
    return next(from, to);
}
END
if gcc -shared -fPIC -o "$work/shim.so" "$work/shim.c" -ldl 2>"$work/err"; then
    mkdir "$work/half"
    LD_PRELOAD=$work/shim.so "$bake" "$v/float.vdb" -o "$work/half/x.S" \
        >"$work/out" 2>"$work/err"
    check "a rename that fails" test $? -eq 1
    check "  leaves neither" test -z "$(ls -A "$work/half")"
    LD_PRELOAD=$work/shim.so "$bake" "$v/float.vdb" -o "$work/keep/x.S" \
        >"$work/out" 2>"$work/err"
    check "  or both as they were" test \
        "$(cat "$work/keep/x.S" "$work/keep/x.brume")" = \
        "$(printf 'old x.S\nold x.brume')"
    check "  and nothing besides" test "$(ls "$work/keep" | tr '\n' ' ')" = \
        "x.S x.brume x.c y.brume "
else
    skip "a rename that fails: no shared library can be made"
fi

## Budget ##

# of JSON KEY: the first number for that key
of() { sed -n "s/^ *\"$2\": \([^,]*\),*\$/\1/p" "$work/$1" | head -n 1; }

# fits NAME BYTES ARGUMENT...: baked to NAME.brume within BYTES, report in
# NAME.json
fits() {
    name=$1 bytes=$2
    shift 2
    "$bake" "$@" -o "$work/$name.brume" --report "$work/$name.json" \
        >"$work/out" 2>"$work/err" || return 1
    got=$(($(wc -c <"$work/$name.brume")))
    [ "$got" -le "$bytes" ] && [ "$got" = "$(of "$name.json" bytes)" ] &&
        "$dump" json "$work/$name.json" &&
        grep -q "notice: a budget of $bytes bytes: $(
            of "$name.json" format | tr -d '"') at level of detail $(
            of "$name.json" lod) takes $got; " "$work/err"
}

# read_figure NAME READ KEY: of the error of one kind of reads
read_figure() {
    sed -n "/\"$2\"/,/}/s/.*\"$3\": \([^,]*\),*/\1/p" "$work/$1.json"
}

# close_to A B SIZE: they differ by at most 1 part in 100,000 of SIZE
close_to() {
    awk -v a="$1" -v b="$2" -v s="$3" 'BEGIN {
        d = a - b; exit !((d < 0 ? -d : d) <= 1e-5 * s) }'
}

# best NAME: no candidate that fits has a smaller error than the asset, as the
# report lists them; and the error found by going over the input agrees with
# that of the candidate. The weights of trilinear reads add up to 1 for every
# voxel of the asset, so its mean error is that of nearest ones.
best() {
    sed -n -e 's/.*{"lod": //' -e 's/, "[a-z_]*": / /g' -e 's/[}",]//gp' \
        "$work/$1.json" | awk '$3 == "true" { print $6, $4, $1, $2 }' |
        sort -g >"$work/fitting"
    least=$(head -n 1 "$work/fitting" | cut -d' ' -f1)
    walked=$(read_figure "$1" nearest rmse_over_max)
    cat "$work/fitting"
    grep -qx "$least $(of "$1.json" bytes) $(of "$1.json" lod) $(
        of "$1.json" format | tr -d '"')" "$work/fitting" &&
        close_to "$least" "$walked" "$least" &&
        close_to "$(read_figure "$1" nearest mean_over_max)" \
            "$(read_figure "$1" trilinear mean_over_max)" "$least"
}

# same_as NAME INPUT ARGUMENT...: the asset is the one that --lod and --format
# make
same_as() {
    name=$1
    shift
    "$bake" "$@" -o "$work/plain.brume" \
        --lod "$(of "$name.json" lod)" \
        --format "$(of "$name.json" format | tr -d '"')" &&
        cmp "$work/$name.brume" "$work/plain.brume"
}

budgets() {
    input=$1
    shift
    for budget; do
        bytes=$budget
        case $budget in
        *K) bytes=$((${budget%K} * 1024)) ;;
        *M) bytes=$((${budget%M} * 1048576)) ;;
        esac
        check "--budget $budget of $(basename "$input")" \
            fits b "$bytes" "$input" --budget "$budget"
        check "  is the best of the candidates" best b
        check "  and what --lod and --format make" same_as b "$input"
    done
}

budgets "$v/float.vdb" 1M 64K 20000 8K 4K 1500
budgets "$v/tiles.vdb" 1M 64K 4K
check "--budget with apron" fits b 20000 "$v/float.vdb" --budget 20000 --apron
check "  is the best of the candidates" best b
check "--budget with --max-density" fits b 8192 "$v/float.vdb" --budget 8K \
    --max-density 50
check "  is the best of the candidates" best b
check "  and what --lod and --format make" same_as b "$v/float.vdb" \
    --max-density 50
check "--budget of stretched voxels" sh -c "'$bake' '$v/stretched.vdb' \
    -o '$work/b.brume' --report '$work/b.json' --budget 8K"
check "  is the best of the candidates" best b
check "--format limits the choice" fits b 1048576 "$v/float.vdb" \
    --budget 1M --format u4r
check "  to u4r" test "$(of b.json format)" = '"u4r"'
check "--lod limits the choice" fits b 1048576 "$v/float.vdb" --budget 1M \
    --lod 2
check "  to level 2" test "$(of b.json lod)" = 2
check "a density that reaches too far for level 0" fits b 100000 \
    "$v/wide.vdb" --budget 100000
refused "and what is too little for it" 1 "the smallest asset has" x.brume \
    "$v/wide.vdb" --budget 100
# It is worked out by hand: one voxel in 8 of a block of 8 is 1, so level 1 is
# 1/8 everywhere: 7/8 off at one, 1/8 at seven. Its error is
# sqrt((49 + 7) / 64) = 0.935414 per non-zero voxel, its mean error 0.
check "a lattice at --lod 1" fits lat 1048576 "$v/lattice.vdb" --budget 1M \
    --lod 1
check "  has the error it must have" sh -c "sed -n '/\"nearest\"/,/}/p' \
    '$work/lat.json' | awk -F'[:,]' '/\"rmse\"/ { r = \$2 } /\"mean\"/ { m = \$2 }
    END { print r, m; exit !(r > 0.9354 && r < 0.93543 && m < 1e-6 &&
        m > -1e-6) }'"
for n in 1 2; do
    "$bake" "$v/float.vdb" -o "$work/n$n.brume" --budget 8K --threads $n \
        --report "$work/n$n.json" >"$work/out" 2>"$work/n$n.err"
    sed -e '/"seconds"/,/}/d' -e '/"output"/d' "$work/n$n.json" \
        >"$work/n$n.figures"
done
check "--threads 1 and 2: the same choice" cmp "$work/n1.brume" \
    "$work/n2.brume"
check "  the same figures" cmp "$work/n1.figures" "$work/n2.figures"
check "  the same notice" cmp "$work/n1.err" "$work/n2.err"
check "--budget to C" "$bake" "$v/float.vdb" -o "$work/o/fit.c" --budget 8K
check "  tells the error in its comment" grep -q \
    '^ \*           of the input: rmse' "$work/o/fit.c"
refused "no room for anything" 1 "the smallest asset has [0-9]* (" x.brume \
    "$v/float.vdb" --budget 100
least=$(sed -n 's/.*smallest asset has \([0-9]*\) .*/\1/p' "$work/err")
check "the smallest size it names can be had" fits b "$least" \
    "$v/float.vdb" --budget "$least"
refused "one byte less cannot" 1 "smallest asset has $least" x.S \
    "$v/float.vdb" --budget $((least - 1))
refused "no room for --lod 0 --format u8" 1 \
    "smallest asset has .*--format u8 --lod 0" x.brume "$v/float.vdb" \
    --budget 8K --lod 0 --format u8
for bad in 0 -1 1.5 12Q 3G 4096M 2048M 99999999999999999999 K ''; do
    refused "--budget '$bad'" 2 "budget takes" x.brume "$v/float.vdb" \
        --budget "$bad"
done
check "--help has them all" sh -c "'$bake' --help >'$work/help' &&
    grep -q -- --budget '$work/help' && grep -q -- --symbol '$work/help' &&
    grep -q -- --licence '$work/help' && grep -q 'FILE\.S' '$work/help'"

## Real volumes ##

if [ -e "$DATA/wdas_cloud_sixteenth.vdb" ]; then
    budgets "$DATA/wdas_cloud_sixteenth.vdb" 340K 200K 64K 16K
    check "the Disney cloud in u4r takes at most 340 KB" fits b 340000 \
        "$DATA/wdas_cloud_sixteenth.vdb" --budget 340000 --format u4r --lod 0
else
    skip "needs $DATA/wdas_cloud_sixteenth.vdb"
fi
if [ -e "$DATA/openvdb_smoke1.vdb" ]; then
    budgets "$DATA/openvdb_smoke1.vdb" 1M 100K
else
    skip "needs $DATA/openvdb_smoke1.vdb"
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
