# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 5: Donnelly et al. 2024 (FAST), figures 5, 8 and 9. Four steps
# through the volume, jittered; spatial filter, average over time, spectra. Read
# by run.sh.

fast_filters="box5 gauss1"
# Of the paper: white, STBN, FAST of both kinds for this filter, and with a
# Gaussian over time in place of EMA. And what this project uses.
fast_noises="white stbn product separate gauss-time rank1 default"
# Those with pictures: of textures, so not rank1, which is a formula.
fast_spectra="white stbn product separate"
# Twice the frames of the averages below, so that none is in one twice.
fast_size=64x64x64
fast_last=63
[ -z "$QUICK" ] || fast_size=64x64x32 fast_last=31

fast_list()
{
    for fast_volume in disney cube; do
        for fast_filter in $fast_filters; do
            echo "$fast_volume/$fast_filter"
        done
        echo "$fast_volume/spectra"
    done
}

fast_table()
{
    case $1 in
    */spectra) echo fast_spectra ;;
    *) echo fast ;;
    esac
}

fast_noise_of() # NOISE FILTER
{
    case $1 in
    stbn) noise stbn $fast_size ;;
    product)
        noise fast $fast_size --filter "$2" --time ema:0.1,0.1 \
            --combine product
        ;;
    separate)
        noise fast $fast_size --filter "$2" --time ema:0.1,0.1 \
            --combine separate:1
        ;;
    gauss-time)
        noise fast $fast_size --filter "$2" --time gauss:1 --combine product
        ;;
    default) noise fast $fast_size ;;
    *) echo "$1" ;;
    esac
}

# Four steps from face to face.
fast_keys()
{
    echo jitter=primary
    case $1 in
    disney) echo step=38 ;;
    cube) echo step=24 ;;
    esac
}

fast_run()
{
    fast_volume=${1%/*} fast_filter=${1#*/}
    volume "$fast_volume" >/dev/null || return
    if [ "$fast_filter" = spectra ]; then
        fast_run_spectra
        return
    fi
    # shellcheck disable=SC2046
    fast_limit=$(mean_picture "$fast_volume" "${fast_volume}_soft" 512 \
        $(fast_keys "$fast_volume") "spatial=$fast_filter") || return
    fast_fine=$(toft_reference "$fast_volume") || return
    fast_head=
    for fast_noise in $fast_noises; do
        fast_texture=$(fast_noise_of "$fast_noise" "$fast_filter") || return
        for fast_average in ema mean; do
            case $fast_average in
            ema) fast_more="--set temporal=ema --set alpha=0.1" ;;
            mean) fast_more=--cumulative ;;
            esac
            # shellcheck disable=SC2046,SC2086
            sequence "$fast_volume" "${fast_volume}_soft" \
                $(sets $(fast_keys "$fast_volume")) --set \
                "noise=$fast_texture" --set "spatial=$fast_filter" \
                $fast_more --frames 0:$fast_last \
                --reference "limit=$fast_limit" \
                --reference "fine=$fast_fine" \
                --column "scene=$fast_volume" --column "filter=$fast_filter" \
                --column "average=$fast_average" \
                --column "noise=$fast_noise" >"$lab/rows/fast.$$" || return
            sed "$fast_head" "$lab/rows/fast.$$"
            fast_head=1d
        done
    done
    rm -f "$lab/rows/fast.$$"
}

# Of the error of single frames and of those under EMA, unfiltered, to the
# method's own limit; textures for box5. In a part that is all cloud.
fast_run_spectra()
{
    # shellcheck disable=SC2046
    fast_limit=$(mean_picture "$fast_volume" "${fast_volume}_soft" 512 \
        $(fast_keys "$fast_volume") spatial=none) || return
    mkdir -p "$lab/spectra"
    fast_head=
    for fast_noise in $fast_spectra rank1; do
        fast_texture=$(fast_noise_of "$fast_noise" box5) || return
        for fast_average in frame ema; do
            fast_base=$lab/spectra/fast_${fast_volume}_${fast_noise}
            fast_base=${fast_base}_$fast_average
            fast_from=0
            [ $fast_average = frame ] || fast_from=24
            fast_how=none
            [ $fast_average = frame ] || fast_how=ema
            # shellcheck disable=SC2046
            sequence "$fast_volume" "${fast_volume}_soft" \
                $(sets $(fast_keys "$fast_volume")) --set \
                "noise=$fast_texture" --set temporal=$fast_how \
                --frames 0:$fast_last --from $fast_from \
                --region middle=0.33,0.33,0.27,0.48 \
                --reference "limit=$fast_limit" --spectrum "$fast_base" \
                --column "scene=$fast_volume" \
                --column "average=$fast_average" \
                --column "noise=$fast_noise" >/dev/null || return
            sed "$fast_head" "$fast_base.csv"
            fast_head=1d
        done
        [ "$fast_noise" = rank1 ] || fast_draw "$fast_noise" "$fast_texture" ||
            return
    done
}

