# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# The front: error against cost, of every sensible combination of settings, on
# four volumes. Read by run.sh.
#
# A setting's name is its parts with - between:
#   format-lookup-light-step-noise-temporal-spatial-rays
# Units: error/VOLUME/LOOKUP-LIGHT, m4/VOLUME/LOOKUP-LIGHT (instructions of a
# Cortex-M4, counted by its emulator), time/VOLUME/LOOKUP (of this machine), and
# large/VOLUME: some of m4's at the size of error's.

front_volumes="disney smoke cumulus block"
front_size=240x135 front_m4_size=80x45
[ -z "$QUICK" ] || front_volumes="disney block" front_size=64x36

# What is tried: all combinations within a line. `own` is the format that fits
# a volume. What is left out, and why:
#   taa         at rest it is ema to the bit, and costs more: docs/temporal.md
#   cache2, 8   they cost what cache4 does; the choice is one of memory and
#               error, docs/light.md
#   uniform     beyond 64 samples, and nearest over time: 64 alone take longer
#               than all else
#   no noise    over time: every frame would be the same
#   no time     with steps above 2 and no filter: grain. With gauss1 it is
#               in, for who has no memory for a history
#   step < 1    below a voxel nothing is left to be found: see the parts
#   box, binomial, bilateral
#               filters differ less among each other than from none: their own
#               experiment
#   light none  the floor of cost: what any light costs more
front_grid="
own near,tri none,log6,log10,cone10,cache4,uni64 1,2,4,8 none none none full
own near,tri       uni16               1,2,4   none none none full
own near,tri       cone10,cache4       1,2     none none none half,quarter
own near,tri,stoch log10,cone10,cache4 1,2,4,8 fast ema none full
own near           log6,cone6          2,4,8   fast ema none full
own near           none                4,8     fast ema none full
own near,tri,stoch cone10,cache4       16      fast ema none full,half
own near           cone10,cache4       16      fast ema none quarter
own tri            uni16,uni64         1,2,4   fast ema none full
own near,tri       cone10,cache4       4       fast ema none half,checker
own stoch          cone10,cache4       2,4,8   fast ema none half
own stoch          cone10,cache4       4       fast win8,ema gauss1 full
own near,tri       cone10,cache4       2,8     rank1 ema none full,half
own near,tri       cone10,cache4       2,8     fast ema gauss1 full,half
own near,tri       cone10,cache4       2,8     fast win8 none full
own near,tri cone10,cache4 2,8 fast ema none half,quarter,checker
own near,tri       cone10,cache4       2,8     fast none gauss1 full
u8,u8r,u4r near,tri cone10,cache4 1 none none none full
u8,u8r,u4r near,tri cone10,cache4 2 fast ema none full
own near cone10 4 white,ign,stbn,fastview ema none full"
# A corner of it, of all kinds.
[ -z "$QUICK" ] || front_grid="
own near,tri       log10,cone10,cache4 2       none none none full
own near           cone10,cache4       2,8     fast ema none full,half
own,u4r stoch cone10 2 fast ema none full
own near           cache4              4       fast win8 gauss1 full,quarter"

# front_settings VOLUME [LOOKUP-LIGHT | LOOKUP]: one a line, none twice.
front_settings()
{
    front_own=u8
    [ "$1" != smoke ] || front_own=u8r
    echo "$front_grid" | awk -v own="$front_own" -v want="${2:-}" '
        function cross(name, i,    n, k, part) {
            if (i > 8) {
                if ((!want || index(name "-", "-" want "-")) && !seen[name]++)
                    print name
                return
            }
            n = split(list[i], part, ",")
            for (k = 1; k <= n; k++)
                cross(i > 1 ? name "-" part[k] : \
                    part[k] == "own" ? own : part[k], i + 1)
        }
        NF { for (i = 1; i <= 8; i++) list[i] = $i; cross("", 1) }'
}

front_list()
{
    for front_volume in $front_volumes; do
        front_settings "$front_volume" | awk -F- -v v="$front_volume" '
            !seen[$2, $3]++ {
                print "error/" v "/" $2 "-" $3
                print "m4/" v "/" $2 "-" $3
            }'
        echo "large/$front_volume"
        [ -n "$QUICK" ] || front_settings "$front_volume" |
            awk -F- -v v="$front_volume" '
                !seen[$2]++ { print "time/" v "/" $2, "timed" }'
    done
}

## Volumes ##

