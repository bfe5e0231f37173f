# SPDX-License-Identifier: MIT
# limit.csv (kind, KiB, ns per word) and a scene's figures: each kernel beside
# its loads in L1 and beside the same loads replayed.
BEGIN {
    kind["avx2"] = "gather8"
    kind["avx512"] = "gather16"
    replay["scalar"] = "loads1"
    replay["avx2"] = "loads8"
    replay["avx512"] = "loads16"
    print "| | ms | ns per lookup | loads in L1, ms | of the time |" \
        " loads replayed, ms | of the time |"
    print "|---|---|---|---|---|---|---|"
}
FNR == 1 {
    for (i = 1; i <= NF; i++)
        at[$i] = i
    next
}
NR == FNR {
    if ($2 == 16)
        ns[$1] = $3
    next
}
{
    ms[$1] = $at["ms"]
    if ($1 !~ /^loads/)
        order[++n] = $1
    lookups = $at["lookups"]
    in_bricks = $at["in_bricks"]
    lit = $at["lit"]
}
END {
    for (i = 1; i <= n; i++) {
        plain = order[i]
        copied = sub(/-copy$/, "", plain)
        loads = copied ? words * lookups : lookups + words * in_bricks
        word = (plain in kind) ? ns[kind[plain]] : ns["load"]
        near = (loads + 3 * lit) * word / 1e6
        t = ms[order[i]]
        printf "| %s | %.1f | %.2f | %.1f | %.2f |", order[i], t,
            t * 1e6 / lookups, near, near / t
        if (!copied && plain in replay)
            printf " %.1f | %.2f |\n", ms[replay[plain]],
                ms[replay[plain]] / t
        else
            print " | |"
    }
}
