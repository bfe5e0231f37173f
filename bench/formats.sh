#!/bin/sh
# SPDX-License-Identifier: MIT
# formats.sh: what the choices of order, apron, format, skipping and threads
# cost and gain, as ratios of times and bytes. Asserts nothing.
#
#   BUILD=dir  our programs         RUNS=n    runs of each (7)
#   DATA=dir   real volumes         SIZE=WxH  of the pictures (640x360)
#
# Two commands run in turn, A B A B ...; a ratio is the median of the ratios
# B/A of neighbours, which a machine that is busy with other things disturbs
# least. Times are of whole processes: start, checking the asset, writing the
# picture. All but the last line of a volume use one thread.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}" "${RUNS:=7}" "${SIZE:=640x360}"
dir=$BUILD/bench/formats
mkdir -p "$dir"

case $(date +%N) in
*[!0-9]*)
    echo "formats.sh: date does not know nanoseconds here" >&2
    exit 1
    ;;
esac

# A quick scene and a fine one.
fast="--set filter=nearest --set light=log --set light_samples=8
    --set light_step=1 --set step=1"
fine="--set filter=trilinear --set light=uniform --set light_samples=32
    --set light_step=2 --set step=1"
same="--set size=$SIZE --set jitter=none --set noise=none"

# bake NAME FORMAT OPTIONS...: the current volume, to $dir/NAME.brume
bake()
{
    bake_name=$1 bake_format=$2
    shift 2
    "$BUILD/brume-bake" "$vdb" -o "$dir/$bake_name.brume" \
        --format "$bake_format" "$@" >/dev/null
}

# render NAME OPTIONS...
render()
{
    render_name=$1
    shift
    # shellcheck disable=SC2086
    "$BUILD/brume" render "$dir/$render_name.brume" $same "$@" \
        -o "$dir/out.ppm"
}

# Nanoseconds of a command.
spent()
{
    spent_from=$(date +%s%N)
    "$@"
    spent_to=$(date +%s%N)
    echo $((spent_to - spent_from))
}

# Median, least and most of numbers, one a line.
spread()
{
    sort -n | awk '{ v[NR] = $1 } END {
        m = NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2
        printf "%.3f  %.3f-%.3f", m, v[1], v[NR] }'
}

bytes()
{
    wc -c <"$dir/$1.brume"
}

# versus TEXT A "OPTIONS OF A" B "OPTIONS OF B": a line of the table, B / A.
versus()
{
    : >"$dir/ratios"
    # shellcheck disable=SC2086
    render "$2" $3
    # shellcheck disable=SC2086
    render "$4" $5
    versus_run=0
    while [ "$versus_run" -lt "$RUNS" ]; do
        # shellcheck disable=SC2086
        versus_a=$(spent render "$2" $3)
        # shellcheck disable=SC2086
        versus_b=$(spent render "$4" $5)
        echo "$versus_a $versus_b" | awk '{ print $2 / $1 }' >>"$dir/ratios"
        versus_run=$((versus_run + 1))
    done
    versus_bytes=$(echo "$(bytes "$2") $(bytes "$4")" |
        awk '{ printf "%.2f", $2 / $1 }')
    printf '%-38s %s  %s\n' "$1" "$(spread <"$dir/ratios")" "$versus_bytes"
}

# bench TITLE FILE: all lines for one volume.
bench()
{
    vdb=$2
    bake u8 u8
    bake u8_linear u8 --order linear
    bake u8_apron u8 --apron
    bake u8r u8r
    bake u4r u4r
    echo
    printf '%-38s %s\n' "$1" "time   (least-most)  bytes"
    one="--threads 1"
    versus "linear / morton, nearest, log" \
        u8 "$fast $one" u8_linear "$fast $one"
    versus "linear / morton, trilinear, uniform" \
        u8 "$fine $one" u8_linear "$fine $one"
    versus "apron / none, nearest, log" u8 "$fast $one" u8_apron "$fast $one"
    versus "apron / none, trilinear, uniform" \
        u8 "$fine $one" u8_apron "$fine $one"
    versus "u8r / u8, nearest, log" u8 "$fast $one" u8r "$fast $one"
    versus "u4r / u8, nearest, log" u8 "$fast $one" u4r "$fast $one"
    versus "u8r / u8, trilinear, uniform" u8 "$fine $one" u8r "$fine $one"
    versus "u4r / u8, trilinear, uniform" u8 "$fine $one" u4r "$fine $one"
    versus "skip off / on, nearest, log" \
        u8 "$fast $one" u8 "$fast $one --set skip=off"
    versus "skip off / on, trilinear, uniform" \
        u8 "$fine $one" u8 "$fine $one --set skip=off"
    versus "2 threads / 1, trilinear, uniform" \
        u8 "$fine $one" u8 "$fine --threads 2"
}

echo "Ratios B / A of $RUNS pairs of runs, $SIZE: below 1, the first is faster."
"$BUILD/brume-cloud" -o "$dir/cloud.vdb" --size 256 >/dev/null
bench "cloud of brume-cloud, 256" "$dir/cloud.vdb"
for name in wdas_cloud_sixteenth openvdb_smoke1; do
    if [ -f "$DATA/$name.vdb" ]; then
        bench "$name" "$DATA/$name.vdb"
    else
        echo
        echo "$name.vdb is not in $DATA: left out"
    fi
done
rm -rf "$dir"
