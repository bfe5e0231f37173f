#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh COMMAND: the laboratory.
#
#   list [PATTERN]        names of units, one a line; `timed` behind those that
#                         measure time and so run alone
#   unit NAME             one unit, even if its rows are there
#   units [PATTERN]       all units whose rows are not there yet, or were made
#                         with other settings, programs or inputs
#   collect               rows into tables, and the claims checked
#   page                  charts and docs/lab/README.md out of the tables
#   all                   units, collect, page; with QUICK set no page
#   --shard I/N           before list or units: each N-th unit, from I = 1 on.
#                         Rows do not depend on N
#
#   BUILD=dir (build)   DATA=dir: real volumes   JOBS=n: processes
#   QUICK=1: smaller and fewer; its rows and tables are kept apart
#
# Rows are in $BUILD/lab/rows/NAME.csv (quick: $BUILD/lab/quick/rows); the first
# line has the hash of all that they come from.
#
# An experiment X is a line of lab/experiments/order and these files:
#
#   lab/experiments/X.sh  X_list: names of its units without X/, and `timed`
#                         behind a name; X_run NAME: rows of one, a CSV with its
#                         head, on stdout, status 3 to skip it; and below a line
#                         `## Claims ##` X_check: claims (claims.sh); if need be
#                         X_table NAME: the table of its rows, and X_derive:
#                         tables out of tables
#   lab/charts/X*.gp      gnuplot, from tables in dir to dir/*.svg
#   lab/page/X.md         its section: page.awk has the placeholders; or
#                         X_page: that section on stdout
#   lab/X/*.sh            more scripts of its own, if any
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}" "${QUICK:=}"
: "${JOBS:=$(nproc 2>/dev/null || echo 2)}"
LC_ALL=C
export BUILD DATA QUICK JOBS LC_ALL
lab=$BUILD/lab${QUICK:+/quick}
out=docs/lab
[ -z "$QUICK" ] || out=$lab/tables
shard=1/1

usage() { sed -n '3,35s/^# \{0,1\}//p' "$0"; }

die()
{
    echo "lab: $*" >&2
    exit 2
}

# Programs and volumes are hashed once a run, not once a unit.
if [ -z "${LAB_INPUTS:-}" ]; then
    [ -x "$BUILD/brume-lab" ] || [ "${1:-}" = --help ] ||
        die "$BUILD/brume-lab is not there; make lab-programs builds it"
    LAB_REFERENCE=$(cat "$BUILD/brume-reference" "$BUILD/brume-monte-carlo" \
        2>/dev/null | sha256sum)
    LAB_MADE=$({
        cat "$BUILD/brume-bake" "$BUILD/brume-cloud" "$BUILD/brume-noise"
        cat "$DATA/wdas_cloud_sixteenth.vdb" "$DATA/openvdb_smoke1.vdb" || :
    } 2>/dev/null | sha256sum)
    LAB_INPUTS=$(echo "$LAB_MADE" | cat - "$BUILD/brume-lab" \
        "$BUILD/brume-papers" "$BUILD/brume-atlas" | sha256sum)
    export LAB_INPUTS LAB_REFERENCE LAB_MADE
fi
# shellcheck disable=SC2034
inputs=$LAB_INPUTS made_hash=$LAB_MADE reference_hash=$LAB_REFERENCE
. lab/lib.sh
. lab/claims.sh

# In the order of the page.
experiments=$(cat lab/experiments/order)
for file in lab/experiments/*.sh; do
    grep -qx "$(basename "$file" .sh)" lab/experiments/order ||
        die "$file is not in lab/experiments/order"
    # shellcheck disable=SC1090
    . "$file"
done

## Units ##

list_all()
{
    for experiment in $experiments; do
        "${experiment}_list" | sed "s|^|$experiment/|"
    done
}

# list [PATTERN]: those of this shard whose name holds it.
list()
{
    list_all | awk -v shard="$shard" -v pattern="${1:-}" '
        BEGIN { split(shard, s, "/") }
        (NR - s[1]) % s[2] == 0 && index($1, pattern)'
}

# Of an experiment what is above the line `## Claims ##`.
stamp_of()
{
    {
        echo "$1 $QUICK $inputs $reference_hash"
        cat lab/lib.sh lab/scenes/*.scene
        cat "lab/${1%%/*}"/*.sh 2>/dev/null || :
        sed '/^## Claims ##$/,$d' "lab/experiments/${1%%/*}.sh"
    } | hash_of
}

# Whether a unit's rows are there, of what it is now.
is_done()
{
    [ -f "$lab/rows/$1.csv" ] &&
        [ "$(head -n 1 "$lab/rows/$1.csv")" = "# $(stamp_of "$1")" ]
}

# A unit that cannot be run here, without its volume, has a row that says so.
unit()
{
    unit_at=$lab/rows/$1.csv
    list_all | awk '{ print $1 }' | grep -qxF "$1" ||
        die "there is no unit '$1'; lab/run.sh list has them"
    mkdir -p "$(dirname "$unit_at")"
    unit_new=$unit_at.new$$
    trap 'rm -f "$unit_new"' EXIT
    trap 'exit 130' INT TERM HUP
    echo "# $(stamp_of "$1")" >"$unit_new"
    unit_status=0
    ("${1%%/*}_run" "${1#*/}") >>"$unit_new" || unit_status=$?
    case $unit_status in
    0) ;;
    3) echo "# skipped" >>"$unit_new" ;;
    *)
        echo "lab: unit $1 failed" >&2
        exit 1
        ;;
    esac
    mv "$unit_new" "$unit_at"
}

