#!/bin/sh
# SPDX-License-Identifier: MIT
# One image on every target: see the help text, and docs/TARGETS.md.
set -eu
usage()
{
    cat <<'END'
usage: run.sh [NAME...]    build and run all targets (or these), and compare
       run.sh update       the same; renew tests/targets/counts.txt and the
                           tables of docs/TARGETS.md
       run.sh table        print the tables of the last run
       run.sh list         print the names of all targets
       run.sh build NAME   only build the test program of a target
       run.sh packages     print the Debian packages that all targets need

A target is a platform/NAME/conf.mk, or a line of tests/targets/variants.txt.
Those whose tools are missing are skipped by name. BUILD, DATA and JOBS are as
for make. What a target printed is left in $BUILD/targets/NAME/result.txt.

Exit status: 0 when every image is the host's, no instruction count moved by
more than 1 %, and no size, stack or symbol breaks its limit; else 1.
END
}
: "${BUILD:=build}" "${DATA:=../shared/data}" "${JOBS:=$(nproc)}"
export BUILD DATA JOBS
unset MAKEFLAGS MAKELEVEL CC CFLAGS CPPFLAGS LDFLAGS CONF TARGET
here=tests/targets
out=$BUILD/targets

list()
{
    for conf in platform/*/conf.mk; do
        name=$(basename "$(dirname "$conf")")
        [ "$name" = host ] || echo "$name"
    done
    awk '!/^#/ && NF { print $1 }' "$here/variants.txt"
}

# make_target NAME ARGUMENT...: make with the platform and the variables of a
# target.
make_target()
{
    target=$1 conf=$1
    shift
    while read -r name platform words; do
        [ "$name" = "$target" ] || continue
        conf=$platform
        for word in $words; do
            set -- "$@" "$(echo "$word" | tr , ' ')"
        done
    done <"$here/variants.txt"
    make -s BUILD="$BUILD" CONF="$conf" TARGET="$target" \
        ASSETS="$out/$target/assets.h" "$@"
}

packages()
{
    for conf in $(list); do
        [ ! -f "platform/$conf/conf.mk" ] || make_target "$conf" target-info
    done | tr ' ' '\n' | sed -n "/^packages=/,/^files=/p" | tr -d "'" |
        sed 's/^packages=//; /^files=/d' | sort -u | tr '\n' ' '
}

# Volumes, smallest first: a target takes those that fit.
prepare()
{
    mkdir -p "$out/volumes"
    . tests/volumes.sh
    "$BUILD/tests/hash_scenes" --write "$out/volumes"
    for word in block_u8 wdas1_u8 wdas_u8 smoke_u4r wdas_u4r cloud_u8 lit_u8 \
        lit_u4r_apron glow_u8 glow_u4r_apron; do
        [ ! -f "$out/volumes/$word.brume" ] ||
            echo "$word $(realpath "$out/volumes/$word.brume")"
        for volume in $volumes; do
            [ "${volume%%=*}" != "$word" ] ||
                echo "$word $(realpath "${volume#*=}")"
        done
    done >"$out/volumes.txt"
}

# choose_assets DIRECTORY: into assets.h for those that are linked in, and
# assets.txt as arguments for those that are read.
choose_assets()
{
    room=${assets_max:-0}
    # A part of the same flash is the program's.
    [ "$room" -ge "${flash:-0}" ] || room=$((room - 49152))
    : >"$1/assets.h"
    : >"$1/assets.txt"
    while read -r name path; do
        bytes=$(wc -c <"$path")
        [ -n "$files" ] || [ "$bytes" -le "$room" ] || continue
        room=$((room - bytes))
        echo "ASSET($name, \"$path\")" >>"$1/assets.h"
        echo "$name=$path" >>"$1/assets.txt"
    done <"$out/volumes.txt"
}

# What is known without running: compiler, sizes, stack, symbols.
look_at()
{
    version=$($cc -dumpfullversion 2>/dev/null || $cc -dumpversion)
    echo "compiler $(basename "${cc%% *}")-$version"
    echo "flags $flags"
    echo "size $($size -A "$1"/core/*.o | awk -f "$here/sizes.awk")"
    ! ls "$1"/core/*.ci >/dev/null 2>&1 ||
        echo "bound $(awk -f "$here/stack.awk" "$1"/core/*.ci | tr '\n' ' ')"
    [ -n "$files" ] || echo "linked"
    [ -n "$files" ] || nm "$1/targets.elf" | awk -f "$here/symbols.awk"
}

# The demo of a board: what it prints last, and what it takes.
show_demo()
{
    directory=$out/$1
    make_target "$1" "$directory/demo.elf" >>"$directory/build.log" 2>&1 &&
        (cd "$directory" && timeout 300 $run demo.elf) \
            >"$directory/demo.txt" 2>&1 </dev/null || {
        echo "error demo $(tail -n 1 "$directory/demo.txt")"
        return 0
    }
    echo "demo $(tail -n 1 "$directory/demo.txt")"
    echo "demo_size $($size -A "$directory/demo.elf" | awk '
        $1 == ".text" || $1 == ".rodata" || $1 == ".data" { flash += $2 }
        $1 == ".data" || $1 == ".bss" { ram += $2 }
        $1 == ".assets" { assets = $2 }
        END { print flash, assets, ram }') $flash $ram"
    nm "$directory/demo.elf" | awk -f "$here/symbols.awk"
}

# one NAME: builds and runs a target, into result.txt. Its last line is `state`.
one()
{
    who=$1
    directory=$out/$1
    mkdir -p "$directory"
    result=$directory/result.txt
    rm -f "$result"
    eval "$(make_target "$1" target-info)"
    for tool in $tools; do
        command -v "$tool" >/dev/null || {
            echo "state skip no $tool here" >"$result"
            return
        }
    done
    choose_assets "$directory"
    if ! make_target "$1" "$directory/targets.elf" \
        >"$directory/build.log" 2>&1; then
        echo "state fail does not build: $directory/build.log" >"$result"
        return
    fi
    [ "${only_build:-}" = "" ] || return 0
    set --
    while read -r word; do
        [ -z "$files" ] || set -- "$@" "$word"
    done <"$directory/assets.txt"
    start=$(date +%s)
    status=0
    # shellcheck disable=SC2086
    timeout 300 $run "$directory/targets.elf" "$@" >"$directory/new.txt" \
        2>"$directory/run.log" </dev/null || status=$?
    look_at "$directory" >>"$directory/new.txt"
    [ -z "$demo" ] || [ ! -f "platform/$who/conf.mk" ] ||
        show_demo "$who" >>"$directory/new.txt"
    if [ $status = 0 ]; then
        echo "state ok $(($(date +%s) - start)) s" >>"$directory/new.txt"
    else
        echo "state fail status $status: $(tail -n 1 "$directory/run.log")" \
            >>"$directory/new.txt"
    fi
    mv "$directory/new.txt" "$result"
}

# The host's own: with its counters of lookups, the reference of all others.
reference()
{
    mkdir -p "$out/reference"
    make -s BUILD="$BUILD" CONF=linux TARGET=reference TARGET_CONFIG=tally \
        TARGET_DEFINES=-DTARGET_TALLY "$out/reference/targets.elf"
    sed 's/ /=/' "$out/volumes.txt" | xargs "$out/reference/targets.elf" \
        >"$out/reference/result.txt"
}

# judge MODE NAME...
judge()
{
    mode=$1
    shift
    for name; do
        shift
        set -- "$@" "$out/$name/result.txt"
    done
    awk -v mode="$mode" -v counts="$here/counts.txt" \
        -v limits="$here/limits.txt" -v golden=tests/golden/hashes.txt \
        -f "$here/judge.awk" "$out/reference/result.txt" "$@"
}

run_all()
{
    prepare
    reference
    echo "$@" | tr ' ' '\n' | xargs -P "$JOBS" -n 1 sh "$0" one
    [ ! -t 2 ] || printf '\r\033[K' >&2
    judge table "$@" | tee "$out/table.md"
    echo
}

# Puts the tables of this run into a page, between its marks.
splice_table()
{
    awk -v table="$out/table.md" '
        /^<!-- end of table/ { skip = 0 }
        !skip
        /^<!-- table/ {
            print ""
            while ((getline line < table) > 0)
                print line
            print ""
            skip = 1
        }' "$1" >"$out/page.md"
    cp "$out/page.md" "$1"
}

verdict()
{
    . tests/lib.sh
    . "$here/selftest.sh"
    judge verdict "$@" >"$out/verdict.txt"
    while read -r word text; do
        case $word in
        pass) check "$text" true ;;
        skip) skip "$text" ;;
        *) check "$text" false ;;
        esac
    done <"$out/verdict.txt"
    finish
}

case ${1:-} in
--help | -h) usage ;;
list) list ;;
packages) packages ;;
table) cat "$out/table.md" ;;
one)
    [ ! -t 2 ] || printf '\r\033[K%s' "$2" >&2
    one "$2"
    ;;
build)
    only_build=yes
    prepare
    one "$2"
    cat "$out/$2/build.log"
    [ ! -f "$out/$2/result.txt" ] || { cat "$out/$2/result.txt"; exit 1; }
    echo "$out/$2/targets.elf"
    ;;
update)
    # shellcheck disable=SC2046
    set -- $(list)
    run_all "$@"
    judge counts "$@" >"$out/counts.txt"
    cp "$out/counts.txt" "$here/counts.txt"
    splice_table docs/TARGETS.md
    verdict "$@"
    ;;
*)
    for name; do
        list | grep -qxF -e "$name" || {
            echo "run.sh: no target $name; see run.sh list" >&2
            exit 2
        }
    done
    # shellcheck disable=SC2046
    [ $# != 0 ] || set -- $(list)
    run_all "$@"
    verdict "$@"
    ;;
esac
