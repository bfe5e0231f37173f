#!/bin/sh
# SPDX-License-Identifier: MIT
# light.sh: the kinds of light against 256 uniform samples, on three volumes
# under suns of 10, 35 and 80 degrees: RMSE and mean error of 255, and the time
# of the march, one thread of the scalar core. A table in Markdown on stdout;
# light.csv and charts into $BUILD/bench. Asserts nothing.
#
#   BUILD=dir  our programs (build)     DATA=dir  real volumes
#   RUNS=n     timed runs of each (5)
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}" "${RUNS:=5}"
here=$(dirname "$0")
out=$BUILD/bench
volumes=$out/volumes
mkdir -p "$volumes"
csv=$out/light.csv

if [ $# -gt 0 ]; then
    sed -n '3,11s/^# \{0,1\}//p' "$0"
    exit
fi

# bake NAME FILE FORMAT
bake()
{
    [ -f "$volumes/mips_$1.brume" ] ||
        "$BUILD/brume-bake" "$2" -o "$volumes/mips_$1.brume" --format "$3" \
            --mips >/dev/null
}

"$BUILD/brume-cloud" -o "$volumes/light_cumulus.vdb" >/dev/null
bake cumulus "$volumes/light_cumulus.vdb" u8
for name in disney:wdas_cloud_sixteenth.vdb:u8 smoke:openvdb_smoke1.vdb:u8r; do
    file=${name#*:}
    if [ -f "$DATA/${file%:*}" ]; then
        bake "${name%%:*}" "$DATA/${file%:*}" "${file#*:}"
    else
        echo "${file%:*} IS NOT IN $DATA: LEFT OUT" | tee /dev/stderr
    fi
done

common="--set size=480x270 --set jitter=none --set output=linear
    --set min_transmittance=0.001 --threads 1 --kernel scalar"

# draw VOLUME SUN PICTURE SETTINGS...: the march's milliseconds on stdout.
draw()
{
    volume=$1 sun=$2 picture=$3
    shift 3
    for setting; do
        set -- "$@" --set "$setting"
        shift
    done
    # shellcheck disable=SC2086
    "$BUILD/brume" render "$volumes/mips_$volume.brume" -o "$picture" $common \
        --set "sun=-60 $sun" "$@" --profile 2>&1 |
        awk '$1 == "ms" { for (at = 1; $at != "march";) at++ }
            $1 == "all" { print $at }'
}

# fastest ... of RUNS
fastest()
{
    run=0
    while [ "$run" -lt "$RUNS" ]; do
        draw "$@"
        run=$((run + 1))
    done | sort -g | head -1
}

value() { echo "$metrics" | sed -n "s/^$1=//p"; }

# One line for each kind; the papers' light is log.
kinds="log:light=log:light_samples=10:light_step=1
cone:light=cone:light_samples=10:light_step=1
cache2:light=cache:cache_spacing=2
cache4:light=cache:cache_spacing=4
cache8:light=cache:cache_spacing=8
uniform16:light=uniform:light_samples=16:light_step=16
uniform64:light=uniform:light_samples=64:light_step=4"

echo "volume,sun,filter,light,rmse,mean,max,ms" >"$csv"
for volume in disney cumulus smoke; do
    [ -f "$volumes/mips_$volume.brume" ] || continue
    for filter in nearest trilinear; do
        for sun in 10 35 80; do
            ms=$(draw "$volume" "$sun" "$out/light_true.png" filter=$filter \
                light=uniform light_samples=512 light_step=0.5)
            echo "$volume,$sun,$filter,true,0,0,0,$ms" >>"$csv"
            for kind in $kinds; do
                # shellcheck disable=SC2046
                ms=$(fastest "$volume" "$sun" "$out/light.png" filter=$filter \
                    $(echo "${kind#*:}" | tr : ' '))
                metrics=$("$BUILD/brume" compare "$out/light.png" \
                    "$out/light_true.png" --metrics rmse,mean,max)
                echo "$volume,$sun,$filter,${kind%%:*},$(value rmse),$(value \
                    mean),$(value max),$ms" >>"$csv"
            done
        done
    done
done

# Error of each kind, and its time in those of log, over the three suns.
awk -F, -v dir="$out" '
    NR == 1 || $4 == "true" { next }
    !($4 in seen) { seen[$4] = ++kinds; kind[kinds] = $4 }
    !($1 "," $3 in known) { known[$1 "," $3] = ++rows; row[rows] = $1 "," $3 }
    {
        r[$1 "," $3, $4] = r[$1 "," $3, $4] sprintf("%s%.2f", \
            $2 == 10 ? "" : " / ", $5)
        t[$1 "," $3, $4] += $8
        time[$3, $4] += $8
        print $2 "," $5 >(dir "/light_" $1 "_" $3 "_" $4 ".dat")
    }
    END {
        line = "| volume, lookup |"
        rule = "|---|"
        for (k = 1; k <= kinds; k++) {
            line = line " " kind[k] " |"
            rule = rule "---|"
        }
        print line "\n" rule
        for (i = 1; i <= rows; i++) {
            name = row[i]
            sub(",", ", ", name)
            line = "| " name " |"
            for (k = 1; k <= kinds; k++)
                line = line " " r[row[i], kind[k]] " |"
            print line
        }
        for (i = 1; i <= 2; i++) {
            name = i == 1 ? "nearest" : "trilinear"
            line = "| time, " name ", log = 1 |"
            for (k = 1; k <= kinds; k++)
                line = line sprintf(" %.2f |", \
                    time[name, kind[k]] / time[name, "log"])
            print line
        }
    }' "$csv"

# One random voxel for eight: against trilinear lookups of the same samples, by
# the frame of an average over time; without jitter of the samples themselves.
stochastic()
{
    volume=$1
    still="--set size=480x270 --set jitter=none --set output=linear --set
        light=log --set light_samples=10 --set light_step=1"
    # shellcheck disable=SC2086
    "$BUILD/brume" render "$volumes/mips_$volume.brume" $still \
        --set filter=trilinear -o "$out/light_true.png"
    for noise in nearest white fast r2; do
        filter=stochastic
        [ "$noise" != nearest ] || filter=nearest
        # shellcheck disable=SC2086
        "$BUILD/brume" render "$volumes/mips_$volume.brume" $still \
            --frames 0:31 --set temporal=ema --set alpha=0.1 --set \
            noise="$(echo "$noise" | sed 's/nearest/none/')" \
            --set filter=$filter -o "$out/stochastic_%02d.png"
        for frame in $(seq 0 31); do
            metrics=$("$BUILD/brume" compare \
                "$(printf '%s/stochastic_%02d.png' "$out" "$frame")" \
                "$out/light_true.png" --metrics rmse,mean)
            echo "$volume,$noise,$frame,$(value rmse),$(value mean)"
        done
    done
}

echo "volume,noise,frame,rmse,mean" >"$out/stochastic.csv"
for volume in disney cumulus smoke; do
    [ ! -f "$volumes/mips_$volume.brume" ] ||
        stochastic "$volume" >>"$out/stochastic.csv"
done
printf '\n| stochastic against trilinear: frame 0, frame 31 | nearest | white |'
printf ' fast | r2 |\n|---|---|---|---|---|\n'
awk -F, 'NR > 1 && ($3 == 0 || $3 == 31) {
        cell[$1] = cell[$1] ($3 == 0 ? " | " : ", ") sprintf("%.2f", $4)
        mean[$1] = mean[$1] ($3 == 31 ? " | " sprintf("%+.3f", $5) : "")
    }
    END {
        for (v in cell)
            print "| " v ", RMSE" cell[v] " |\n| " v ", mean, frame 31" \
                mean[v] " |"
    }' "$out/stochastic.csv"

if command -v gnuplot >/dev/null; then
    gnuplot -e "dir='$out'" "$here/light.gp"
fi