# One of many, in a process of its own: goes on after one that fails.
work()
{
    work_status=0
    (unit "$1") || work_status=1
    [ $work_status = 0 ] || echo "$1" >>"$lab/failed"
    echo "$1" >>"$lab/progress"
    [ ! -t 2 ] || printf '\r\033[K%d/%d  %s' "$(wc -l <"$lab/progress")" \
        "$LAB_TOTAL" "$1" >&2
}

units()
{
    mkdir -p "$lab/rows"
    rm -f "$lab/failed" "$lab/progress"
    : >"$lab/pending"
    list "${1:-}" | while read -r name timed; do
        is_done "$name" || echo "$name $timed" >>"$lab/pending"
    done
    LAB_TOTAL=$(wc -l <"$lab/pending")
    export LAB_TOTAL
    # Those that take time are alone on the machine, after the others.
    awk '$2 != "timed" { print $1 }' "$lab/pending" |
        xargs -r -P "$JOBS" -n 1 sh "$0" work
    awk '$2 == "timed" { print $1 }' "$lab/pending" |
        xargs -r -P 1 -n 1 sh "$0" work
    [ ! -t 2 ] || printf '\r\033[K' >&2
    [ ! -s "$lab/failed" ] ||
        die "$(wc -l <"$lab/failed") of $LAB_TOTAL units failed"
}

## Tables ##

# Units' rows, in the order of `list`, behind the head that they share. An
# experiment with rows of several kinds names the table of each in X_table.
table_of()
{
    if command -v "${1%%/*}_table" >/dev/null; then
        "${1%%/*}_table" "${1#*/}"
    else
        echo "${1%%/*}"
    fi
}

collect()
{
    mkdir -p "$out"
    rm -rf "$lab/collected" "$lab/skipped"
    mkdir -p "$lab/collected"
    list_all | while read -r name timed; do
        is_done "$name" || die "unit $name has no rows, or old ones: run units"
        if grep -qx '# skipped' "$lab/rows/$name.csv"; then
            echo "$name" >>"$lab/skipped"
            continue
        fi
        to=$lab/collected/$(table_of "$name").csv
        head=$(sed -n 2p "$lab/rows/$name.csv")
        [ -f "$to" ] || echo "$head" >"$to"
        [ "$(head -n 1 "$to")" = "$head" ] ||
            die "unit $name has other columns than those before it"
        sed 1,2d "$lab/rows/$name.csv" >>"$to"
    done
    for table in "$lab/collected"/*.csv; do
        mv "$table" "$out/"
    done
    for table in lab/published/*.csv; do
        cp "$table" "$out/published_$(basename "$table")"
    done
    printf "name,value\nsize,%s\n" "$lab_size" >"$out/settings.csv"
    for experiment in $experiments; do
        ! command -v "${experiment}_derive" >/dev/null ||
            "${experiment}_derive"
    done
    check_claims
}

check_claims()
{
    echo "claim,result,text" >"$out/claims.csv"
    for experiment in $experiments; do
        "${experiment}_check"
    done
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ]
}

## Page ##

page()
{
    [ ! -s "$lab/skipped" ] ||
        die "the page needs every unit; without volumes: $(head -n 1 \
            "$lab/skipped") and $(wc -l <"$lab/skipped") in all"
    for chart in lab/charts/*.gp; do
        gnuplot -e "dir='$out'" "$chart" ||
            die "$chart: gnuplot could not draw it"
    done
    for chart in "$out"/*.svg; do
        rsvg-convert -o "${chart%.svg}.png" "$chart"
    done
    set -- lab/page/head.md
    for experiment in $experiments; do
        template=lab/page/$experiment.md
        if command -v "${experiment}_page" >/dev/null; then
            template=$lab/$experiment.md
            "${experiment}_page" >"$template"
        fi
        set -- "$@" "$template"
    done
    awk -v dir="$out" -f lab/page.awk "$@" >"$out/README.md.new" || {
        rm -f "$out/README.md.new"
        die "the page is as it was"
    }
    mv "$out/README.md.new" "$out/README.md"
}

if [ "${1:-}" = --shard ]; then
    shard=${2:-}
    echo "$shard" | awk -F/ '!(/^[0-9]+\/[0-9]+$/ && $1 > 0 && $1 <= $2) {
        exit 1 }' || die "--shard is I/N, 1 <= I <= N, not '$shard'"
    shift 2
fi
case ${1:-} in
list | units) "$1" "${2:-}" ;;
unit | work) "$1" "${2:-}" ;;
collect | page) "$1" ;;
all)
    [ "$shard" = 1/1 ] || die "--shard goes with list and units"
    units ""
    if [ -n "$QUICK" ]; then
        collect
    else
        collect && page
    fi
    ;;
--help | -h) usage ;;
*)
    echo "lab: the commands are list unit units collect page all, not" \
        "'${1:-}'; --help tells more" >&2
    exit 2
    ;;
esac
