# SPDX-License-Identifier: MIT
# Read by run.sh: what the machine would take for the loads of a march alone.

part_limit()
{
    cloud cloud256 --size 256
    say limit
    "$BUILD/brume-limit" "$RUNS" >"$out/limit.csv"
    printf '\n**What a word costs, ns, by the size of its table**\n\n'
    awk -F, 'NR == 1 || /^two_/ { next }
        $1 == "chain_alone" { alone[$2] = $3; next }
        {
            if (!($1 in kind)) { kind[$1]; name[++kinds] = $1 }
            if (!($2 in size)) { size[$2]; kib[++sizes] = $2 }
            ns[$1, $2] = $3
        }
        END {
            printf "| KiB |"
            for (s = 1; s <= sizes; s++) printf " %s |", kib[s]
            printf "\n|---|"
            for (s = 1; s <= sizes; s++) printf "---|"
            print ""
            for (k = 1; k <= kinds; k++) {
                printf "| %s |", name[k]
                for (s = 1; s <= sizes; s++)
                    printf " %.2f |", (name[k] == "chain") ? \
                        ns["chain", kib[s]] - alone[kib[s]] : \
                        ns[name[k], kib[s]]
                print ""
            }
        }' "$out/limit.csv"
    printf '\n**Two threads do so many times the work of one**\n\n'
    awk -F, 'BEGIN { print "| | |\n|---|---|" }
        sub(/^two_/, "") { printf "| %s | %.2f |\n", $1, $3 }' "$out/limit.csv"
    for scene in nearest trilinear uniform; do
        limit_of $scene
    done
}

# Kernels on one scene against what their loads cost. In L1: per lookup a
# cell's word; in a brick one word more, or four rows of two voxels for
# trilinear. From a copy these alone, but for every lookup. Per lit sample an
# opacity and two halves of an exponential. Replayed: the cells' and voxels'
# words at the places of this very frame.
limit_of()
{
    case $1 in
    nearest) set -- "$1" 1 part=8 ;;
    trilinear) set -- "$1" 4 part=8 filter=trilinear ;;
    uniform) set -- "$1" 1 part=8 light=uniform light_samples=256 \
        light_step=2.5 ;;
    esac
    scene=$1 words=$2
    shift 2
    for who in $(kernels) $(kernels | sed -n 's/^scalar$/loads1/p
        s/^avx2$/loads8/p; s/^avx512$/loads16/p'); do
        row "$who" "$who" "$(ours_alone cloud256)" "$(camera cloud256)" "$@"
    done | figures "limit_$scene"
    printf '\n**Kernel against its loads, %s**\n\n' "$scene"
    awk -F, -v words="$words" -f "$here/limit.awk" "$out/limit.csv" \
        "$out/limit_$scene.csv"
}
