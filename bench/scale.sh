# SPDX-License-Identifier: MIT
# Read by run.sh: our march alone, over sizes of everything; and its choices.

# both X VOLUME SETTINGS...: the scalar and the widest kernel, named by X.
both()
{
    both_x=$1 both_volume=$2
    shift 2
    for who in scalar $(widest | grep -v scalar); do
        row "$who/$both_x" "$who" "$(ours_alone "$both_volume")" \
            "$(camera "$both_volume")" "$@"
    done
}

# Names are kernel/x. To a table of x and kernels, for charts.
by_kernel()
{
    awk -F, -v x="$2" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    {
        split($1, part, "/")
        at_x = x == "covered" ? 100 * $at["covered"] : part[2]
        if (!(part[2] in seen)) {
            seen[part[2]] = ++n
            place[n] = at_x
            lookups[n] = $at["lookups"]
        }
        ms[n, part[1]] = $at["ms"]
        if (!(part[1] in known)) {
            known[part[1]] = ++kernels
            kernel[kernels] = part[1]
        }
    }
    END {
        printf "%s", x
        for (k = 1; k <= kernels; k++)
            printf ",%s_ms", kernel[k]
        print ",lookups"
        for (i = 1; i <= n; i++) {
            printf "%s", place[i]
            for (k = 1; k <= kernels; k++)
                printf ",%s", ms[i, kernel[k]]
            print "," lookups[i]
        }
    }' "$out/$1.csv" >"$out/scale_$1.csv"
    rm -f "$out/$1.csv"
    printf '\n**%s**\n\n' "$3"
    awk -F, '{ line = "|"
        for (i = 1; i <= NF; i++)
            line = line " " ((NR > 1 && i > 1 && i < NF) ? \
                sprintf("%.4g", $i) : $i) " |"
        print line
        if (NR == 1)
            print bars(NF) }
        function bars(n, s) {
            for (s = "|"; n > 0; n--)
                s = s "---|"
            return s }' "$out/scale_$1.csv"
}

scale_pixels()
{
    for w in 120 240 480 960 1920; do
        h=$((w * 9 / 16))
        both $((w * h)) cloud256 "size=${w}x$h"
    done | figures pixels
    by_kernel pixels pixels "Pixels"
}

scale_covered()
{
    for fov in 90 56 38 30 25 21 17 13; do
        both $fov cloud256 size=480x270 fov=$fov
    done | figures covered
    by_kernel covered covered "Covered pixels, per cent of 480x270"
}

# One cloud at four resolutions, looked up at the same places of the world.
scale_volume()
{
    for n in 64 128 256 512; do
        cloud "world$n" --size $n --voxel-size "$(ratio 256 $n)"
    done
    for n in 64 128 256 512; do
        both $n "world$n" size=480x270 step="$(ratio $n 128)" \
            light_step="$(ratio $n 256)" \
            density_scale="$(ratio 12.8 $n)" \
            light_density_scale="$(ratio 12.8 $n)"
    done | figures volume
    by_kernel volume voxels_a_side "Volume size, the same lookups in the world"
}

ratio() { awk -v a="$1" -v b="$2" 'BEGIN { print a / b }'; }

scale_steps()
{
    for step in 0.5 1 2 4 8; do
        both $step cloud256 size=480x270 step=$step
    done | figures steps
    by_kernel steps step "Step, voxels"
}

scale_light()
{
    for n in 0 1 2 4 6 8 10 12; do
        both $n cloud256 size=480x270 light_samples=$n
    done | figures light_log
    by_kernel light_log light_samples "Doubling light samples"
    for n in 8 16 32 64 128 256; do
        both $n cloud256 size=480x270 light=uniform light_samples=$n \
            light_step="$(ratio 256 $n)"
    done | figures light_uniform
    by_kernel light_uniform light_samples \
        "Uniform light samples over the same 256 voxels"
}

scale_threads()
{
    for n in 1 2 4; do
        both $n cloud256 size=960x540 threads=$n
    done | figures threads_ms
    by_kernel threads_ms threads "Threads, of $(nproc) processors"
}

part_scale()
{
    cloud cloud256 --size 256
    scale_pixels
    scale_covered
    scale_volume
    scale_steps
    scale_light
    scale_threads
    charts
}

charts()
{
    if ! command -v gnuplot >/dev/null; then
        echo "gnuplot IS NOT INSTALLED (gnuplot-nox): NO CHARTS"
        return
    fi
    gnuplot -e "dir='$out'" "$here/charts.gp"
}

## Choices ##

# The first row is the base: a speed of 0.93 is 7 % slower.
part_jitter()
{
    cloud cloud256 --size 256
    [ "$BIG" != yes ] || cloud big --size 1000x700x1200
    for filter in nearest trilinear; do
        for noise in none white ign rank1 stbn; do
            row "$noise" "$(widest)" "$(ours_alone cloud256)" \
                "$(camera cloud256)" part=4 filter=$filter noise=$noise \
                "jitter=$([ $noise = none ] && echo none || echo primary)"
        done | figures "jitter_$filter"
        printf '\n**Jitter of view rays, %s, %s**\n\n' $filter "$(widest)"
        table -v head=noise "$out/jitter_$filter.csv"
    done
    for jitter in none primary light both; do
        row "$jitter" "$(widest)" "$(ours_alone cloud256)" \
            "$(camera cloud256)" jitter=$jitter
    done | figures jitter_rays
    printf '\n**Which rays are jittered (ign, nearest, %s)**\n\n' "$(widest)"
    table -v head=jitter "$out/jitter_rays.csv"
    orders
}

orders()
{
    for volume in cloud256 big; do
        [ -f "$volumes/$volume.brume" ] || continue
        for tile in 64x16 16x16 8x8; do
            for order in linear morton hilbert; do
                row "tiles_${tile}_$order" "$(widest)" \
                    "$(ours_alone $volume)" "$(camera $volume)" \
                    tile=$tile order=$order
            done
        done | figures "order_tiles_$volume"
        for bricks in "" _linear; do
            row "bricks${bricks:-_morton}" "$(widest)" \
                "$(ours_alone $volume$bricks)" "$(camera $volume)"
        done | figures "order_bricks_$volume"
        for what in tiles bricks; do
            printf '\n**Order of %s, %s, %s**\n\n' $what $volume "$(widest)"
            table -v head="$what" "$out/order_${what}_$volume.csv"
        done
    done
}
