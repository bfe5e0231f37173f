# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 4: ordered dithering of few steps. None, white noise and Bayer's
# matrix on 8x8, with and without a blur, against N steps. Read by run.sh.

dither_noises="none white bayer"
dither_steps="4 8 16 32 64 100 200 400 800"
[ -z "$QUICK" ] || dither_steps="8 16 32 100"

dither_list()
{
    for dither_volume in $soft_scenes; do
        for dither_noise in $dither_noises; do
            echo "$dither_volume/$dither_noise"
        done
        [ -n "$QUICK" ] || echo "$dither_volume/time timed"
    done
}

dither_table()
{
    case $1 in
    */time) echo dither_time ;;
    *) echo dither ;;
    esac
}

# N steps across the box.
dither_step()
{
    case $1 in
    cube) echo "$2" | awk '{ print 96 / $1 }' ;;
    *) echo "$2" | awk '{ print 152 / $1 }' ;;
    esac
}

# `blur` is plain: the depth of the thesis's blur is that of solid things, which
# are not here. `aware` minds the depth of what scatters.
dither_settings() # NOISE none|blur|aware
{
    case $1 in
    none) echo jitter=none ;;
    white) echo jitter=primary noise=white8 ;;
    bayer) echo jitter=primary noise=bayer8 ;;
    esac
    case $2 in
    blur) echo spatial=bilateral15 edge_falloff=0 ;;
    aware) echo spatial=bilateral15 edge_falloff=16 ;;
    esac
}

dither_run()
{
    dither_volume=${1%/*} dither_noise=${1#*/}
    volume "$(soft_volume "$dither_volume")" >/dev/null || return
    if [ "$dither_noise" = time ]; then
        dither_time
        return
    fi
    dither_fine=$(toft_reference "$dither_volume") || return
    dither_head=
    for dither_n in $dither_steps; do
        for dither_blur in none blur aware; do
            # shellcheck disable=SC2046
            soft_sequence "$dither_volume" --set \
                "step=$(dither_step "$dither_volume" "$dither_n")" \
                $(sets $(dither_settings "$dither_noise" $dither_blur)) \
                --reference "fine=$dither_fine" \
                --column "scene=$dither_volume" \
                --column "noise=$dither_noise" --column "blur=$dither_blur" \
                --column "steps=$dither_n" >"$lab/rows/dither.$$" || return
            sed "$dither_head" "$lab/rows/dither.$$"
            dither_head=1d
        done
    done
    rm -f "$lab/rows/dither.$$"
}

# Undithered at all N, to interpolate; dithered at those that are compared.
dither_time()
{
    {
        for dither_n in $dither_steps; do
            echo "none-none-$dither_n" \
                "step=$(dither_step "$dither_volume" "$dither_n")"
        done
        for dither_blur in none blur aware; do
            for dither_noise in white bayer; do
                echo "$dither_noise-$dither_blur-8" \
                    "step=$(dither_step "$dither_volume" 8)" \
                    "$(dither_settings $dither_noise $dither_blur |
                        tr '\n' ' ')"
            done
        done
    } | soft_times "$dither_volume" |
        awk -F, -v OFS=, -v scene="$dither_volume" '
        NR == 1 { print "scene", "noise", "blur", "steps", $2, $3, $4, $5 }
        NR > 1 {
            split($1, name, "-")
            print scene, name[1], name[2], name[3], $2, $3, $4, $5
        }
        END { exit NR < 2 }'
}

## Claims ##

# at SCENE NOISE BLUR STEPS
dither_at()
{
    value dither rmse "scene=$1" "noise=$2" "blur=$3" "steps=$4"
}

dither_equal() { value dither_equal "$4" "scene=$1" "noise=$2" "blur=$3"; }

dither_check()
{
    for dither_volume in $soft_scenes; do
        for dither_n in 8 16 32; do
            published "dither_bayer_${dither_volume}_$dither_n" \
                "$(dither_at "$dither_volume" bayer blur $dither_n)" \< \
                "$(dither_at "$dither_volume" white blur $dither_n)" \
                "$dither_volume, N = $dither_n, blurred: Bayer below white"
        done
        claim "dither_blur_$dither_volume" \
            "$(dither_at "$dither_volume" bayer blur 8)" \< \
            "0.5 * $(dither_at "$dither_volume" none none 8)" \
            "$dither_volume, N = 8: Bayer and blur below half of undithered"
        published "dither_steps_$dither_volume" \
            "$(dither_equal "$dither_volume" bayer blur steps)" \> 80 \
            "$dither_volume: Bayer, N = 8, is worth 80 steps or more"
        [ -n "$QUICK" ] ||
            published "dither_speed_$dither_volume" \
                "$(dither_equal "$dither_volume" bayer blur speed)" \> 10 \
                "$dither_volume: Bayer, N = 8, is more than 10 times as fast"
    done
}

dither_measure()
{
    awk -F, -v OFS=, -v measure="$1" -f lab/equal.awk \
        "$out/dither_time.csv" "$out/dither.csv"
}

# How many undithered steps have the error of 8 dithered ones, and how much
# longer these take: between two N linearly in the logarithms. Without a blur
# on either side, as a blur of what is not noisy only costs. A bound, `least` or
# `most`, where the most steps that were tried have more error, the fewest less.
dither_derive()
{
    [ -f "$out/dither_time.csv" ] ||
        echo "scene,noise,blur,steps,ratio,ratio_least,ratio_most,ms" \
            >"$out/dither_time.csv"
    dither_measure rmse >"$out/dither_equal.csv"
    # Where brume-lab measures it: how visible bands and grain are.
    ! head -n 1 "$out/dither.csv" | grep -q ',flip' ||
        dither_measure flip >"$out/dither_equal_flip.csv"
    awk -F, -v OFS=, '
        NR == 1 {
            for (i = 1; i <= NF; i++)
                at[$i] = i
            next
        }
        {
            row = $1 OFS $2 OFS $3
            if (!(row in cells))
                order[++rows] = row
            cells[row] = cells[row] OFS $at["rmse"]
            if (row == order[1])
                head = head OFS "N = " $4
        }
        END {
            print "scene", "noise", "blur" head
            for (i = 1; i <= rows; i++)
                print order[i] cells[order[i]]
        }' "$out/dither.csv" >"$out/dither_table.csv"
}
