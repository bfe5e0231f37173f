# SPDX-License-Identifier: MIT
# times.awk: rows of frame_times (lib.sh) out of lines NAME,MILLISECONDS. A turn
# begins with `nano`; the time of a name in a turn is the median of its lines.
function median(list, n,    i, k, v)
{
    for (i = 2; i <= n; i++) {
        v = list[i]
        for (k = i - 1; k > 0 && list[k] > v; k--)
            list[k + 1] = list[k]
        list[k + 1] = v
    }
    return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
}
function end_of_name()
{
    if (name != "") {
        if (!(name in turns))
            order[++names] = name
        ms = median(frame, frames)
        times[name, ++turns[name]] = ms
        ratios[name, turns[name]] = nano / ms
    }
    frames = 0
    name = ""
}
$1 != name || $1 == "nano" {
    end_of_name()
}
$1 == "nano" {
    nano = $2
    next
}
{
    name = $1
    frame[++frames] = $2
}
END {
    end_of_name()
    if (!nano || !names)
        exit 1
    print "name", "ratio", "ratio_least", "ratio_most", "ms"
    for (i = 1; i <= names; i++) {
        n = turns[order[i]]
        for (k = 1; k <= n; k++) {
            r[k] = ratios[order[i], k]
            t[k] = times[order[i], k]
        }
        middle = median(r, n)
        printf "%s,%.4g,%.4g,%.4g,%.3f\n", order[i], middle, r[1], r[n],
            median(t, n)
    }
}
