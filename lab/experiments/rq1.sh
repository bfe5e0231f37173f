# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 1: Blomqvist 2025, RQ1. Noises on the light ray under EMA, frame by
# frame, in two scenes. Read by run.sh.

# The published five; two more FAST textures, as the published one is made for
# one filter and a short history (product) or weighs space and time alike
# (separate), and ours with twice the frames; interleaved gradient noise as it
# is usually moved; and none.
rq1_noises="none white blue ign ign-jimenez stbn fast fast-64 fast-product
    fast-separate"

rq1_list()
{
    for rq1_scene in disney cube; do
        for rq1_noise in $rq1_noises; do
            echo "$rq1_scene/$rq1_noise"
        done
    done
}

# As many frames as the sequence has, none twice.
# shellcheck disable=SC2086
rq1_noise_of()
{
    rq1_matched="--filter gauss1 --time ema:0.1,0.1 --combine"
    case $1 in
    blue) noise blue-slices 64x64x64 ;;
    stbn) noise stbn 64x64x64 ;;
    fast) noise fast 64x64x32 ;;
    fast-64) noise fast 64x64x64 ;;
    fast-product) noise fast 64x64x32 $rq1_matched product ;;
    fast-separate) noise fast 64x64x32 $rq1_matched separate:1 ;;
    ign) echo ign-thesis ;;
    ign-jimenez) echo ign ;;
    *) echo "$1" ;;
    esac
}

rq1_scene_of()
{
    case $1 in
    disney) echo disney_low_sun ;;
    cube) echo cube_against_sun ;;
    esac
}

# Where the scenes differ: what is lit, what is shaded, where one becomes the
# other, and the outline.
rq1_regions()
{
    case $1 in
    disney)
        echo --region lit=0.58,0.68,0.10,0.14 \
            --region shaded=0.26,0.66,0.12,0.16 \
            --region border=0.42,0.40,0.10,0.18 \
            --region fringe=0.74,0.68,0.08,0.14
        ;;
    cube)
        echo --region lit=0.25,0.12,0.40,0.05 \
            --region shaded=0.30,0.45,0.28,0.30 \
            --region border=0.25,0.17,0.36,0.08 \
            --region fringe=0.19,0.25,0.06,0.50
        ;;
    esac
}

# References: `truth`; `light`, which marches the same samples of the view ray
# and is exact towards the sun, as in the paper; `limit`, the mean of the
# method itself over all jitters, from which it differs by noise alone.
rq1_run()
{
    rq1_volume=${1%/*} rq1_noise=${1#*/}
    rq1_scene=$(rq1_scene_of "$rq1_volume")
    volume "$rq1_volume" >/dev/null || return
    rq1_jitter=light
    [ "$rq1_noise" != none ] || rq1_jitter=none
    rq1_texture=$(rq1_noise_of "$rq1_noise") || return
    # shellcheck disable=SC2086
    rq1_truth=$(reference "$rq1_volume" "$rq1_scene" $lab_truth \
        size=$lab_size) || return
    rq1_light=$(reference "$rq1_volume" "$rq1_scene" light=uniform \
        light_samples=256 light_step=2.5 size="$lab_size") || return
    rq1_limit=$(mean_picture "$rq1_volume" "$rq1_scene" 512 \
        jitter=$rq1_jitter) || return
    # shellcheck disable=SC2046
    sequence "$rq1_volume" "$rq1_scene" --set jitter=$rq1_jitter \
        --set "noise=$rq1_texture" --set temporal=ema --set alpha=0.1 \
        --frames 0:31 $(rq1_regions "$rq1_volume") \
        --reference "truth=$rq1_truth" --reference "light=$rq1_light" \
        --reference "limit=$rq1_limit" --column "scene=$rq1_volume" \
        --column "noise=$rq1_noise"
}

## Claims ##

# at SCENE NOISE FRAME [REFERENCE [COLUMN [REGION]]]
rq1_at()
{
    value rq1 "${5:-rmse}" "scene=$1" "noise=$2" "frame=$3" \
        "reference=${4:-light}" "region=${6:-all}"
}

