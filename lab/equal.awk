# SPDX-License-Identifier: MIT
# equal.awk -v measure=COLUMN TIMES ERRORS: of 8 dithered steps, how many
# undithered ones have the same error, and how many times as fast they are;
# experiment 4. Columns: scene noise blur, the measure, then `steps`, `worth`
# (exact, or a bound: least, most), `speed`.
function between(a, b, share) { return exp(log(a) + share * log(b / a)) }

# Sets `equal` and `cost` to what has the error: steps, and their ms if known.
function find(scene, error,    i, n, share)
{
    n = counts[scene]
    bound = "exact"
    for (i = 1; i < n && error_of[scene, i + 1] > error; i++)
        ;
    if (i == n || error_of[scene, 1] < error) {
        i = i == n ? n : 1
        bound = i == n ? "least" : "most"
        equal = steps[scene, i]
        cost = ms[scene, "none", "none", equal]
        return
    }
    share = log(error / error_of[scene, i]) / log(error_of[scene, i + 1] / \
        error_of[scene, i])
    equal = between(steps[scene, i], steps[scene, i + 1], share)
    cost = 0
    if (ms[scene, "none", "none", steps[scene, i]])
        cost = between(ms[scene, "none", "none", steps[scene, i]], \
            ms[scene, "none", "none", steps[scene, i + 1]], share)
}
FNR == 1 {
    files++
    for (i = 1; i <= NF; i++)
        at[$i] = i
    next
}
files == 1 {
    ms[$1, $2, $3, $4] = $at["ms"]
    next
}
$2 == "none" && $3 == "none" {
    i = ++counts[$1]
    steps[$1, i] = $4
    error_of[$1, i] = $at[measure]
}
$2 != "none" && $4 == 8 {
    rows[++n] = $1 "," $2 "," $3
    wanted[n] = $at[measure]
}
END {
    print "scene", "noise", "blur", measure, "steps", "worth", "speed"
    for (k = 1; k <= n; k++) {
        split(rows[k], key, ",")
        find(key[1], wanted[k])
        mine = ms[key[1], key[2], key[3], 8]
        print rows[k], wanted[k], equal, bound, mine ? cost / mine : ""
    }
}
