#!/bin/sh
# SPDX-License-Identifier: MIT
# What the core's objects may need and hold: no libc, no floating point, no
# writable data. Looks at the objects, not at the sources.
set -eu
: "${BUILD:=build}" "${CC:=cc}"
. tests/lib.sh
out=$BUILD/symbols
mkdir -p "$out"

# compile FLAGS...: all core objects anew into $out.
compile()
{
    rm -f "$out"/*.o
    for source in core/*.c; do
        $CC -std=c99 -ffreestanding -Icore "$@" -c "$source" \
            -o "$out/$(basename "$source" .c).o" || return 1
    done
}

# Undefined symbols of all objects together, without those another defines.
undefined()
{
    nm -u "$out"/*.o | awk '/ U /{print $2}' | sort -u >"$out/undefined"
    nm --defined-only "$out"/*.o | awk 'NF==3{print $3}' | sort -u |
        comm -23 "$out/undefined" -
}

only_memory_functions()
{
    undefined | grep -vxE 'memcpy|memset' >"$out/foreign" || true
    [ ! -s "$out/foreign" ] || { cat "$out/foreign"; return 1; }
}

# Sections that can be written to: .data and .bss of every object are 0.
no_writable_data()
{
    size -A "$out"/*.o | awk '
        $1 ~ /^\.(data|bss|tdata|tbss)/ && $1 !~ /^\.data\.rel\.ro/ {
            sum += $2 }
        END { if (sum) print "writable bytes:", sum; exit sum != 0 }'
}

no_common_symbols()
{
    ! nm "$out"/*.o | grep -E ' [CDdBbSsGg] '
}

# No instruction of any floating-point unit, in integer objects at -O2. Wide
# registers may be used to copy.
no_float_instructions()
{
    ! objdump -d --no-show-raw-insn "$out"/*.o |
        awk '$1 ~ /^[0-9a-f]+:$/{print $2}' |
        grep -E '^v?(add|sub|mul|div|sqrt|cvt[a-z0-9]*)[sp][sd]$|^f[a-z]+$' |
        sort | uniq -c | grep .
}

no_division_in_march()
{
    ! objdump -d --no-show-raw-insn "$out/brume_march.o" |
        awk '/^[0-9a-f]+ <brume_march_span>/{on=1} /^$/{on=0} on{print $2}' |
        grep -E '^i?div'
}

for flags in -O0 -O2 -Os; do
    check "core compiles alone with $flags" compile $flags
    check "$flags: undefined symbols are memcpy and memset at most" \
        only_memory_functions
    check "$flags: .data and .bss are 0" no_writable_data
    check "$flags: no writable or common symbol" no_common_symbols
done
compile -O2
case $($CC -dumpmachine) in
x86_64-*)
    check "no floating-point instruction" no_float_instructions
    check "no division in the march" no_division_in_march
    ;;
*)
    skip "floating-point instructions and divisions: known for x86-64 only"
    ;;
esac

only_allowed_headers()
{
    ! grep -nE '^ *# *include *<' core/*.c core/*.h |
        grep -vE '<(stdint|stddef|stdbool|limits)\.h>'
}
only_own_headers()
{
    grep -hoE '^ *# *include *"[^"]*"' core/*.c core/*.h |
        sed 's/.*"\(.*\)"/\1/' | sort -u | while read -r header; do
        [ -f "core/$header" ] || { echo "$header"; exit 1; }
    done
}
check "core includes stdint, stddef, stdbool, limits only" \
    only_allowed_headers
check "core includes nothing outside its folder" only_own_headers

tables_are_generated()
{
    $CC -std=c99 -o "$out/gen" tables/gen_function_tables.c -lm &&
        "./$out/gen" >"$out/brume_tables.c" &&
        cmp "$out/brume_tables.c" core/brume_tables.c
}
check "core/brume_tables.c is what its generator writes" tables_are_generated

# Line 1 has the generator's arguments.
black_bodies_are_generated()
{
    words=$(sed -n '1s|.* tables/gen_blackbody.c \(.*\) \*/$|\1|p' \
        tables/blackbody_table.h)
    # shellcheck disable=SC2086
    $CC -std=c99 -o "$out/gen" tables/gen_blackbody.c -lm &&
        "./$out/gen" $words >"$out/blackbody_table.h" &&
        cmp "$out/blackbody_table.h" tables/blackbody_table.h
}
check "tables/blackbody_table.h is what its generator writes" \
    black_bodies_are_generated
finish