# front_how front-VOLUME-FORMAT: how lib.sh's volume bakes it, with all that
# kinds of light need.
front_how()
{
    front_format=${1##*-} front_volume=${1#front-}
    case ${front_volume%-*} in
    disney) front_from=$DATA/wdas_cloud_sixteenth.vdb ;;
    smoke) front_from=$DATA/openvdb_smoke1.vdb ;;
    cumulus) front_from=cumulus:256 ;;
    block) front_from=block:96 ;;
    esac
    front_sun=$(sed -n 's/^sun = \(.*\) \(.*\)$/\1,\2/p' \
        "lab/scenes/front_${front_volume%-*}.scene")
    [ "${front_from#*:}" != "$front_from" ] || [ -f "$front_from" ] || return 3
    echo "front_bake $front_from $front_format $front_sun"
}

front_bake() # FILE or TYPE:SIZE, FORMAT SUN OUT.brume
{
    front_vdb=$1
    if [ "${1#*:}" != "$1" ]; then
        front_vdb=$(dirname "$4")/made.vdb
        "$BUILD/brume-cloud" --type "${1%:*}" --size "${1#*:}" \
            -o "$front_vdb" || return
    fi
    "$BUILD/brume-bake" "$front_vdb" --format "$2" --mips --sun-cache 4 \
        --sun "$3" -o "$4" --dump-float "$(dirname "$4")/voxels.float"
}

## Settings ##

# Light samples reach some 256 voxels, past each of the volumes.
front_light()
{
    case $1 in
    none | cache4) echo "light=${1%4}" ;;
    log* | cone*)
        echo "light=${1%%[0-9]*} light_step=1" \
            "light_samples=${1#"${1%%[0-9]*}"}"
        ;;
    uni*)
        echo "light=uniform light_samples=${1#uni}" \
            "light_step=$((256 / ${1#uni}))"
        ;;
    esac
}

# Both rays are jittered, but for fastview.
front_noise()
{
    case $1 in
    none) echo jitter=none noise=none ;;
    fastview) echo jitter=primary noise=fast ;;
    *) echo jitter=both "noise=$1" ;;
    esac
}

# front_sets SETTING: as key=value, without format.
front_sets()
{
    echo "$1" | tr - ' ' | {
        read -r _ lookup light step noise temporal spatial rays
        case $lookup in
        near) lookup=nearest ;;
        tri) lookup=trilinear ;;
        stoch) lookup=stochastic ;;
        esac
        case $temporal in
        win8) temporal="window window=8" ;;
        esac
        case $rays in
        checker) rays="full update=checker" ;;
        esac
        echo "filter=$lookup step=$step $(front_light "$light")" \
            "$(front_noise "$noise") temporal=$temporal spatial=$spatial" \
            "resolution=$rays min_transmittance=0.01"
    }
}

# A picture without noise stands still: frame 0 is all of them.
front_is_still()
{
    case $1 in *-none-none-*-*) return 0 ;; *) return 1 ;; esac
}

## Rows ##

front_truth()
{
    # shellcheck disable=SC2086
    reference "front-$1-u8" "front_$1" $lab_truth size=$front_size
}

# front_sequence VOLUME SETTING ARGUMENT...
front_sequence()
{
    front_volume=$1 front_setting=$2
    shift 2
    # shellcheck disable=SC2046
    sequence "front-$front_volume-${front_setting%%-*}" "front_$front_volume" \
        $(sets $(front_sets "$front_setting")) \
        --column "volume=$front_volume" --column "setting=$front_setting" "$@"
}

front_error()
{
    front_reference=$(front_truth "$1") || return
    front_rows=$(front_settings "$1" "$2" | while read -r front_name; do
        front_frames="--frames 0:31 --only 3 --only 31"
        ! front_is_still "$front_name" || front_frames="--frames 0:0"
        # shellcheck disable=SC2086
        front_sequence "$1" "$front_name" $front_frames --flip \
            --reference "truth=$front_reference" || exit
    done) || return
    echo "$front_rows" | awk 'NR == 1 { head = $0; print } $0 != head'
}

