# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Experiment 6: Ford 2024. What each optimisation of a ladder brings and costs.
# Read by run.sh.

ford_volumes="disney smoke"
# In Ford's order. `leap` is this project's in the place of `adaptive`: over
# empty bricks, by whole steps of the lattice.
ford_core="nothing exit skip window leap half quarter"
# What the core does not do: light for empty samples, and steps that adapt.
ford_double="all-lit nothing exit skip adaptive"

ford_list()
{
    for ford_volume in $ford_volumes; do
        echo "$ford_volume/core"
        echo "$ford_volume/double"
        # NanoVDB is not built for the reduced laboratory.
        [ -n "$QUICK" ] || echo "$ford_volume/lookups"
        [ -n "$QUICK" ] || echo "$ford_volume/time timed"
    done
}

ford_table()
{
    echo "ford_${1#*/}"
}

ford_scene_of()
{
    case $1 in
    disney) echo disney_soft ;;
    smoke) echo smoke_soft ;;
    esac
}

# Steps of a voxel, and of 11 with history: 9 and 100 metres there. Eight
# octaves as there, of which all together are twice as bright as one: exposure
# keeps them below white.
ford_settings() # RUNG
{
    case $1 in
    nothing | all-lit) ford_keys="min_transmittance=0 min_density=0" ;;
    exit) ford_keys="min_transmittance=0.075 min_density=0" ;;
    *) ford_keys="min_transmittance=0.075 min_density=0.01" ;;
    esac
    ford_keys="$ford_keys octaves=8 exposure=0.25"
    case $1 in
    window | leap | half | quarter)
        ford_keys="$ford_keys step=11 jitter=primary noise=rank1
            temporal=window window=8 subpixel=off"
        ;;
    *) ford_keys="$ford_keys step=1 jitter=none" ;;
    esac
    case $1 in
    half | quarter) ford_keys="$ford_keys resolution=$1" ;;
    # The double renderer knows no skipping, the core no adaptive step: of it,
    # `adaptive` is leaping with small steps.
    all-lit | adaptive | leap) ;;
    *) ford_keys="$ford_keys ${2:-skip=off}" ;;
    esac
    one_line "$ford_keys"
}

ford_reference()
{
    reference "$1" "$(ford_scene_of "$1")" octaves=8 exposure=0.25 step=0.25 \
        min_transmittance=0.000001 size="$lab_size"
}

ford_run()
{
    ford_volume=${1%/*}
    ford_scene=$(ford_scene_of "$ford_volume")
    volume "$ford_volume" >/dev/null || return
    "ford_run_${1#*/}"
}

ford_run_core()
{
    ford_fine=$(ford_reference "$ford_volume") || return
    ford_head=
    for ford_rung in $ford_core; do
        # shellcheck disable=SC2046
        sequence "$ford_volume" "$ford_scene" \
            $(sets $(ford_settings "$ford_rung")) --frames 0:31 \
            --from 31 --reference "fine=$ford_fine" --column \
            "scene=$ford_volume" --column "rung=$ford_rung" \
            >"$lab/rows/ford.$$" || return
        sed "$ford_head" "$lab/rows/ford.$$"
        ford_head=1d
    done
    rm -f "$lab/rows/ford.$$"
}

# At equal settings the first rungs are the core's: a check of either.
ford_run_double()
{
    ford_fine=$(ford_reference "$ford_volume") || return
    ford_picture=$lab/rows/ford$$.pfm
    ford_head=
    for ford_rung in $ford_double; do
        ford_more=
        case $ford_rung in
        adaptive | all-lit) ford_more=--$ford_rung ;;
        esac
        # shellcheck disable=SC2046,SC2086
        ford_counts=$("$BUILD/brume-papers" "$(voxels "$ford_volume")" \
            --scene "lab/scenes/$ford_scene.scene" $ford_more \
            $(sets $(ford_settings "$ford_rung" light_samples=6)) \
            --set size=$lab_size -o "$ford_picture") || return
        # shellcheck disable=SC2086
        set -- $ford_counts
        "$BUILD/brume-lab" picture "$ford_picture" \
            --reference "fine=$ford_fine" --column "scene=$ford_volume" \
            --column "rung=$ford_rung" --column "$1" --column "$2" |
            sed "$ford_head"
        ford_head=1d
    done
    rm -f "$ford_picture"
}

# Densities looked up in a frame, per pixel: after leaping, and of these not in
# an empty cell. Of whole frames: half and quarter have a 4th and a 16th.
ford_run_lookups()
{
    ford_asset=$(volume "$ford_volume")
    ford_keys=$(scene_pairs "$ford_scene")
    for ford_rung in nothing exit skip adaptive window leap; do
        # shellcheck disable=SC2046
        echo "name=$ford_rung render=scalar asset=$ford_asset $ford_keys" \
            "size=$lab_size" "$(march_keys $(ford_settings "$ford_rung"))"
    done | "$BUILD/brume-bench" 1 | awk -F, -v OFS=, -v scene="$ford_volume" \
        -v size="$lab_size" '
        NR == 1 {
            split(size, sides, "x")
            n = sides[1] * sides[2]
            for (i = 1; i <= NF; i++)
                at[$i] = i
            print "scene", "rung", "view", "light", "in_bricks"
            next
        }
        {
            name = $1 == "adaptive" ? "leap-small" : $1
            print scene, name, $at["view"] / n, $at["light"] / n, \
                $at["in_bricks"] / n
        }
        END { exit NR < 2 }'
}

