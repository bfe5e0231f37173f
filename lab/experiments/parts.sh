# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# The error split into its parts: the truth with one thing changed, so that what
# is left is that thing's. Volumes, scenes and kinds of light are the front's
# (front.sh). Read by run.sh.

parts_size=160x90 parts_frames=512
parts_volumes="disney smoke cumulus block"
[ -z "$QUICK" ] || parts_size=64x36 parts_frames=32 parts_volumes=block

# Values of each part. In double but for three: of `cache4` the double renderer
# has the exact depth only, so that is the core's; noise is the core's, against
# the mean of its own method; and arithmetic is the core against the double
# renderer of the very same voxels, samples and noise.
parts_of()
{
    case $1 in
    quantisation) echo u8 u8r u4r ;;
    step) echo 1 2 4 8 ;;
    light) echo log6 log10 cone10 cache4 uni16 uni64 ;;
    filter) echo nearest ;;
    exit) echo 0.01 0.05 ;;
    noise) echo 2-fast 2-rank1 8-fast 8-rank1 ;;
    arithmetic) echo nearest trilinear ;;
    all) echo near tri ;;
    esac
}

parts_list()
{
    for parts_volume in $parts_volumes; do
        for parts_part in quantisation step light filter exit noise arithmetic \
            all; do
            echo "$parts_volume/$parts_part"
        done
    done
}

# The smoke's range of densities is more than one scale of 8 bits holds.
parts_own()
{
    case $1 in
    smoke) echo u8r ;;
    *) echo u8 ;;
    esac
}

# parts_decoded VOLUME FORMAT: the voxels that the asset holds, as read by the
# tests' own reader.
parts_decoded()
{
    parts_asset=$(volume "front-$1-$2") || return
    once "$(dirname "$parts_asset")/decoded.float" "$BUILD/brume-spec-dump" \
        "$parts_asset" -o && echo "$(dirname "$parts_asset")/decoded.float"
}

# parts_double VOXELS VOLUME KEY=VALUE...: as lib.sh's reference, of any voxels.
parts_double()
{
    parts_voxels=$1 parts_scene=lab/scenes/front_$2.scene
    shift 2
    parts_at=$lab/references/$({
        echo "$reference_hash $*"
        cat "$parts_scene" "$parts_voxels"
    } | hash_of).pfm
    # shellcheck disable=SC2046
    once "$parts_at" "$BUILD/brume-reference" "$parts_voxels" \
        --scene "$parts_scene" $(sets "$@") --threads 1 -o && echo "$parts_at"
}

# parts_picture VALUE PICTURE TRUTH: its row.
parts_picture()
{
    "$BUILD/brume-lab" picture "$2" --flip --column "volume=$parts_volume" \
        --column "part=$parts_part" --column "value=$1" --reference "truth=$3"
}

# parts_core VALUE TRUTH FORMAT KEY=VALUE...: the core's row, of the frames in
# $parts_arguments.
parts_core()
{
    parts_value=$1 parts_truth=$2 parts_format=$3
    shift 3
    # shellcheck disable=SC2046,SC2086
    sequence "front-$parts_volume-$parts_format" "front_$parts_volume" \
        $(sets "$@") --flip $parts_arguments \
        --column "volume=$parts_volume" --column "part=$parts_part" \
        --column "value=$parts_value" --reference "truth=$parts_truth"
}

# What noise alone leaves, over time: RMSE to the mean of the method.
parts_noise() # STEP-NOISE
{
    parts_march="jitter=both filter=nearest $(front_light cone10)
        step=${1%-*} min_transmittance=0.01"
    # shellcheck disable=SC2086
    parts_limit=$(mean_picture "front-$parts_volume-$parts_format" \
        "front_$parts_volume" $parts_frames $parts_march) || return
    for parts_frame in 0 3 31; do
        parts_arguments="--frames 0:$parts_frame --only $parts_frame"
        # shellcheck disable=SC2086
        parts_core "$1-$parts_frame" "$parts_limit" "$parts_format" \
            $parts_march "noise=${1#*-}" temporal=ema || return
    done
}

