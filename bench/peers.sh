# SPDX-License-Identifier: MIT
# Read by run.sh: the peers on four volumes, three scenes each.

# contenders VOLUME PEERS... -- SETTINGS...: the peers, then our kernels.
contenders()
{
    volume=$1 list=
    shift
    while [ "$1" != -- ]; do
        list="$list $1"
        shift
    done
    shift
    for who in $list $(kernels); do
        row "$who" "$who" "$(with_peers "$volume")" "$(camera "$volume")" "$@"
    done
}

# versus VOLUME TITLE PART: three tables. Slow marches draw one of PART, eight
# times PART strips of 16 rows, all of them the same ones.
versus()
{
    contenders "$1" nano-tuned nano-shipped nano-fp8 pnano open -- \
        "part=$3" | figures "peers_$1_nearest"
    contenders "$1" nano-tuned nano-leaf nano-shipped nano-fp8 pnano open -- \
        "$trilinear" "part=$(($3 * 8))" | figures "peers_$1_trilinear"
    contenders "$1" nano-tuned nano-leaping nano-fp8 pnano open -- \
        "$uniform" "part=$(($3 * 8))" | figures "peers_$1_uniform"
    for scene in nearest trilinear uniform; do
        printf '\n**%s, %s**\n\n' "$2" "$(scene_title $scene)"
        table -v mode=peers "$out/peers_$1_$scene.csv"
    done
}

scene_title()
{
    case $1 in
    nearest) echo "nearest, ten doubling light samples" ;;
    trilinear) echo "trilinear, ten doubling light samples" ;;
    *) echo "nearest, 256 uniform light samples" ;;
    esac
}

# OpenVDB's own renderer: double, trilinear, a shadow ray from every sample to
# the end. Ours with the same steps, thresholds and picture, to 8 bits.
render_of_openvdb()
{
    if ! command -v vdb_render >/dev/null; then
        echo "vdb_render IS NOT INSTALLED (libopenvdb-tools): LEFT OUT"
        return
    fi
    say "vdb_render"
    same="size=240x135 jitter=none filter=trilinear light=uniform
        light_samples=256 light_step=2 min_transmittance=0.005"
    # shellcheck disable=SC2086
    for who in scalar $(widest | grep -v scalar); do
        row "$who" "$who" "$(ours_alone cloud256)" "$(camera cloud256)" $same
    done | figures peers_vdb_render
    # User time of the children of this shell.
    spent=$(
        vdb_render "$volumes/cloud256.vdb" "$out/vdb_render.ppm" -cpus 1 \
            -res 240x135 -translate 300,40,455 -lookat 130,84,130 \
            -fov 43.04 -step 2 -shadowstep 2 -cutoff 0.005 -absorb 0,0,0 \
            -scatter 0.05,0.05,0.05 -gain 0 \
            -light -0.7501,0.5878,0.3031,1,1,1 >/dev/null 2>&1
        times >"$out/times"
        tail -1 "$out/times"
    )
    set --
    for pair in $thesis $(camera cloud256) $same; do
        set -- "$@" --set "$pair"
    done
    "$BUILD/brume" render "$volumes/cloud256.brume" "$@" -o "$out/ours.ppm"
    rmse=$("$BUILD/brume" compare "$out/vdb_render.ppm" "$out/ours.ppm" \
        --metrics rmse |
        sed -n 's/^rmse=//p')
    echo "$spent" | awk -F'[ms ]' -v rmse="$rmse" -v ours="$(awk -F, \
        'NR > 1 { printf "%s %s ", $1, $5 }' \
        "$out/peers_vdb_render.csv")" '{
        ms = 1000 * (60 * $1 + $2)
        printf "\nvdb_render (double, trilinear, a shadow ray from every " \
            "sample; with reading the\nfile): %d ms for 240x135. The same " \
            "steps by brume:", ms
        n = split(ours, who, " ")
        for (i = 1; i < n; i += 2)
            printf "%s %s %.0f ms, a speed of %.1f", (i > 1 ? ";" : ""),
                who[i], who[i + 1], ms / who[i + 1]
        printf ".\nThe pictures differ by an RMSE of %.1f of 255.\n", rmse
    }'
}

# VTK casts rays without light: beside it, everybody without light, ended where
# VTK ends a ray.
unlit()
{
    for filter in nearest trilinear; do
        for who in nano-tuned $(kernels); do
            row "$who" "$who" "$(with_peers cloud256)" "$(camera cloud256)" \
                light=none jitter=none min_transmittance=0.008 filter=$filter
        done | figures "peers_unlit_$filter"
    done
    vtk=none
    if [ -x "$BUILD/brume-vtk" ]; then
        say vtk
        vtk=$out/peers_vtk.csv
        "$BUILD/brume-vtk" "$volumes/cloud256.vdb" "$RUNS" >"$vtk"
    else
        echo "VTK IS NOT INSTALLED (libvtk9-dev): LEFT OUT"
    fi
    for filter in nearest trilinear; do
        printf '\n**Cloud of 256^3, %s, no light rays**\n\n' $filter
        table -v mode=peers "$out/peers_unlit_$filter.csv"
        [ -f "$vtk" ] || continue
        awk -F, -v filter=$filter 'NR == FNR {
                if (FNR > 1 && ($1 ~ /linear/) == (filter == "trilinear"))
                    printf "| VTK fixed-point caster, same scene, own " \
                        "lattice | %.2f | | %.0f | | | | %.2f | |\n",
                        base / $2, $2, $3 / 1048576
            }' base="$(awk -F, '$1 == "nano-tuned" { print $5 }' \
            "$out/peers_unlit_$filter.csv")" "$vtk"
    done
}

part_peers()
{
    cloud cloud256 --size 256
    versus cloud256 "Cloud of 256^3" 1
    if real disney wdas_cloud_sixteenth.vdb u8; then
        versus disney "Disney cloud at 1/16" 2
    fi
    if real smoke openvdb_smoke1.vdb u8r; then
        versus smoke "Smoke" 2
    fi
    if [ "$BIG" = yes ]; then
        cloud big --size 1000x700x1200
        versus big "Cloud of 1000x700x1200" 4
    fi
    render_of_openvdb
    unlit
    threads_against_one
    targets
}

# And what two threads are worth on this machine, busy as it is now.
threads_against_one()
{
    say "two threads"
    "$BUILD/brume-limit" "$RUNS" >"$out/limit.csv"
    for n in 1 2; do
        row "threads-$n" "$(widest)" "$(ours_alone cloud256)" \
            "$(camera cloud256)" "threads=$n"
    done | figures threads
}

# The goals of this project, and whether this run met them.
targets()
{
    printf '\n**Goals**\n\n'
    set -- "$out"/peers_cloud256_*.csv "$out/threads.csv" "$out/limit.csv"
    [ ! -f "$out/peers_big_nearest.csv" ] ||
        set -- "$@" "$out/peers_big_nearest.csv"
    awk -f "$here/targets.awk" "$@"
}
