# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 3: Toft, Bowles, Zimmermann 2016. A sixteenth of the steps, with
# jitter and TAA; and brightness against step length. Read by run.sh.

toft_resolutions="full half quarter"
toft_methods="steps128 steps8 steps8_jitter steps8_taa"
# Voxels. Beyond 1/sigma = 10 a forward Euler step takes more than there is.
toft_steps="0.5 1 2 4 8 16 32"

## Scenes of long mean free paths, for experiment 4, too ##

# `thin` is the Disney cloud with a mean free path of 50 voxels.
soft_scenes="disney thin cube"

soft_volume() { echo "$1" | sed 's/thin/disney/'; }

soft_keys()
{
    [ "$1" != thin ] || echo density_scale=0.02 light_density_scale=0.02
}

# soft_sequence SCENE ARGUMENT...
soft_sequence()
{
    soft_at=$(soft_volume "$1") soft_more=$(soft_keys "$1")
    shift
    # shellcheck disable=SC2046,SC2086
    sequence "$soft_at" "${soft_at}_soft" $(sets $soft_more) "$@"
}

# soft_times SCENE: frame_times of lines on stdin.
soft_times()
{
    sed "s/\$/ $(soft_keys "$1")/" |
        frame_times "$(soft_volume "$1")" "$(soft_volume "$1")_soft" 3
}

## Units ##

toft_list()
{
    for toft_volume in $soft_scenes; do
        for toft_resolution in $toft_resolutions; do
            echo "$toft_volume/$toft_resolution"
        done
        echo "$toft_volume/brightness"
        # NanoVDB is not built for the reduced laboratory.
        [ -n "$QUICK" ] || echo "$toft_volume/time timed"
    done
}

toft_table()
{
    case $1 in
    */brightness) echo toft_brightness ;;
    */time) echo toft_time ;;
    *) echo toft ;;
    esac
}

# Of a side of the box, 128 and 8.
toft_step()
{
    case $1/$2 in
    cube/steps128) echo 0.75 ;;
    cube/*) echo 12 ;;
    */steps128) echo 1.1875 ;;
    *) echo 19 ;;
    esac
}

toft_settings() # VOLUME METHOD RESOLUTION
{
    echo "step=$(toft_step "$1" "$2") resolution=$3"
    # Of the kinds of noise, the one for jittered view rays (docs/noise.md).
    case $2 in
    steps8_jitter) echo jitter=primary noise=rank1 ;;
    steps8_taa) echo jitter=primary noise=rank1 temporal=taa subpixel=off ;;
    esac
}

# The same light, a step of a quarter of a voxel: so the error is that of steps
# and rays alone.
toft_reference()
{
    # shellcheck disable=SC2046
    reference "$(soft_volume "$1")" "$(soft_volume "$1")_soft" \
        $(soft_keys "$1") step=0.25 min_transmittance=0.000001 \
        size="$lab_size"
}

toft_run()
{
    toft_volume=${1%/*}
    volume "$(soft_volume "$toft_volume")" >/dev/null || return
    case ${1#*/} in
    brightness) toft_brightness ;;
    time) toft_time ;;
    *) toft_errors "${1#*/}" ;;
    esac
}

toft_errors() # RESOLUTION
{
    toft_fine=$(toft_reference "$toft_volume") || return
    for toft_method in $toft_methods; do
        # shellcheck disable=SC2046
        soft_sequence "$toft_volume" \
            $(sets $(toft_settings "$toft_volume" "$toft_method" "$1")) \
            --frames 0:31 --reference "fine=$toft_fine" \
            --column "scene=$toft_volume" --column "resolution=$1" \
            --column "method=$toft_method" >"$lab/rows/toft.$$" || return
        [ "$toft_method" = steps128 ] || sed -i 1d "$lab/rows/toft.$$"
        cat "$lab/rows/toft.$$"
    done
    rm -f "$lab/rows/toft.$$"
}

