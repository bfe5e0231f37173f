# SPDX-License-Identifier: MIT
# Read by run.sh: trilinear lookups from several layouts of a volume.

part_layouts()
{
    if [ ! -x "$BUILD/brume-layouts" ]; then
        echo "LAYOUTS ARE MEASURED ON x86-64 ONLY: LEFT OUT" | tee /dev/stderr
        return
    fi
    if real disney wdas_cloud_sixteenth.vdb u8; then
        layouts_of disney "Disney cloud at 1/16" 8
    fi
    cloud cloud256 --size 256
    layouts_of cloud256 "Cloud of 256^3" 16
    cloud cloud512 --size 512
    layouts_of cloud512 "Cloud of 512^3" 16
}

# layouts_of VOLUME TITLE PART
layouts_of()
{
    say "layouts of $1"
    # shellcheck disable=SC2046,SC2086
    "$BUILD/brume-layouts" "$RUNS" "$3" "$volumes/$1.brume" $thesis \
        $trilinear $(camera "$1") >"$out/layouts_$1.csv"
    printf '\n**%s, trilinear, nanoseconds per lookup: median (least)**\n\n' \
        "$2"
    awk -F, '
        NR == 1 { next }
        {
            key = $1 "," $2
            if (!(key in bytes)) {
                order[++n] = key
                name[key] = $1
                products[key] = $2
            }
            bytes[key] = $8
            ns[key, $3] = sprintf("%.2f (%.2f)", $4, $5)
        }
        END {
            print "| layout | products | bytes per voxel | AVX2 | AVX-512 |"
            print "|---|---|---|---|---|"
            for (i = 1; i <= n; i++) {
                key = order[i]
                printf "| %s | %s | %s | %s | %s |\n", name[key],
                    products[key], (bytes[key] > 0) ? bytes[key] : "",
                    ns[key, 8], ns[key, 16]
            }
        }' "$out/layouts_$1.csv"
}
