# SPDX-License-Identifier: MIT
# Markdown of brume-bench's figures, by column name.
#   mode=peers   who, how many times as fast as the first row, error, memory
#   mode=plain   name, ratio, time, rate; head=TEXT over the names
BEGIN {
    FS = ","
    what["nano-tuned"] = "NanoVDB, tuned"
    what["nano-shipped"] = "NanoVDB, -O3, as first written"
    what["nano-leaf"] = "NanoVDB, tuned, eight voxels from one leaf"
    what["nano-leaping"] = "NanoVDB, tuned, light rays leap over nodes"
    what["nano-fp8"] = "NanoVDB Fp8, tuned"
    what["pnano"] = "PNanoVDB.h, tuned"
    what["open"] = "OpenVDB ConstAccessor"
    what["scalar"] = "brume, scalar"
    what["avx2"] = "brume, AVX2"
    what["avx2-copy"] = "brume, AVX2, copied volume"
    what["avx512-copy"] = "brume, AVX-512, copied volume"
    what["avx512"] = "brume, AVX-512"
    what["generic"] = "brume, compiler's vectors"
}
NR == 1 {
    for (i = 1; i <= NF; i++)
        at[$i] = i
    next
}
{
    line[++rows] = $0
    if ($at["lookups"] > 0)
        lookups = $at["lookups"]
}
function number(x) { return x >= 100 ? sprintf("%.0f", x) : sprintf("%.3g", x) }
function name_of(n) { return n in what ? what[n] : n }
END {
    if (mode == "peers") {
        print "| | speed | (least-most) | ms | M lookups/s | RMSE | mean |" \
            " MiB | copying, ms |"
        print "|---|---|---|---|---|---|---|---|---|"
    } else {
        printf "| %s | speed | (least-most) | ms | M lookups/s |\n", head
        print "|---|---|---|---|---|"
    }
    for (r = 1; r <= rows; r++) {
        split(line[r], f, ",")
        mine = mode == "peers" ? lookups : f[at["lookups"]]
        printf "| %s | %.2f | %.2f-%.2f | %s | %s |", name_of(f[at["name"]]),
            f[at["ratio"]], f[at["ratio_least"]], f[at["ratio_most"]],
            number(f[at["ms"]]), number(mine / f[at["ms"]] / 1000)
        if (mode == "peers")
            printf " %.3f | %+.3f | %.2f | %s |", f[at["rmse"]], f[at["mean"]],
                f[at["bytes"]] / 1048576, (f[at["prepare_ms"]] > 0) ? \
                number(f[at["prepare_ms"]]) : ""
        print ""
    }
}
