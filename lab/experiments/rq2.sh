# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 2: Blomqvist 2025, RQ2. As experiment 1, with 12 unique frames and
# a spatial filter behind EMA; FAST is made for that filter. Read by run.sh.

rq2_filters="none gauss1 binomial3 box3 binomial5 box5"
rq2_noises="white blue ign stbn fast fast-separate"

rq2_list()
{
    for rq2_scene in disney cube; do
        for rq2_filter in $rq2_filters; do
            # Box filters of both sizes show all there is.
            case $QUICK$rq2_filter in
            1binomial3 | 1binomial5 | 1box3) continue ;;
            esac
            echo "$rq2_scene/$rq2_filter"
        done
    done
}

# 16 frames, of which 12 are used, as lengths are powers of two.
# `fast-separate` weighs both parts alike, as the published textures do.
rq2_noise_of() # NOISE FILTER
{
    case $1 in
    blue) noise blue-slices 64x64x16 ;;
    stbn) noise stbn 64x64x16 ;;
    fast)
        noise fast 64x64x16 --filter "$2" --time ema:0.1,0.1 --combine product
        ;;
    fast-separate)
        noise fast 64x64x16 --filter "$2" --time ema:0.1,0.1 \
            --combine separate:1
        ;;
    ign) echo ign-thesis ;;
    *) echo "$1" ;;
    esac
}

# References: `light`, exact towards the sun and not filtered, as in the paper;
# `limit`, the mean of the method over all jitters under the same filter.
rq2_run()
{
    rq2_volume=${1%/*} rq2_filter=${1#*/}
    rq2_scene=$(rq1_scene_of "$rq2_volume")
    volume "$rq2_volume" >/dev/null || return
    rq2_light=$(reference "$rq2_volume" "$rq2_scene" light=uniform \
        light_samples=256 light_step=2.5 size="$lab_size") || return
    rq2_limit=$(mean_picture "$rq2_volume" "$rq2_scene" 512 jitter=light \
        "spatial=$rq2_filter") || return
    for rq2_noise in $rq2_noises; do
        rq2_texture=$(rq2_noise_of "$rq2_noise" "$rq2_filter") || return
        sequence "$rq2_volume" "$rq2_scene" --set jitter=light \
            --set "noise=$rq2_texture" --set temporal=ema --set alpha=0.1 \
            --set "spatial=$rq2_filter" --frames 0:31 --cycle 12 \
            --reference "light=$rq2_light" --reference "limit=$rq2_limit" \
            --column "scene=$rq2_volume" --column "filter=$rq2_filter" \
            --column "noise=$rq2_noise" >"$lab/rows/rq2.$$" || return
        [ "$rq2_noise" = white ] || sed -i 1d "$lab/rows/rq2.$$"
        cat "$lab/rows/rq2.$$"
    done
    rm -f "$lab/rows/rq2.$$"
}

## Claims ##

# at SCENE FILTER NOISE FRAME REFERENCE
rq2_at()
{
    value rq2 rmse "scene=$1" "filter=$2" "noise=$3" "frame=$4" "reference=$5"
}

rq2_check()
{
    for rq2_scene in disney cube; do
        for rq2_filter in $(rq2_list | sed -n "s|^$rq2_scene/||p"); do
            [ "$rq2_filter" = none ] ||
                rq2_check_filter "$rq2_scene" "$rq2_filter"
        done
    done
}

# Where noise of a frame is lowest, and what a filter is good for.
rq2_check_filter()
{
    for rq2_noise in white blue ign stbn; do
        for rq2_frame in 0 31; do
            published "rq2_fast_below_${rq2_noise}_${1}_${2}_$rq2_frame" \
                "$(rq2_at "$1" "$2" fast $rq2_frame light)" \< \
                "$(rq2_at "$1" "$2" $rq2_noise $rq2_frame light)" \
                "RMSE at frame $rq2_frame, $1, $2: FAST below $rq2_noise"
        done
    done
    published "rq2_early_$1_$2" \
        "$(rq2_at "$1" none white 0 light) -
            $(rq2_at "$1" "$2" white 0 light)" \
        \> "3 * ($(rq2_at "$1" none white 31 light) -
            $(rq2_at "$1" "$2" white 31 light))" \
        "$1, $2, white: at frame 0 it gains more than 3 times as much as at 31"
    # What it was made for: the noise of a frame under the filter.
    claim "rq2_noise_$1_$2" "$(rq2_at "$1" "$2" fast 0 limit)" \< \
        "0.75 * $(rq2_at "$1" "$2" white 0 limit)" \
        "noise of frame 0, $1, $2: FAST below 3/4 of white"
}

# Two tables of the page, a column a filter: RMSE, and the noise in it.
rq2_derive()
{
    rq2_wide light >"$out/rq2_table.csv"
    rq2_wide limit >"$out/rq2_noise.csv"
}

rq2_wide() # REFERENCE
{
    awk -F, -v OFS=, -v reference="$1" '
        NR == 1 {
            for (i = 1; i <= NF; i++)
                at[$i] = i
            next
        }
        $at["reference"] != reference || $at["frame"] !~ /^(0|31)$/ { next }
        {
            row = $at["scene"] OFS $at["frame"] OFS $at["noise"]
            if (!(row in seen))
                order[++rows] = row
            seen[row]
            if (!($at["filter"] in column)) {
                column[$at["filter"]]
                filters[++n] = $at["filter"]
            }
            cell[row, $at["filter"]] = $at["rmse"]
        }
        END {
            line = "scene" OFS "frame" OFS "noise"
            for (k = 1; k <= n; k++)
                line = line OFS filters[k]
            print line
            for (i = 1; i <= rows; i++) {
                line = order[i]
                for (k = 1; k <= n; k++)
                    line = line OFS cell[order[i], filters[k]]
                print line
            }
        }' "$out/rq2.csv" | { read -r rq2_head; echo "$rq2_head"
            sort -s -t, -k 1,1r -k 2,2n; }
}