# Peer and settings in one unit: the peer is tuned NanoVDB, trilinear, a sample
# each voxel, ten doubling light samples.
front_time()
{
    [ -x "$BUILD/brume-bench" ] || return 3
    front_reference=$(front_truth "$1") || return
    front_peer=$(echo "nano nano-tuned filter=trilinear step=1 light=log" \
        "light_samples=10 light_step=1 jitter=none" |
        bench "front-$1-u8" "front_$1" 7 | awk -F, '
            NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
            NR == 2 { print $at["ms"] }')
    echo "volume,setting,ms,peer_ms"
    front_settings "$1" "$2" | while read -r front_name; do
        front_sequence "$1" "$front_name" --frames 0:11 --from 2 --time \
            --reference "truth=$front_reference" |
            awk -F, -v OFS=, -v peer="$front_peer" '
                NR > 1 && (ms == "" || $NF < ms) { ms = $NF; row = $1 OFS $2 }
                END { if (ms == "") exit 1; print row, ms, peer }' || exit
    done
}

## On a Cortex-M4 ##

# front_elf: path of the program that counts. Built by one unit, others wait.
front_elf()
{
    front_at=$lab/targets/$({
        echo "$inputs"
        cat lab/target/*.[ch]
    } | hash_of).elf
    once "$front_at" front_build && echo "$front_at"
}

front_build()
{
    (
        unset MAKEFLAGS MAKELEVEL CC CFLAGS CPPFLAGS LDFLAGS CONF TARGET
        make -s BUILD="$BUILD" CONF=mps2-an386 TARGET=lab-m4 \
            "$BUILD/targets/lab-m4/count.elf"
    ) && cp "$BUILD/targets/lab-m4/count.elf" "$1"
}

# front_pack VOLUME SIZE RECORDS: of settings on stdin. Two frames over time:
# the second has a history.
front_pack()
{
    : >"$3"
    while read -r front_name; do
        front_last=1
        ! front_is_still "$front_name" || front_last=0
        # shellcheck disable=SC2046
        "$BUILD/brume-lab" pack \
            "$(volume "front-$1-${front_name%%-*}")" \
            --scene "lab/scenes/front_$1.scene" \
            $(sets $(front_sets "$front_name") "size=$2") \
            --frames "0:$front_last" >>"$3" || return
    done
}

# front_emulate VOLUME FORMAT SIZE: rows of settings on stdin.
front_emulate()
{
    front_records=$lab/records.$$
    front_names=$(cat)
    front_brume=$(volume "front-$1-$2") || return
    echo "$front_names" | front_pack "$1" "$3" "$front_records" || return
    timeout 600 qemu-system-arm -M mps2-an386 -icount shift=0,sleep=off \
        -nographic -semihosting-config enable=on,target=native \
        -device "loader,file=$front_brume,addr=0x21000000,force-raw=on" \
        -device "loader,file=$front_records,addr=0x21800000,force-raw=on" \
        -kernel "$(front_elf)" >"$front_records.out" </dev/null
    echo "$front_names" | awk -v v="$1" -v size="$3" -v OFS=, \
        -v counts="$front_records.out" '{
            if ((getline line <counts) < 1 || split(line, c, " ") != 7 || \
                c[7] != "same") {
                print "lab: M4: " $1 ": " line >"/dev/stderr"
                exit 1
            }
            print v, $1, size, c[2], c[3], c[4], c[5], c[6]
        }' || return
    rm -f "$front_records" "$front_records.out"
}

# front_m4 VOLUME SIZE: of settings on stdin.
front_m4()
{
    command -v arm-none-eabi-gcc >/dev/null || return 3
    command -v qemu-system-arm >/dev/null || return 3
    volume "front-$1-u8" >/dev/null || return
    front_elf >/dev/null || return 1
    echo "volume,setting,size,pixels,begin,trace,resolve,show"
    front_all=$(cat)
    for front_one in u8 u8r u4r; do
        front_these=$(echo "$front_all" | grep "^$front_one-") || continue
        echo "$front_these" | front_emulate "$1" "$front_one" "$2" || return 1
    done
}

front_run()
{
    # shellcheck disable=SC2034
    lab_size=$front_size
    front_rest=${1#*/}
    case $1 in
    error/*) front_error "${front_rest%/*}" "${front_rest#*/}" ;;
    time/*) front_time "${front_rest%/*}" "${front_rest#*/}" ;;
    m4/*)
        front_settings "${front_rest%/*}" "${front_rest#*/}" |
            front_m4 "${front_rest%/*}" "$front_m4_size"
        ;;
    large/*)
        front_settings "$front_rest" | awk 'NR % 29 == 5' |
            front_m4 "$front_rest" "$front_size"
        ;;
    esac
}

## Claims ##

front_table()
{
    echo "front_${1%%/*}"
}

front_derive()
{
    set -- "$out/front_error.csv" "$out/front_m4.csv" "$out/front_time.csv"
    for front_table in front_error front_m4 front_time; do
        shift
        [ ! -f "$out/$front_table.csv" ] ||
            set -- "$@" "$out/$front_table.csv"
    done
    awk -f lab/front/join.awk "$@" >"$out/front_all.csv"
    awk -f lab/front/fronts.awk "$out/front_all.csv" >"$out/front_fronts.csv"
    awk -v dir="$out" -f lab/front/tables.awk "$out/front_all.csv" \
        "$out/front_fronts.csv"
    {
        echo "front_size,$front_size"
        echo "front_m4_size,$front_m4_size"
        echo "front_settings,$(front_settings disney | wc -l)"
    } >>"$out/settings.csv"
    [ ! -f "$out/front_large.csv" ] || front_derive_large
}

# How far the small picture's count is from that of the picture itself.
front_derive_large()
{
    awk -F, -v OFS=, '
        FNR == 1 {
            if (NR == 1)
                print "volume", "setting", "small", "large", "ratio"
            file++
            next
        }
        { count = ($6 + $7 + $8) / $4 }
        file == 1 { small[$1, $2] = count }
        file == 2 {
            printf "%s,%s,%.1f,%.1f,%.4f\n", $1, $2, small[$1, $2], count, \
                small[$1, $2] / count
        }' "$out/front_m4.csv" "$out/front_large.csv" >"$out/front_small.csv"
    awk -F, 'NR > 1 {
            off = $5 > 1 ? $5 - 1 : 1 - $5
            most = off > most ? off : most
            sum += off
            n++
        }
        END {
            print "name,value"
            printf "settings,%d\nmost,%.4f\nmean,%.4f\n", n, most, sum / n
        }' "$out/front_small.csv" >"$out/front_off.csv"
}

front_at() # VOLUME SETTING COLUMN
{
    front_own=u8
    [ "$1" != smoke ] || front_own=u8r
    value front_all "$3" "volume=$1" "setting=$front_own-$2"
}

front_share() { value front_share "$2" "what=$1"; }

front_check()
{
    # Nine times fewer pixels: their outlines are cut in other places.
    claim front_small "$(value front_off value name=most)" \< 0.03 \
        "M4: a small picture counts as a large one within 3 %"
    for front_volume in $front_volumes; do
        claim "front_ema_$front_volume" \
            "$(front_at "$front_volume" near-cone10-8-fast-ema-none-full \
                rmse31)" \< \
            "$(front_at "$front_volume" near-cone10-8-fast-ema-none-full \
                rmse3)" \
            "$front_volume: EMA goes on to help after frame 3"
        # A quarter of the rays, and what all pixels take.
        claim "front_half_$front_volume" \
            "$(front_at "$front_volume" near-cone10-2-fast-ema-none-half m4)" \
            \< "0.4 * $(front_at "$front_volume" \
                near-cone10-2-fast-ema-none-full m4)" \
            "$front_volume: half resolution costs less than 0.4 on the M4"
        claim "front_cache_$front_volume" \
            "$(front_at "$front_volume" near-cache4-2-none-none-none-full m4)" \
            \< "0.5 * $(front_at "$front_volume" \
                near-cone10-2-none-none-none-full m4)" \
            "$front_volume: with the light cache half of what ten cones cost"
    done
    [ -n "$QUICK" ] || front_check_grid
}

# What needs the whole grid.
front_check_grid()
{
    for front_volume in disney smoke cumulus; do
        claim "front_uniform_$front_volume" \
            "$(front_at "$front_volume" tri-uni64-2-fast-ema-none-full \
                rmse31)" \< \
            "$(front_at "$front_volume" tri-cone10-1-fast-ema-none-full \
                rmse31)" \
            "$front_volume: 64 uniform samples at step 2 over time below cones \
at step 1"
    done
    for front_volume in $front_volumes; do
        claim "front_noise_$front_volume" \
            "$(front_at "$front_volume" near-cone10-4-fast-ema-none-full \
                rmse31)" \< \
            "$(front_at "$front_volume" near-cone10-4-white-ema-none-full \
                rmse31)" \
            "$front_volume: fast below white, at the same cost"
    done
    claim front_temporal "$(front_share temporal-ema all)" \> \
        "0.8 * $(front_share points all)" \
        "of the fronts at frame 31 more than 0.8 have EMA"
    claim front_rays "$(front_share rays-full cheap)" \< \
        "0.2 * $(front_share points cheap)" \
        "below 2000 instructions per pixel less than 0.2 march every ray"
    claim front_light "$(front_share light-cache4 cheap)" \> \
        "0.6 * $(front_share points cheap)" \
        "there more than 0.6 take light from the cache"
    claim front_lookup "$(front_share lookup-tri middle) +
            $(front_share lookup-tri dear)" \> \
        "0.8 * ($(front_share points middle) + $(front_share points dear))" \
        "above more than 0.8 are trilinear"
    claim front_floor "$(front_share light-none all)" \< 1 \
        "none is without light"
}