# The texture's own.
fast_draw()
{
    fast_picture=$lab/spectra/fast_noise_$1.png
    if [ "$1" = white ]; then
        "$BUILD/brume-noise" white --size $fast_size --spectrum "$fast_picture"
    else
        "$BUILD/brume-noise" measure "$2" --size $fast_size \
            --spectrum "$fast_picture"
    fi >/dev/null
}

## Claims ##

# at SCENE FILTER AVERAGE NOISE FRAME
fast_at()
{
    value fast rmse "scene=$1" "filter=$2" "average=$3" "noise=$4" \
        "frame=$5" reference=limit
}

# Mean power below an eighth of a cycle per pixel, relative to white's.
fast_low() # SCENE AVERAGE NOISE
{
    value fast_low power "scene=$1" "average=$2" "noise=$3"
}

fast_check()
{
    for fast_volume in disney cube; do
        for fast_filter in $fast_filters; do
            fast_check_filter "$fast_volume" "$fast_filter"
        done
        # Of textures for box5: blue in space, in each frame.
        for fast_noise in product separate; do
            claim "fast_blue_${fast_noise}_$fast_volume" \
                "$(fast_low "$fast_volume" frame $fast_noise)" \< 0.5 \
                "$fast_volume, $fast_noise: half of white's low frequencies"
        done
    done
}

fast_check_filter()
{
    for fast_noise in white stbn separate gauss-time; do
        published "fast_product_${fast_noise}_$1_$2" \
            "$(fast_at "$1" "$2" ema product 0)" \< \
            "$(fast_at "$1" "$2" ema $fast_noise 0)" \
            "$1, $2, frame 0: product below $fast_noise"
        published "fast_late_${fast_noise}_$1_$2" \
            "$(fast_at "$1" "$2" ema product $fast_last)" \< \
            "$(fast_at "$1" "$2" ema $fast_noise $fast_last)" \
            "$1, $2, EMA at the end: product below $fast_noise"
    done
    claim "fast_frame_$1_$2" "$(fast_at "$1" "$2" ema product 0)" \< \
        "0.75 * $(fast_at "$1" "$2" ema white 0)" \
        "$1, $2: one frame of matched noise below 3/4 of white"
    # EMA 0.1 is worth (2 - 0.1) / 0.1 = 19 independent frames, less what its
    # first one weighs; the mean of 16 and of 32 are on either side.
    claim "fast_19_most_$1_$2" "$(fast_at "$1" "$2" mean white 31)" \< \
        "$(fast_at "$1" "$2" ema white 31)" \
        "$1, $2, white: the mean of 32 frames below EMA 0.1"
    claim "fast_19_least_$1_$2" "$(fast_at "$1" "$2" ema white 31)" \< \
        "$(fast_at "$1" "$2" mean white 13)" \
        "$1, $2, white: EMA 0.1 below the mean of 14"
}

fast_derive()
{
    cp "$lab"/spectra/fast_noise_*.png "$lab"/spectra/fast_*_frame.png \
        "$lab"/spectra/fast_*_ema.png "$out/" 2>/dev/null || :
    awk -F, -v OFS=, -v last=$fast_last '
        NR == 1 {
            for (i = 1; i <= NF; i++)
                at[$i] = i
            print "scene", "filter", "average", "noise", "frame 0", "3", "7", \
                "15", "31", "last"
            next
        }
        $at["reference"] != "limit" || \
            $at["frame"] !~ ("^(0|3|7|15|31|" last ")$") { next }
        { row = row OFS $at["rmse"] }
        $at["frame"] == last {
            print $1, $2, $3, $4 row (last == 31 ? OFS $at["rmse"] : "")
            row = ""
        }' "$out/fast.csv" >"$out/fast_table.csv"
    # Bands hold as many frequencies as their distance from zero is large.
    awk -F, -v OFS=, '
        NR == 1 { print "scene", "average", "noise", "power"; next }
        $4 < 0.125 {
            row = $1 OFS $2 OFS $3
            if (!(row in sum))
                order[++n] = row
            sum[row] += $5 * $4
        }
        END {
            for (i = 1; i <= n; i++) {
                split(order[i], k, OFS)
                print order[i], sum[order[i]] / sum[k[1] OFS k[2] OFS "white"]
            }
        }' "$out/fast_spectra.csv" >"$out/fast_low.csv"
    awk -F, -v OFS=, '
        NR == 1 { print "scene", "average", "noise", "frequency", "relative"
            next }
        { if ($3 == "white") white[$1, $2, $4] = $5
          print $1, $2, $3, $4, $5 / white[$1, $2, $4] }' \
        "$out/fast_spectra.csv" >"$out/fast_relative.csv"
}
