# SPDX-License-Identifier: MIT
# The goals, what this run reached, and whether that is met: from the figures
# of peers on the 256^3 cloud, of the big cloud and of threads.
BEGIN { FS = "," }
FNR == 1 {
    for (i = 1; i <= NF; i++)
        at[$i] = i
    group = FILENAME
    sub(".*/", "", group)
    sub("[.]csv$", "", group)
    next
}
$1 == "two_chain_alone" { arithmetic = $3 }
group == "limit" { next }
{
    who = $at["name"]
    ratio[group, who] = $at["ratio"]
    error[group, who] = $at["rmse"]
    rate[group, who] = $at["lookups"] / $at["ms"]
    if (who ~ /^(scalar|generic|avx2|avx512)$/)
        widest[group] = who
}
function goal(text, reached, least, note) {
    if (reached == "")
        reached = "| not measured here"
    else
        reached = sprintf("%.2f | %s%s", reached,
            reached >= least ? "met" : "MISSED", note)
    printf "| %s | %s | %s |\n", text, least, reached
}
# The better of a kernel and the same on a copied volume.
function peer(scene, text, kernel, least, g, note, best, leaf) {
    g = "peers_cloud256_" scene
    best = ratio[g, kernel]
    if (ratio[g, kernel "-copy"] > best) {
        best = ratio[g, kernel "-copy"]
        kernel = kernel "-copy"
    }
    if (error[g, kernel] > 0.35)
        note = ", but RMSE above 0.35"
    leaf = ratio[g, "nano-leaf"]
    if (leaf > 0 && best != "")
        note = note sprintf("; %.2f against eight voxels from one leaf",
            best / leaf)
    goal(text ", " kernel, best, least, note)
}
function big(copied, who, a, b) {
    who = widest["peers_cloud256_nearest"] copied
    a = rate["peers_cloud256_nearest", who]
    b = rate["peers_big_nearest", who]
    goal("big cloud, lookups/s against the 256^3 cloud, " who,
        a > 0 && b > 0 ? b / a : "", 0.6)
}
END {
    print "| times as fast, one thread, 256^3 | goal | here | |"
    print "|---|---|---|---|"
    n = split("avx512 avx2 scalar", kernel, " ")
    split("12 8 2.2", nearest, " ")
    split("16 10 3", trilinear, " ")
    for (i = 1; i <= n; i++)
        peer("nearest", "nearest, ten light samples, against tuned NanoVDB",
            kernel[i], nearest[i])
    for (i = 1; i <= n; i++)
        peer("trilinear", "trilinear, the same", kernel[i], trilinear[i])
    peer("uniform", "256 uniform light samples, against NanoVDB that stops " \
        "at the box", widest["peers_cloud256_uniform"], 15)
    big("")
    big("-copy")
    goal("two threads against one", ratio["threads", "threads-2"], 1.9,
        sprintf("; two threads of plain arithmetic do %.2f times the work",
        arithmetic))
}