rq1_check()
{
    for rq1_scene in disney cube; do
        rq1_check_scene "$rq1_scene"
    done
}

rq1_check_scene()
{
    rq1_white=$(rq1_at "$1" white 31)
    # The paper's FAST weighs space and time alike: fast-separate is its like.
    for rq1_noise in white blue ign stbn; do
        for rq1_fast in fast fast-separate; do
            published "rq1_${rq1_fast}_below_${rq1_noise}_$1" \
                "$(rq1_at "$1" $rq1_fast 31)" \< \
                "$(rq1_at "$1" $rq1_noise 31)" \
                "RMSE at frame 31, $1: $rq1_fast below $rq1_noise"
        done
    done
    published "rq1_white_is_blue_$1" \
        "($(rq1_at "$1" blue 31) / $rq1_white - 1)^2" \< 0.02^2 \
        "RMSE at frame 31, $1: blue is white within 2 %"
    # One frame of any noise is as wrong as of any other, each having all values
    # equally often: three standard errors, 1 % each, of some 5000 pixels.
    for rq1_noise in blue ign stbn fast fast-64 fast-product \
        fast-separate; do
        claim "rq1_frame0_${rq1_noise}_$1" \
            "($(rq1_at "$1" "$rq1_noise" 0) /
                $(rq1_at "$1" white 0) - 1)^2" \< 0.03^2 \
            "frame 0, $1: $rq1_noise within 3 % of white"
    done
    # What averaging can remove. Of independent frames EMA 0.1 that began with a
    # copy leaves sqrt(sum of squared weights) = 0.2326 after 32, less what the
    # limit shares with them, a 512th of the variance: 0.229. Within 5 %, three
    # standard errors of RMSE over some 2000 pixels with noise.
    claim "rq1_ema_$1" \
        "($(rq1_at "$1" white 31 limit) /
            $(rq1_at "$1" white 0 limit) / 0.229 - 1)^2" \< 0.05^2 \
        "white, $1: EMA 0.1 leaves 0.229 of the noise within 5 %"
    for rq1_noise in stbn fast fast-64 fast-separate; do
        claim "rq1_less_noise_${rq1_noise}_$1" \
            "$(rq1_at "$1" "$rq1_noise" 31 limit)" \< \
            "0.75 * $(rq1_at "$1" white 31 limit)" \
            "noise at frame 31, $1: $rq1_noise below 3/4 of white"
    done
    # Bands stay.
    claim "rq1_jitter_$1" "$(rq1_at "$1" fast 31)" \< \
        "$(rq1_at "$1" none 31)" \
        "RMSE at frame 31, $1: jittered below not jittered, which bands"
}

# Tables of the page: RMSE by frame, and how far the limit itself is from the
# references: RMSE^2 of white noise less that of its noise, the two being
# independent, at frame 31.
rq1_derive()
{
    awk -F, -v OFS=, '
        NR == 1 {
            print "scene", "noise", "frame 0", "1", "3", "7", "15", "31", \
                "mean at 31", "noise at 31"
            next
        }
        $5 != "all" { next }
        $4 == "light" {
            if ($3 ~ /^(0|1|3|7|15|31)$/)
                row = row OFS $6
            mean = $7
        }
        $4 == "limit" && $3 == 31 {
            print $1, $2 row, mean, $6
            row = ""
        }' "$out/rq1.csv" >"$out/rq1_table.csv"
    awk -F, -v OFS=, '
        NR == 1 { print "scene", "reference", "rmse"; next }
        $3 == 31 && $2 == "white" && $5 == "all" { error[$1, $4] = $6 ^ 2 }
        $3 == 31 && $2 == "white" && $5 == "all" && $4 == "limit" {
            for (i = split("truth light", to, " "); i > 0; i--)
                print $1, to[i], sqrt(error[$1, to[i]] - error[$1, $4])
        }' "$out/rq1.csv" >"$out/rq1_limits.csv"
}
