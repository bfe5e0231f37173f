# SPDX-License-Identifier: MIT
# fronts.awk ALL.csv: the Pareto fronts of each volume, for each error and each
# cost: the settings than which none is both cheaper and nearer the truth.
#
# The knee is where a front bends most: the point farthest below the chord from
# its first to its last point, both axes logarithmic, so that it does not depend
# on the units. A front of fewer than three points has none.
#
# Settings are numbered by cost on the M4, those of a volume that are on any
# front alone, the same in all charts and tables.
function better(a, b, error, cost)
{
    if (value[a, cost] != value[b, cost])
        return value[a, cost] < value[b, cost]
    return value[a, error] < value[b, error]
}

# A heap would be faster; there are a few hundred.
function sort(error, cost, first, last,    i, k, one)
{
    for (i = first; i <= last; i++)
        order[i] = i
    for (i = first + 1; i <= last; i++) {
        one = order[i]
        for (k = i; k > first && better(one, order[k - 1], error, cost); k--)
            order[k] = order[k - 1]
        order[k] = one
    }
}

function knee_of(n, error, cost,    i, x, y, dx, dy, far, most, best)
{
    dx = log(value[front[n], cost] / value[front[1], cost])
    dy = log(value[front[n], error] / value[front[1], error])
    most = 0
    best = 0
    for (i = 2; i < n; i++) {
        x = log(value[front[i], cost] / value[front[1], cost])
        y = log(value[front[i], error] / value[front[1], error])
        far = (x * dy - y * dx) / sqrt(dx * dx + dy * dy)
        if (far > most) {
            most = far
            best = i
        }
    }
    return best
}

function find_front(error, cost, first, last,    i, n, least, knee)
{
    sort(error, cost, first, last)
    n = 0
    for (i = first; i <= last; i++)
        if (value[order[i], cost] != "" && \
            (n == 0 || value[order[i], error] < least)) {
            front[++n] = order[i]
            least = value[order[i], error]
        }
    knee = n > 2 ? knee_of(n, error, cost) : 0
    for (i = 1; i <= n; i++) {
        on[front[i]] = on[front[i]] " " error "/" cost
        found[++found_count] = front[i] SUBSEP error SUBSEP cost SUBSEP \
            (i == knee)
    }
}

function number(first, last,    i, n)
{
    sort("rmse31", "m4", first, last)
    for (i = first; i <= last; i++)
        if (order[i] in on)
            number_of[order[i]] = ++n
}

function finish_volume(first, last,    c, e, costs, errors)
{
    split("rmse31 flip31 rmse3 flip3", errors, " ")
    split("m4 time", costs, " ")
    for (c = 1; c <= 2; c++)
        for (e = 1; e <= 4; e++)
            if (value[first, costs[c]] != "")
                find_front(errors[e], costs[c], first, last)
    number(first, last)
}

BEGIN {
    FS = ","
}
NR == 1 {
    for (i = 1; i <= NF; i++)
        name[i] = $i
    next
}
$1 != volume {
    if (rows)
        finish_volume(first, rows)
    volume = $1
    first = rows + 1
}
{
    text[++rows] = $0
    for (i = 11; i <= NF; i++)
        value[rows, name[i]] = $i == "" ? "" : $i + 0
}
END {
    OFS = ","
    finish_volume(first, rows)
    print "volume", "number", "setting", "error", "cost", "x", "y", "knee"
    for (i = 1; i <= found_count; i++) {
        split(found[i], f, SUBSEP)
        split(text[f[1]], parts, ",")
        print parts[1], number_of[f[1]], parts[2], f[2], f[3], \
            value[f[1], f[3]], value[f[1], f[2]], f[4]
    }
}
