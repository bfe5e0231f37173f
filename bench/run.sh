#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh [PART...]: our march beside its peers, how it scales, and what the
# machine allows. Tables in Markdown on stdout, figures and charts in
# $BUILD/bench. Asserts nothing.
#
#   BUILD=dir  our programs (build)        RUNS=n  runs of each (7)
#   DATA=dir   real volumes                BIG=no  leaves the largest cloud out
#
# Parts: peers limit layouts scale jitter start formats, all of them by default;
# `update` runs all but formats and renews docs/BENCH.md and docs/bench.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}" "${RUNS:=7}" "${BIG:=yes}"
here=$(dirname "$0")
out=$BUILD/bench
volumes=$out/volumes
mkdir -p "$volumes"

usage()
{
    sed -n '3,12s/^# \{0,1\}//p' "$0"
}

say()
{
    [ ! -t 2 ] || printf '%s\n' "$*" >&2
}

## Volumes ##

# cloud NAME OPTIONS...: models and bakes one, unless it is there.
cloud()
{
    cloud_name=$1
    shift
    [ -f "$volumes/$cloud_name.brume" ] && return
    say "modelling $cloud_name"
    "$BUILD/brume-cloud" -o "$volumes/$cloud_name.vdb" "$@" >/dev/null
    bake "$cloud_name" "$volumes/$cloud_name.vdb" u8
}

# bake NAME VDB FORMAT: and once more with bricks in linear order.
bake()
{
    "$BUILD/brume-bake" "$2" -o "$volumes/$1_linear.brume" --format "$3" \
        --order linear >/dev/null
    "$BUILD/brume-bake" "$2" -o "$volumes/$1.brume" --format "$3" >/dev/null
}

# real NAME FILE FORMAT: one of $DATA, or a loud line.
real()
{
    if [ ! -f "$DATA/$2" ]; then
        echo "$2 IS NOT IN $DATA: LEFT OUT" | tee /dev/stderr
        return 1
    fi
    [ -f "$volumes/$1.brume" ] && return
    ln -sf "$(cd "$DATA" && pwd)/$2" "$volumes/$1.vdb"
    bake "$1" "$volumes/$1.vdb" "$3"
}

# Cameras that see the volume on about half of the pixels. Clouds have a
# density of 1 at most, the extinction of the published scene, 0.05.
camera()
{
    case $1 in
    disney)
        echo eye=572.6,280.5,967.4 target=-10,75,-41.67 fov=15 sun=-60,30 \
            density_scale=0.2 light_density_scale=0.07
        ;;
    smoke)
        echo eye=0,33,180 target=-24,33,-13 fov=20.5 sun=40,20 \
            density_scale=0.6 light_density_scale=0.3
        ;;
    big)
        echo eye=1330,140,2162 target=508,343,609 fov=25 sun=-68,36 \
            density_scale=0.05 light_density_scale=0.05
        ;;
    cloud512)
        echo eye=600,80,910 target=260,168,260 fov=25 sun=-68,36 \
            density_scale=0.05 light_density_scale=0.05
        ;;
    *)
        echo eye=300,40,455 target=130,84,130 fov=25 sun=-68,36 \
            density_scale=0.05 light_density_scale=0.05
        ;;
    esac
}

# The published scene: step 2, ten doubling light samples, T < 0.05 ends.
thesis="step=2 min_density=0 min_transmittance=0.05 light=log light_samples=10
    light_step=1 jitter=primary noise=ign background=0 output=linear
    filter=nearest size=960x540"
trilinear="filter=trilinear"
uniform="light=uniform light_samples=256 light_step=2.5"

## Running ##

kernels()
{
    "$BUILD/brume-bench" --kernels
}

widest()
{
    kernels | tail -1
}

# row NAME RENDERER VOLUME SETTINGS...: a contender; later settings win.
row()
{
    row_name=$1 row_render=$2 row_volume=$3
    shift 3
    # shellcheck disable=SC2086
    echo "name=$row_name render=$row_render $row_volume" $thesis "$@"
}

with_peers() { echo "vdb=$volumes/$1.vdb asset=$volumes/$1.brume"; }
ours_alone() { echo "asset=$volumes/$1.brume"; }

# figures NAME: contenders on stdin -> $out/NAME.csv
figures()
{
    say "$1"
    "$BUILD/brume-bench" "$RUNS" >"$out/$1.csv.new"
    mv "$out/$1.csv.new" "$out/$1.csv"
}

table() { awk -f "$here/table.awk" "$@"; }

## Parts ##

. "$here/peers.sh"
. "$here/limit.sh"
. "$here/layouts.sh"
. "$here/start.sh"
. "$here/scale.sh"

part_formats()
{
    BUILD=$BUILD DATA=$DATA RUNS=$RUNS sh "$here/formats.sh"
}

machine()
{
    echo "$(date +%Y-%m-%d), $(uname -m), $(nproc) processors," \
        "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)," \
        "kernels: $(kernels | tr '\n' ' ')"
    echo "($(sed -n 's/^flags[^:]*: //p' /proc/cpuinfo | head -1 | tr ' ' '\n' |
        grep -E '^(avx|bmi|fma|sse4|f16c)' | tr '\n' ' ')), $(${CC:-cc} \
        -dumpfullversion -dumpversion | head -1), $RUNS runs," \
        "load $(cut -d' ' -f1-3 /proc/loadavg)."
}

# Puts each $out/PART.md between its markers in docs/BENCH.md.
update()
{
    for part in machine peers limit layouts scale jitter start; do
        case $part in
        machine) machine ;;
        *) "part_$part" ;;
        esac >"$out/$part.md"
        cat "$out/$part.md"
    done
    awk -v dir="$out" '
        /^<!-- end -->$/ { skip = 0 }
        !skip { print }
        /^<!-- begin [a-z]+ -->$/ {
            file = dir "/" $3 ".md"
            while ((getline line <file) > 0)
                print line
            close(file)
            skip = 1
        }' docs/BENCH.md >"$out/BENCH.md"
    cp "$out/BENCH.md" docs/BENCH.md
    mkdir -p docs/bench
    cp "$out"/*.csv "$out"/*.svg docs/bench/
}

[ $# -gt 0 ] || set -- peers limit layouts scale jitter start formats
for part; do
    case $part in
    --help | -h)
        usage
        exit
        ;;
    peers | limit | layouts | scale | jitter | start | formats | update) ;;
    *)
        echo "run.sh: there is no part '$part'; --help lists them" >&2
        exit 2
        ;;
    esac
done
[ "$1" = update ] || machine
for part; do
    if [ "$part" = update ]; then
        update
    else
        "part_$part"
    fi
done
