# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# `. lab/lib.sh`: what experiments are written with. Read by run.sh, which sets
# $lab, the folder of this laboratory in $BUILD, and $out, where tables go.
#
# Everything that is made once and used by many units (volumes, noises,
# references) is kept under a hash of what it is made of, and made under a lock:
# a unit that needs what another one is making waits for it.

# Pixels of pictures; fewer for `lab-quick`.
lab_size=480x270
[ -z "$QUICK" ] || lab_size=240x135

# The truth: 256 uniform samples of 2.5 voxels to the sun, a sample of the view
# ray each quarter of a voxel. A ray ends where less than a millionth of the
# light behind it is let through, which is the most that this can cost a pixel
# of a white sun.
# shellcheck disable=SC2034
lab_truth="step=0.25 light=uniform light_samples=256 light_step=2.5
    filter=trilinear min_density=0 min_transmittance=0.000001 jitter=none"

hash_of() { sha256sum | cut -c 1-32; }

# once FILE COMMAND...: makes FILE unless it is there; the command gets its
# temporary name, with the same extension, as its last argument.
once()
{
    once_file=$1
    shift
    [ ! -f "$once_file" ] || return 0
    mkdir -p "$(dirname "$once_file")"
    once_new=$(dirname "$once_file")/new$$.$(basename "$once_file")
    (
        if command -v flock >/dev/null; then
            flock 9
        fi
        [ ! -f "$once_file" ] || exit 0
        if "$@" "$once_new" >"$once_new.log" 2>&1; then
            mv "$once_new" "$once_file"
            rm -f "$once_new.log"
        else
            cat "$once_new.log" >&2
            rm -f "$once_new" "$once_new.log"
            exit 1
        fi
    ) 9>"$once_file.lock"
}

## Volumes ##

bake_from() # FILE FORMAT OUT.brume
{
    "$BUILD/brume-bake" "$1" --format "$2" --mips -o "$3" \
        --dump-float "$(dirname "$3")/voxels.float"
}

bake_cloud() # TYPE SIZE FORMAT OUT.brume
{
    made_vdb=$(dirname "$4")/made.vdb
    "$BUILD/brume-cloud" --type "$1" --size "$2" -o "$made_vdb" &&
        bake_from "$made_vdb" "$3" "$4"
}

# volume NAME: the baked file's path on stdout; voxels.float is beside it.
# Returns 3, for the unit to pass on, when the real volume is not there.
volume()
{
    case $1 in
    disney) volume_how="bake_from $DATA/wdas_cloud_sixteenth.vdb u8" ;;
    smoke) volume_how="bake_from $DATA/openvdb_smoke1.vdb u8r" ;;
    cumulus) volume_how="bake_cloud cumulus 256 u8" ;;
    cube) volume_how="bake_cloud block 96 u8" ;;
    front-*) volume_how=$(front_how "$1") || return ;;
    *)
        echo "lab: there is no volume '$1'" >&2
        return 1
        ;;
    esac
    # shellcheck disable=SC2086
    set -- "$1" $volume_how
    if [ "$2" = bake_from ] && [ ! -f "$3" ]; then
        return 3
    fi
    volume_at=$lab/volumes/$1.$(echo "$made_hash $*" | hash_of)/$1.brume
    if [ ! -f "$volume_at" ]; then
        mkdir -p "$(dirname "$volume_at")"
        shift
        once "$volume_at" "$@" || return 1
    fi
    echo "$volume_at"
}

# voxels NAME: the same, of the voxels for the references.
voxels()
{
    volume "$1" >/dev/null || return
    echo "$(dirname "$(volume "$1")")/voxels.float"
}

# vdb NAME: and the file that it was baked from, for peers.
vdb()
{
    case $1 in
    disney | front-disney-*) echo "$DATA/wdas_cloud_sixteenth.vdb" ;;
    smoke | front-smoke-*) echo "$DATA/openvdb_smoke1.vdb" ;;
    *) echo "$(dirname "$(volume "$1")")/made.vdb" ;;
    esac
}

## Noises ##

# noise NAME WxHxT [OPTION]...: path of a texture for `--set noise=`.
noise()
{
    noise_at=$lab/noises/$(echo "$made_hash $*" | hash_of)/$1.$2.raw
    noise_name=$1 noise_size=$2
    shift 2
    once "$noise_at" "$BUILD/brume-noise" "$noise_name" --size "$noise_size" \
        "$@" -o && echo "$noise_at"
}

## References ##

sets() # KEY=VALUE...: as --set arguments
{
    for sets_pair; do
        printf ' --set %s' "$sets_pair"
    done
}

# reference VOLUME SCENE [KEY=VALUE]...: path of the double-precision picture.
# The settings of $lab_truth are not added: say them.
reference()
{
    reference_voxels=$(voxels "$1") || return
    reference_scene=lab/scenes/$2.scene
    shift 2
    reference_at=$lab/references/$({
        echo "$reference_hash $*"
        cat "$reference_scene" "$reference_voxels"
    } | hash_of).pfm
    # shellcheck disable=SC2046
    once "$reference_at" "$BUILD/brume-reference" "$reference_voxels" \
        --scene "$reference_scene" $(sets "$@") --threads "$JOBS" -o &&
        echo "$reference_at"
}

