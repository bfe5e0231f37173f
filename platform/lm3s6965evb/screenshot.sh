#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs the demo of the LM3S6965 board, and writes what its OLED shows as PNG.
set -eu

usage()
{
    echo "usage: platform/lm3s6965evb/screenshot.sh DEMO.elf OUT.png

Runs the demo in qemu-system-arm until its picture stands, lets the emulator's
monitor dump the OLED (each pixel as 4x4), and writes that as PNG. Prints the
demo's line of figures. Needs pnmtopng of netpbm.

Exit status: 0 done, 1 the demo or the dump failed, 2 wrong usage."
}

case ${1-} in --help | -h)
    usage
    exit 0
    ;;
esac
[ $# = 2 ] || { usage >&2; exit 2; }
elf=$1 png=$2 seconds=60
# The monitor's prompt may come before it in the line.
last_line='(lm3s6965evb|error|fault): '
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

fail()
{
    echo "screenshot.sh: $1" >&2
    exit 1
}

demo_is_done()
{
    grep -qE "$last_line" "$work/text"
}

# The monitor's commands, once the demo has printed its line.
commands()
{
    tenths=0
    while ! demo_is_done && [ "$tenths" -lt "${seconds}0" ]; do
        sleep 0.1
        tenths=$((tenths + 1))
    done
    echo "screendump $work/screen.ppm"
    echo quit
}

[ -r "$elf" ] || fail "cannot read $elf"
: >"$work/text"
commands | qemu-system-arm -M lm3s6965evb -icount shift=0,sleep=off \
    -display none -serial none -monitor stdio \
    -semihosting-config enable=on,target=native,arg=demo,arg=hold \
    -kernel "$elf" >"$work/text" 2>"$work/errors" || true
grep -oE "$last_line.*" "$work/text" ||
    fail "the demo did not end within $seconds s"
grep -q lm3s6965evb: "$work/text" || exit 1
[ -s "$work/screen.ppm" ] || fail "no picture: $(tail -n 1 "$work/errors")"
pnmtopng "$work/screen.ppm" >"$work/screen.png" 2>"$work/errors" ||
    fail "pnmtopng: $(tail -n 1 "$work/errors")"
mv "$work/screen.png" "$png"