ford_run_time()
{
    for ford_rung in $ford_core; do
        echo "$ford_rung $(ford_settings "$ford_rung")"
    done | frame_times "$ford_volume" "$ford_scene" 3 |
        awk -F, -v OFS=, -v scene="$ford_volume" '
        NR == 1 { print "scene", "rung", $2, $3, $4, $5; next }
        { print scene, $1, $2, $3, $4, $5 }
        END { exit NR < 2 }'
}

## Claims ##

ford_at() { value ford_core rmse "scene=$1" "rung=$2" frame=31; }

ford_double_at() { value ford_double "$3" "scene=$1" "rung=$2"; }

ford_check()
{
    for ford_volume in $ford_volumes; do
        ford_check_volume "$ford_volume"
    done
}

ford_check_volume()
{
    # Skipping is invisible; early exit cuts what its threshold says at most.
    claim "ford_leap_$1" "($(ford_at "$1" leap) - ($(ford_at "$1" window)))^2" \
        == 0 "$1: leaping over empty bricks changes nothing"
    # Of a light of at most 2, the sum of octaves, times the exposure.
    claim "ford_exit_$1" \
        "($(value ford_core mean "scene=$1" rung=exit frame=31) -
            ($(value ford_core mean "scene=$1" rung=nothing frame=31)))^2" \
        \< "(0.5 * 0.075)^2" "$1: early exit costs less than half its threshold"
    published "ford_window_$1" "$(ford_at "$1" window)" \< \
        "3 * $(ford_at "$1" skip)" \
        "$1: steps 11 times as long, 8 frames: below 3 times the RMSE"
    # Of lookups along the ray; a sample of the lattice that it leaves out is
    # empty, unless something is thinner than two steps.
    published "ford_adaptive_$1" "$(ford_double_at "$1" adaptive view)" \< \
        "0.75 * $(ford_double_at "$1" skip view)" \
        "$1: adaptive steps save a quarter of the samples"
    claim "ford_all_lit_$1" "$(ford_double_at "$1" all-lit light)" \> \
        "2 * $(ford_double_at "$1" nothing light)" \
        "$1: most light is looked up for samples without density"
}

# Rows of Ford's ladder, in order: core's errors and lookups, and the double
# renderer's where the core has no such rung.
ford_derive()
{
    # Both volumes are real ones, which may not be there.
    [ -f "$out/ford_core.csv" ] || return 0
    for ford_table in ford_time ford_lookups; do
        [ -f "$out/$ford_table.csv" ] ||
            echo "scene,rung,ratio,view,light" >"$out/$ford_table.csv"
    done
    awk -F, -v OFS=, '
        FNR == 1 {
            files++
            for (i = 1; i <= NF; i++)
                at[$i] = i
            next
        }
        files == 1 { speed[$1, $2] = $at["ratio"]; next }
        files == 2 {
            view[$1, $2] = $at["view"]
            light[$1, $2] = $at["light"]
            next
        }
        {
            kind = files == 3 ? "double" : "core"
            row[$1, $2, kind] = $at["rmse"] OFS $at["mean"]
            if (files == 3) {
                view[$1, $2, kind] = $at["view"]
                light[$1, $2, kind] = $at["light"]
            }
            scene[$1]
        }
        END {
            print "scene", "rung", "renderer", "view", "light", "rmse", \
                "mean", "speed"
            n = split("all-lit/double nothing/core exit/core skip/core " \
                "adaptive/double window/core leap/core half/core " \
                "quarter/core", rungs, " ")
            for (s in scene)
                for (i = 1; i <= n; i++) {
                    split(rungs[i], k, "/")
                    at_view = k[2] == "core" ? view[s, k[1]] : \
                        view[s, k[1], k[2]]
                    at_light = k[2] == "core" ? light[s, k[1]] : \
                        light[s, k[1], k[2]]
                    print s, k[1], k[2], at_view, at_light, \
                        row[s, k[1], k[2]], \
                        k[2] == "core" ? speed[s, k[1]] : ""
                }
        }' "$out/ford_time.csv" "$out/ford_lookups.csv" \
        "$out/ford_double.csv" "$out/ford_core.csv" |
        LC_ALL=C sort -s -t, -k 1,1 |
        awk -F, '/^scene,/ { print; next } { rest[++n] = $0 }
            END { for (i = 1; i <= n; i++) print rest[i] }' \
            >"$out/ford_table.csv"
}
