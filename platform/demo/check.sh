#!/bin/sh
# SPDX-License-Identifier: MIT
# The demos of the boards: they draw what the whole core draws on this machine,
# they fit with room, and they hold nothing of a C library. Run in the tree.
set -eu
: "${BUILD:=build}"
. tests/lib.sh

case ${1-} in --help | -h)
    echo "usage: platform/demo/check.sh

Builds the demos of microbit, netduinoplus2 and lm3s6965evb in \$BUILD/targets,
runs them in the emulator and compares their pictures, byte by byte, with
those of the same programs on this machine with every feature compiled in.
Prints their sizes. Exit status: 0 when all is well."
    exit 0
    ;;
esac
[ $# = 0 ] || { echo "check.sh: takes no arguments" >&2; exit 2; }

# of CONF VARIABLE: what a variable of the Makefile holds for a board.
of()
{
    printf 'include platform/%s/conf.mk\nshow:\n\t@echo $(%s)\n' "$1" "$2" |
        make -s -f - show
}

build_demo()
{
    make -s CONF="$board" BUILD="$BUILD" "$out/demo.elf" >"$out.log" 2>&1 ||
        { tail -n 20 "$out.log"; return 1; }
}

# run N: the demo in the emulator, in a folder of its own.
run_demo()
{
    mkdir -p "$out/run$1"
    rm -f "$out/run$1"/*
    # shellcheck disable=SC2086
    (cd "$out/run$1" && timeout 120 $run ../demo.elf </dev/null \
        >text 2>errors) || { cat "$out/run$1/text"; return 1; }
}

repeats()
{
    run_demo 2 && cmp "$out/run1/text" "$out/run2/text"
}

# The same sources and every feature, for this machine.
build_whole()
{
    sources=$(of "$board" DEMO_SRC | tr ' ' '\n' |
        sed 's|.*/oled.c|platform/demo/host_oled.c|')
    # shellcheck disable=SC2086
    "${HOST_CC:-gcc}" -std=c11 -O2 -Icore -Iplatform -Iplatform/bare \
        -Iplatform/"$board" core/*.c $sources platform/bare/print.c \
        platform/demo/host.c -o "$out/whole" || return 1
    mkdir -p "$out/host"
    rm -f "$out/host"/*
    (cd "$out/host" && ../whole ../demo/cloud.brume >text)
}

same_pictures()
{
    count=0
    for picture in "$out/host"/*.p[gp]m; do
        [ -e "$picture" ] || return 1
        name=$(basename "$picture")
        if [ "$name" = oled.pgm ]; then
            pamenlarge 4 "$picture" | pnmtoplainpnm >"$out/expected"
            platform/lm3s6965evb/screenshot.sh "$out/demo.elf" \
                "$out/oled.png" >/dev/null || return 1
            pngtopnm "$out/oled.png" | ppmtopgm | pamdepth 15 |
                pnmtoplainpnm >"$out/shown"
            cmp "$out/expected" "$out/shown" || return 1
        else
            cmp "$picture" "$out/run1/$name" || return 1
        fi
        count=$((count + 1))
    done
    [ "$count" = "$1" ]
}

# No soft float, no 64-bit division, no heap, no libc.
no_library()
{
    ! "$tool-nm" "$out/demo.elf" | awk '{ print $NF }' |
        grep -E "^__aeabi_([fd]|[ui]l?2[fd]|u?ldivmod)|^__(u?div|u?mod)di|\
^__(add|sub|mul|div|fix|float)[a-z]*[sd]f|^(malloc|free|_sbrk|printf|exp|pow)"
}

# Flash and RAM with a tenth of each to spare. Prints them.
fits()
{
    stack=$(sed -n 's/.*instructions, \([0-9]*\) bytes of stack/\1/p' \
        "$out/run1/text")
    frame=$(sed -n 's/.*: \([0-9]*\) instructions.*/\1/p' "$out/run1/text")
    "$tool-size" -A "$out/demo.elf" | awk -v board="$board" -v stack="$stack" \
        -v frame="$frame" -v flash_size="$(of "$board" TARGET_FLASH)" \
        -v ram_size="$(of "$board" TARGET_RAM)" '
        $1 ~ /^\.(text|rodata|data)$/ { program += $2 }
        $1 == ".assets" { asset = $2 }
        $1 ~ /^\.(data|bss)$/ { ram += $2 }
        $1 == ".stack" { reserved = $2 }
        END {
            printf "# %s: flash %d + asset %d, %d %% left; RAM %d + stack " \
                "%d of %d, %d %% left; %d instructions a frame\n", board,
                program, asset, 100 - 100 * (program + asset) / flash_size,
                ram, stack, reserved, 100 - 100 * (ram + reserved) / ram_size,
                frame
            exit !(stack > 0 && frame > 0 && stack <= 0.9 * reserved &&
                program + asset <= 0.9 * flash_size &&
                ram + reserved <= 0.9 * ram_size)
        }'
}

# check_board NAME PICTURES
check_board()
{
    board=$1
    out=$BUILD/targets/$board
    for need in $(of "$board" TARGET_TOOLS) pngtopnm pamenlarge; do
        command -v "$need" >/dev/null || { skip "$board: no $need"; return; }
    done
    mkdir -p "$out"
    run=$(of "$board" TARGET_RUN)
    tool=$(of "$board" CC)
    tool=${tool%-gcc}
    check "$board: the demo builds" build_demo
    check "$board: it runs" run_demo 1
    check "$board: a second run counts the same" repeats
    check "$board: the whole core builds the same demo" build_whole
    check "$board: $2 pictures of the whole core" same_pictures "$2"
    check "$board: no floats, 64-bit division or library" no_library
    check "$board: fits with a tenth to spare" fits
}

check_board microbit 1
check_board netduinoplus2 6
check_board lm3s6965evb 1
finish