# `analytic` and `euler` are of the double renderer, `brume` of the core, and
# `jitter` of its mean over 64 frames.
toft_brightness()
{
    toft_fine=$(toft_reference "$toft_volume") || return
    toft_picture=$lab/rows/toft$$.pfm
    toft_base=$(soft_volume "$toft_volume")
    toft_head=
    for toft_length in $toft_steps; do
        for toft_method in analytic euler brume jitter; do
            toft_more=
            case $toft_method in
            analytic | euler)
                [ $toft_method = analytic ] || toft_more=--euler
                # shellcheck disable=SC2046,SC2086
                "$BUILD/brume-papers" "$(voxels "$toft_base")" --scene \
                    "lab/scenes/${toft_base}_soft.scene" $toft_more \
                    $(sets $(soft_keys "$toft_volume") size=$lab_size) \
                    --set "step=$toft_length" -o "$toft_picture" >/dev/null
                ;;
            brume)
                soft_sequence "$toft_volume" --set \
                    "step=$toft_length" --picture "$toft_picture"
                ;;
            jitter)
                soft_sequence "$toft_volume" --set \
                    "step=$toft_length" --set jitter=primary --set \
                    noise=rank1 --frames 0:63 --mean "$toft_picture"
                ;;
            esac || return
            "$BUILD/brume-lab" picture "$toft_picture" \
                --reference "fine=$toft_fine" --column "scene=$toft_volume" \
                --column "step=$toft_length" --column "method=$toft_method" |
                sed "$toft_head"
            toft_head=1d
        done
    done
    rm -f "$toft_picture"
}

toft_time()
{
    for toft_resolution in $toft_resolutions; do
        for toft_method in $toft_methods; do
            echo "$toft_method-$toft_resolution $(toft_settings \
                "$toft_volume" "$toft_method" "$toft_resolution" |
                tr '\n' ' ')"
        done
    done | soft_times "$toft_volume" |
        awk -F, -v OFS=, -v scene="$toft_volume" '
        NR == 1 { print "scene", "resolution", "method", $2, $3, $4, $5; next }
        {
            split($1, name, "-")
            print scene, name[2], name[1], $2, $3, $4, $5
        }
        END { exit NR < 2 }'
}

## Claims ##

# at SCENE RESOLUTION METHOD COLUMN [FRAME]
toft_at()
{
    value toft "$4" "scene=$1" "resolution=$2" "method=$3" "frame=${5:-31}" \
        reference=fine region=all
}

toft_mean() { value toft_brightness mean "scene=$1" "step=$2" "method=$3"; }

toft_check()
{
    for toft_volume in $soft_scenes; do
        for toft_resolution in $toft_resolutions; do
            toft_check_resolution "$toft_volume" "$toft_resolution"
        done
        claim "toft_analytic_$toft_volume" \
            "($(toft_mean "$toft_volume" 8 analytic))^2" \< \
            "(0.5 * ($(toft_mean "$toft_volume" 8 euler)))^2" \
            "$toft_volume, step 8: analytic below half of Euler's mean error"
        # Rounding and quantisation in the core are far below a step's error.
        claim "toft_core_$toft_volume" \
            "($(toft_mean "$toft_volume" 8 brume) -
                ($(toft_mean "$toft_volume" 8 analytic)))^2" \< 0.002^2 \
            "$toft_volume, step 8: the core is as bright as double, to 0.002"
    done
}

toft_check_resolution()
{
    # With fewer rays upsampling has its share, which no noise has: at full
    # resolution alone it must hold.
    toft_say=published
    [ "$2" != full ] || toft_say=claim
    $toft_say "toft_taa_$1_$2" "$(toft_at "$1" "$2" steps8_taa rmse)" \< \
        "0.5 * $(toft_at "$1" "$2" steps8 rmse)" \
        "$1, $2: 8 steps with jitter and TAA below half of 8 steps' RMSE"
    published "toft_similar_$1_$2" \
        "$(toft_at "$1" "$2" steps8_taa rmse)" \< \
        "2 * $(toft_at "$1" "$2" steps128 rmse)" \
        "$1, $2: 8 steps with TAA are within twice the RMSE of 128"
    published "toft_jitter_$1_$2" \
        "$(toft_at "$1" "$2" steps8_jitter rmse 0)" \< \
        "$(toft_at "$1" "$2" steps8 rmse 0)" \
        "$1, $2: one jittered frame below one that is not"
}

# One row a method: frame 0 and 31; and times where they were taken.
toft_derive()
{
    awk -F, -v OFS=, '
        FNR == 1 {
            for (i = 1; i <= NF; i++)
                at[$i] = i
            if (++files == 1)
                print "scene", "resolution", "method", "RMSE at 0", \
                    "RMSE at 31", "mean at 31", "speed"
            next
        }
        files == 1 { speed[$1, $2, $3] = $at["ratio"]; next }
        $at["frame"] == 0 { first = $at["rmse"] }
        $at["frame"] == 31 {
            print $1, $2, $3, first, $at["rmse"], $at["mean"], \
                speed[$1, $2, $3]
        }' "$(toft_times)" "$out/toft.csv" >"$out/toft_table.csv"
}

# A head alone where none were taken.
toft_times()
{
    [ -f "$out/toft_time.csv" ] ||
        echo "scene,resolution,method,ratio,ratio_least,ratio_most,ms" \
            >"$out/toft_time.csv"
    echo "$out/toft_time.csv"
}
