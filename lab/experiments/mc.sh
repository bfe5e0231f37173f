# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# How wrong single scattering, octaves, cones and caches are: each against an
# unbiased path tracer, of one scattering and of all. Read by run.sh.

# `double` is the double-precision truth itself, `fine` the same with a sample
# to the sun each half of a voxel; `noise` what is left of the path tracer's
# own, as RMSE of its standard errors.
mc_methods="double fine exact log cone cache2 cache4 cache8 octaves2 octaves8
    noise"
mc_size=240x135
mc_one_passes=1024 mc_all_passes=512
[ -z "$QUICK" ] || mc_one_passes=128 mc_all_passes=32

mc_list()
{
    for mc_volume in disney cube; do
        for mc_method in $mc_methods; do
            echo "$mc_volume/$mc_method"
        done
    done
}

mc_settings()
{
    case $1 in
    exact) ;;
    log) echo light=log light_samples=10 light_step=1 ;;
    cone) echo light=cone light_samples=10 light_step=1 ;;
    cache?) echo light=cache "cache_spacing=${1#cache}" ;;
    # For albedo 1 by docs/octaves.md; and the default.
    octaves2) echo octaves=2 octave_a=0.20 octave_b=0.96 ;;
    octaves8) echo octaves=8 octave_a=0.5 octave_b=0.5 ;;
    esac
}

# The path tracer's pictures, of one scattering and of all.
mc_one()
{
    monte_carlo "$1" "$1_scatter" 1 "$mc_one_passes" size=$mc_size
}

mc_all()
{
    monte_carlo "$1" "$1_scatter" 0 "$mc_all_passes" size=$mc_size
}

mc_black()
{
    "$BUILD/brume-lab" sequence "$1" --set size=$mc_size --set background=0 \
        --set albedo=0 --mean "$2"
}

mc_run()
{
    mc_volume=${1%/*} mc_method=${1#*/}
    mc_brume=$(volume "$mc_volume") || return
    mc_ref1=$(mc_one "$mc_volume") || return
    mc_ref0=$(mc_all "$mc_volume") || return
    set -- --column "volume=$mc_volume" --column "method=$mc_method"
    case $mc_method in
    noise)
        mc_dark=$lab/references/black_$mc_size.pfm
        once "$mc_dark" mc_black "$mc_brume" || return
        {
            "$BUILD/brume-lab" picture "$mc_ref1.error.pfm" "$@" \
                --reference "one=$mc_dark"
            "$BUILD/brume-lab" picture "$mc_ref0.error.pfm" "$@" \
                --reference "all=$mc_dark" | sed 1d
        }
        ;;
    double | fine)
        mc_light=
        [ "$mc_method" = double ] ||
            mc_light="light_step=0.5 light_samples=1280"
        # shellcheck disable=SC2086
        mc_truth=$(reference "$mc_volume" "${mc_volume}_scatter" $lab_truth \
            $mc_light size=$mc_size) || return
        "$BUILD/brume-lab" picture "$mc_truth" "$@" \
            --reference "one=$mc_ref1" --reference "all=$mc_ref0"
        ;;
    *)
        # shellcheck disable=SC2046
        sequence "$mc_volume" "${mc_volume}_scatter" \
            $(sets $(mc_settings "$mc_method") size=$mc_size) "$@" \
            --reference "one=$mc_ref1" --reference "all=$mc_ref0"
        ;;
    esac
}

## Claims ##

# One row a method: mean error, and RMSE less the reference's own noise, which
# is independent of it; on the scale of the
# pictures, whose exposure is a quarter.
mc_derive()
{
    echo "mc_size,$mc_size" >>"$out/settings.csv"
    awk -F, -v OFS=, '
        NR == 1 { print "volume", "method", "reference", "rmse", "mean"; next }
        { rmse[$1, $2, $4] = $6; mean[$1, $2, $4] = $7 }
        $2 != "noise" { row[++n] = $1 OFS $2 OFS $4 }
        END {
            for (i = 1; i <= n; i++) {
                split(row[i], k, OFS)
                left = rmse[k[1], k[2], k[3]] ^ 2 - \
                    rmse[k[1], "noise", k[3]] ^ 2
                left = left > 0 ? sqrt(left) : 0
                print row[i], left, mean[k[1], k[2], k[3]]
            }
        }' "$out/mc.csv" >"$out/mc_table.csv"
}

mc_at() { value mc_table "$2" "volume=$1" "method=$3" "reference=$4"; }

mc_raw() { value mc rmse "volume=$1" "method=$2" reference=one; }

mc_check()
{
    for mc_volume in disney cube; do
        for mc_method in cone cache2 cache4; do
            claim "mc_${mc_method}_$mc_volume" \
                "$(mc_at $mc_volume rmse $mc_method one)" \< \
                "$(mc_at $mc_volume rmse log one)" \
                "$mc_volume, one scattering: $mc_method below log"
        done
        for mc_method in octaves2 octaves8; do
            claim "mc_${mc_method}_$mc_volume" \
                "$(mc_at $mc_volume rmse $mc_method all)" \< \
                "$(mc_at $mc_volume rmse exact all)" \
                "$mc_volume, all scatterings: $mc_method below single"
        done
        # Both estimate the same integral: what is left is the tracer's noise.
        claim "mc_fine_$mc_volume" \
            "($(mc_raw $mc_volume fine) / $(mc_raw $mc_volume noise) - 1)^2" \
            \< 0.03^2 \
            "$mc_volume: a sample each half voxel is within the tracer's noise"
        claim "mc_double_$mc_volume" \
            "($(mc_at $mc_volume mean double one))^2" \< 0.001^2 \
            "$mc_volume, one scattering: mean error of double below 0.001"
    done
}