# monte_carlo VOLUME SCENE ORDER PASSES [KEY=VALUE]...: path of the unbiased
# picture of scattering up to ORDER (0: all); PATH.error.pfm has its standard
# errors.
monte_carlo()
{
    mc_voxels=$(voxels "$1") || return
    mc_scene=lab/scenes/$2.scene mc_order=$3 mc_passes=$4
    shift 4
    mc_at=$lab/references/mc$({
        echo "$reference_hash $mc_order $mc_passes $*"
        cat "$mc_scene" "$mc_voxels"
    } | hash_of)/mean.pfm
    # shellcheck disable=SC2046
    once "$mc_at" "$BUILD/brume-monte-carlo" "$mc_voxels" \
        --scene "$mc_scene" $(sets "$@") --order "$mc_order" --passes \
        "$mc_passes" --threads "$JOBS" --error "$mc_at.error.pfm" -o &&
        echo "$mc_at"
}

## Frames ##

# sequence VOLUME SCENE ARGUMENT...: rows of brume-lab on stdout.
sequence()
{
    sequence_volume=$(volume "$1") || return
    sequence_scene=$2
    shift 2
    "$BUILD/brume-lab" sequence "$sequence_volume" \
        --scene "lab/scenes/$sequence_scene.scene" --set "size=$lab_size" "$@"
}

# mean_picture VOLUME SCENE FRAMES [KEY=VALUE]...: path of the mean of so many
# frames with white noise and nothing accumulated: what a method tends to.
mean_picture()
{
    mean_at=$lab/references/mean$({
        echo "$inputs $lab_size $*"
        cat "lab/scenes/$2.scene"
    } | hash_of).pfm
    mean_volume=$1 mean_scene=$2 mean_frames=$3
    shift 3
    # shellcheck disable=SC2046
    once "$mean_at" sequence "$mean_volume" "$mean_scene" $(sets "$@") \
        --set noise=white --frames "0:$((mean_frames - 1))" --mean &&
        echo "$mean_at"
}

## Time ##

# scene_pairs SCENE: its lines as KEY=VALUE... on one.
scene_pairs()
{
    sed 's/#.*//; /^ *$/d; s/ *= */=/; s/ *$//; s/ /,/g' \
        "lab/scenes/$1.scene" | tr '\n' ' '
}

# bench VOLUME SCENE RUNS: host times, of units that are marked `timed`. Lines
# NAME RENDERER [KEY=VALUE]... on stdin, of brume-bench's renderers, drawn in
# turns; rows of brume-bench on stdout, whose `ratio` is the time of the first
# line, `nano nano-tuned ...`, over each one's.
bench()
{
    bench_volume=$(volume "$1") || return
    bench_scene="$(scene_pairs "$2") size=$lab_size output=linear"
    awk -v rest="vdb=$(vdb "$1") asset=$bench_volume $bench_scene" '{
        settings = ""
        for (i = 3; i <= NF; i++)
            settings = settings " " $i
        print "name=" $1, "render=" $2, rest settings
    }' | "$BUILD/brume-bench" "$3"
}

# march_keys KEY=VALUE...: those that brume-bench knows: a march, alone. Octaves
# and exposure look up no densities.
march_keys()
{
    for march_pair; do
        case ${march_pair%%=*} in
        temporal | window | alpha | subpixel | spatial | edge_falloff | \
            resolution | octaves | exposure) ;;
        *) printf '%s ' "$march_pair" ;;
        esac
    done
}

# A black picture, for times of frames: rows need something to compare with.
black()
{
    black_at=$lab/references/black$lab_size.pfm
    once "$black_at" sequence cube cube_scatter --set albedo=0 --mean &&
        echo "$black_at"
}

# frame_times VOLUME SCENE RUNS: processor times of whole frames, with history,
# filters and fewer rays, which brume-bench has not; for units that are marked
# `timed`. Lines NAME [KEY=VALUE]... on stdin, drawn in turns, each turn the
# frames 1 to 4 of a sequence, by one thread; the first line is drawn by tuned
# NanoVDB, too, without octaves. Rows name,ratio,ratio_least,ratio_most,ms on
# stdout: `ratio` is NanoVDB's time at the settings of the first line over each
# one's, in the same turn.
frame_times()
{
    times_black=$(black) || return
    times_lines=$(cat)
    # shellcheck disable=SC2046
    times_first=$(march_keys $(echo "$times_lines" | sed '1!d; s/^[^ ]*//'))
    seq "$3" | while read -r _; do
        echo "nano nano-tuned $times_first" | bench "$1" "$2" 1 |
            awk -F, -v OFS=, 'NR == 2 { print "nano", $5 }'
        echo "$times_lines" | while read -r times_name times_keys; do
            # shellcheck disable=SC2046,SC2086
            sequence "$1" "$2" $(sets $times_keys) --frames 0:4 --from 1 \
                --time --reference "black=$times_black" \
                --column "name=$times_name" | awk -F, -v OFS=, '
                NR > 1 { print $1, $NF }'
        done
    done | awk -F, -v OFS=, -f lab/times.awk
}
