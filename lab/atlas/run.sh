#!/bin/sh
# SPDX-License-Identifier: MIT
# The stability atlas: for each method, a scene and a setting at which it fails,
# by how much, and what to use instead.
#
#   run.sh list               names of the units, one a line
#   run.sh UNIT OUTDIR        OUTDIR/atlas/UNIT.csv and UNIT.png: the failure,
#                             the remedy, and the truth (or the error)
#   run.sh check UNIT OUTDIR  what is claimed of that table: ok and not ok lines
#
# BUILD names the folder of the programs. A unit that needs a real volume of
# DATA says SKIP, and leaves nothing, where it is absent. Status: 0, 1 failed, 2
# usage.
set -u
: "${BUILD:=build}" "${DATA:=../shared/data}"
here=$(dirname "$0")
files=$(ls "$here"/units_*.sh)

usage()
{
    echo "lab/atlas: $1; usage: run.sh list | UNIT OUTDIR | check UNIT OUTDIR" \
        >&2
    exit 2
}

# shellcheck disable=SC2086
list() { sed -n 's/^unit_\([a-z0-9_]*\)()$/\1/p' $files; }

# with_unit UNIT OUTDIR: sets $unit and $out, and loads what there is
with_unit()
{
    list | grep -qx "$1" || usage "no unit '$1'"
    unit=$1 out=$2/atlas
    . "$here/lib.sh"
    for file in $files; do
        . "$file"
    done
}

run()
{
    for program in brume brume-reference brume-atlas; do
        [ -x "$BUILD/$program" ] ||
            die "no $BUILD/$program: run make $BUILD/$program"
    done
    mkdir -p "$out" || exit 1
    work=$(mktemp -d "$out/.$unit.XXXXXX") || exit 1
    trap 'rm -rf "$work"' EXIT
    trap 'exit 1' HUP INT TERM
    "unit_$unit" || exit 1
    if [ ! -f "$work/rows" ]; then
        [ -f "$work/skipped" ] || die "no rows"
        exit 0
    fi
    [ -f "$work/panels.png" ] || die "no picture"
    {
        echo "unit,method,scene,setting,metric,value,unit_of_metric,truth,\
remedy,remedy_value"
        cat "$work/rows"
    } >"$work/table" || exit 1
    mv "$work/panels.png" "$out/$unit.png" &&
        mv "$work/table" "$out/$unit.csv" || exit 1
}

check()
{
    table=$out/$unit.csv claims=0 broken=0
    if [ ! -f "$table" ]; then
        echo "ok 1 # SKIP $unit: no $table"
        exit 0
    fi
    "claim_$unit"
    exit $broken
}

case ${1-} in
list) list ;;
check)
    [ $# -eq 3 ] || usage "check takes a unit and a folder"
    with_unit "$2" "$3"
    check
    ;;
'' | -*) usage "no unit given" ;;
*)
    [ $# -eq 2 ] || usage "a unit takes a folder"
    with_unit "$1" "$2"
    run
    ;;
esac