parts_arithmetic() # FILTER
{
    parts_march="jitter=both noise=ign filter=$1 step=2 $(front_light log10)
        min_transmittance=0.01"
    # shellcheck disable=SC2086
    parts_same=$(parts_double \
        "$(parts_decoded "$parts_volume" "$parts_format")" "$parts_volume" \
        $parts_march min_density=0 frame=0 size=$parts_size) || return
    # shellcheck disable=SC2086
    parts_core "$1" "$parts_same" "$parts_format" $parts_march
}

# Everything at once: the settings that the parts are of, over time.
parts_all() # LOOKUP
{
    for parts_frame in 0 3 31; do
        parts_arguments="--frames 0:$parts_frame --only $parts_frame"
        # shellcheck disable=SC2046
        parts_core "$1-$parts_frame" "$parts_reference" "$parts_format" \
            $(front_sets "$parts_format-$1-cone10-2-fast-ema-none-full") ||
            return
    done
}

# shellcheck disable=SC2046
parts_light() { parts_changed "$1" $(front_light "$1"); }

# The truth with other settings behind its own, which win.
# shellcheck disable=SC2086
parts_changed() # VALUE KEY=VALUE...
{
    parts_value=$1
    shift
    parts_other=$(reference "front-$parts_volume-$parts_format" \
        "front_$parts_volume" $lab_truth size=$parts_size "$@") || return
    parts_picture "$parts_value" "$parts_other" "$parts_reference"
}

parts_one() # VALUE
{
    parts_arguments=
    case $parts_part/$1 in
    quantisation/*)
        # shellcheck disable=SC2086
        parts_other=$(parts_double "$(parts_decoded "$parts_volume" "$1")" \
            "$parts_volume" $lab_truth size=$parts_size) || return
        parts_picture "$1" "$parts_other" "$parts_reference"
        ;;
    light/cache4)
        # shellcheck disable=SC2086
        parts_core cache4 "$parts_reference" "$parts_format" $lab_truth \
            light=cache
        ;;
    light/*) parts_light "$1" ;;
    step/*) parts_changed "$1" "step=$1" ;;
    filter/*) parts_changed "$1" "filter=$1" ;;
    exit/*) parts_changed "$1" "min_transmittance=$1" ;;
    *) "parts_$parts_part" "$1" ;;
    esac
}

parts_run()
{
    # shellcheck disable=SC2034
    lab_size=$parts_size
    parts_volume=${1%/*} parts_part=${1#*/}
    parts_format=$(parts_own "$parts_volume")
    # shellcheck disable=SC2086
    parts_reference=$(reference "front-$parts_volume-$parts_format" \
        "front_$parts_volume" $lab_truth size=$parts_size) || return
    parts_rows=$(for parts_each in $(parts_of "$parts_part"); do
        parts_one "$parts_each" || exit
    done) || return
    echo "$parts_rows" | awk 'NR == 1 { head = $0; print } $0 != head'
}

## Claims ##

parts_at() # VOLUME PART VALUE [COLUMN]
{
    value parts "${4:-rmse}" "volume=$1" "part=$2" "value=$3"
}

# What the settings of `all near` are made of, if parts added up as independent
# errors do: to the square.
parts_derive()
{
    for parts_volume in $parts_volumes; do
        parts_own "$parts_volume" | sed "s/^/$parts_volume /"
    done | awk -v OFS=, -v file="$out/parts.csv" '
        BEGIN {
            while ((getline line <file) > 0) {
                split(line, c, ",")
                rmse[c[1], c[2], c[3]] = c[7]
            }
            print "volume", "quantisation", "step", "light", "filter", \
                "exit", "noise", "arithmetic", "sum", "without step", \
                "measured"
        }
        {
            n = split("quantisation/" $2 " step/2 light/cone10 " \
                "filter/nearest exit/0.01 noise/2-fast-31 " \
                "arithmetic/nearest", part, " ")
            row = $1
            sum = 0
            for (i = 1; i <= n; i++) {
                split(part[i], p, "/")
                row = row OFS rmse[$1, p[1], p[2]]
                sum += rmse[$1, p[1], p[2]] ^ 2
            }
            print row, sqrt(sum), sqrt(sum - rmse[$1, "step", 2] ^ 2), \
                rmse[$1, "all", "near-31"]
        }' >"$out/parts_sum.csv"
    cut -d, -f 1-3,7,8,14 "$out/parts.csv" >"$out/parts_table.csv"
    # Of the page: a row for each part, a column for each volume.
    awk -F, -v OFS=, -v volumes="$parts_volumes" '
        { rmse[$1, $2 " " $3] = $4 }
        NR > 1 && !seen[$2, $3]++ { row[++n] = $2 " " $3 }
        END {
            v = split(volumes, volume, " ")
            line = "RMSE"
            for (k = 1; k <= v; k++)
                line = line OFS volume[k]
            print line
            for (i = 1; i <= n; i++) {
                line = row[i]
                for (k = 1; k <= v; k++)
                    line = line OFS rmse[volume[k], row[i]]
                print line
            }
        }' "$out/parts_table.csv" >"$out/parts_page.csv"
    # Of the chart: where a bar stands, a gap between parts.
    awk -F, -v OFS=, '
        NR == 1 { print "volume", "at", "part", "label", "rmse"; next }
        $1 != volume { at = 0 }
        $1 == volume && $2 != part { at++ }
        { volume = $1; part = $2; print $1, ++at, $2, $2 " " $3, $4 }
    ' "$out/parts_table.csv" >"$out/parts_chart.csv"
    {
        echo "parts_size,$parts_size"
        echo "parts_frames,$parts_frames"
    } >>"$out/settings.csv"
}

parts_check()
{
    for parts_volume in $parts_volumes; do
        # Rounding to 8 bits errs by up to 1/2 of 1/255, and by 1/sqrt(12) of
        # it in the mean square.
        claim "parts_arithmetic_trilinear_$parts_volume" \
            "$(parts_at "$parts_volume" arithmetic trilinear)" \
            \< "1 / 255 / sqrt(12)" \
            "$parts_volume, trilinear: integers err by less than codes of 8 \
bits do"
        # Nearest, a sample within 2^-16 of a voxel's face may read the next
        # one, in a picture of single samples.
        claim "parts_arithmetic_nearest_$parts_volume" \
            "$(parts_at "$parts_volume" arithmetic nearest)" \< \
            "0.25 * $(parts_at "$parts_volume" filter nearest)" \
            "$parts_volume, nearest: by less than a quarter of what nearest \
lookups do"
        claim "parts_light_$parts_volume" \
            "$(parts_at "$parts_volume" light cone10)" \< \
            "$(parts_at "$parts_volume" light log10)" \
            "$parts_volume: ten cones err less than ten doubling samples"
        claim "parts_noise_$parts_volume" \
            "$(parts_at "$parts_volume" noise 2-fast-31)" \< \
            "0.5 * $(parts_at "$parts_volume" noise 2-fast-0)" \
            "$parts_volume: EMA leaves less than half of the noise"
        claim "parts_exit_$parts_volume" \
            "$(parts_at "$parts_volume" exit 0.01)" \< 0.005 \
            "$parts_volume: early exit at 0.01 errs by less than 0.005"
    done
    [ -n "$QUICK" ] || claim parts_smoke_range \
        "$(parts_at smoke quantisation u8r)" \< \
        "0.5 * $(parts_at smoke quantisation u8)" \
        "smoke: a range per brick errs by less than half of one scale"
}
