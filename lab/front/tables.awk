# SPDX-License-Identifier: MIT
# tables.awk -v dir=TABLES ALL.csv FRONTS.csv: tables of the page.
#
#   front_VOLUME.csv   every setting that is on a front, with its number
#   front_budget.csv   of each volume and cost the best within a budget, at
#                      frame 31 and at frame 3
#   front_share.csv    how many points of the fronts of RMSE at frame 31 by
#                      the M4's cost have what: all of them, those below 2000
#                      instructions per pixel, to 10000, and above; and of
#                      those at frame 3

# Which fronts a point is on: R of RMSE and F of FLIP at frame 31, r and f at
# frame 3; * its knee.
function write_volume(volume, n,    file, i, key)
{
    file = dir "/front_" volume ".csv"
    print "no.", "format", "lookup", "light", "step", "noise", "temporal", \
        "spatial", "rays", "RMSE 31", "FLIP 31", "RMSE 3", "FLIP 3", \
        "M4", "time", "on M4's", "on time's" >file
    for (i = 1; i <= n; i++) {
        key = numbered[volume, i]
        print i, parts[key], figure[key, "rmse31"], figure[key, "flip31"], \
            figure[key, "rmse3"], figure[key, "flip3"], \
            sprintf("%.0f", figure[key, "m4"]), figure[key, "time"], \
            on[key, "m4"], on[key, "time"] >file
    }
    close(file)
}

# The last point of a front that costs no more.
function best(volume, error, cost, budget,    i, key, found)
{
    for (i = 1; i <= points[volume, error, cost]; i++) {
        key = point[volume, error, cost, i]
        if (figure[key, cost] <= budget)
            found = key
    }
    return found
}

function name_of(key)
{
    return substr(key, index(key, ",") + 1)
}

function write_budgets(    file, v, c, b, n, budget, key, early)
{
    file = dir "/front_budget.csv"
    print "volume", "cost", "budget", "number", "setting", "rmse", "flip", \
        "number3", "setting3", "rmse3", "flip3" >file
    for (v = 1; v <= volumes; v++)
        for (c = 1; c <= 2; c++) {
            n = split(c == 1 ? "500 1000 2000 5000 10000 20000" : \
                "0.003 0.01 0.03 0.1", budget, " ")
            for (b = 1; b <= n; b++) {
                key = best(volume[v], "rmse31", cost_of[c], budget[b])
                early = best(volume[v], "rmse3", cost_of[c], budget[b])
                if (key == "")
                    continue
                print volume[v], cost_of[c], budget[b], number[key], \
                    name_of(key), figure[key, "rmse31"], \
                    figure[key, "flip31"], number[early], name_of(early), \
                    figure[early, "rmse3"], figure[early, "flip3"] >file
            }
        }
    close(file)
}

function write_shares(    file, k)
{
    file = dir "/front_share.csv"
    print "what", "all", "cheap", "middle", "dear", "early" >file
    for (k = 1; k <= shares; k++)
        print share[k], count[share[k]] + 0, count[share[k], "cheap"] + 0, \
            count[share[k], "middle"] + 0, count[share[k], "dear"] + 0, \
            count[share[k], "early"] + 0 >file
    close(file)
}

# Without a band: of a setting that may be on no front, so that 0 is a figure.
function add_share(what, band)
{
    if (!(what in known)) {
        known[what] = 1
        share[++shares] = what
    }
    if (band != "")
        count[what, band]++
    if (band != "" && band != "early")
        count[what]++
}

function add_shares(key, band,    n, i, word)
{
    add_share("points", band)
    n = split(parts[key], word, ",")
    for (i = 1; i <= n; i++)
        add_share(part_name[i] "-" word[i], band)
}

BEGIN {
    FS = OFS = ","
    split("format lookup light step noise temporal spatial rays", part_name, \
        " ")
    cost_of[1] = "m4"
    cost_of[2] = "time"
}
FNR == 1 {
    file_number++
    for (i = 1; i <= NF; i++)
        name[i] = $i
    next
}
file_number == 1 {
    key = $1 OFS $2
    for (i = 11; i <= NF; i++)
        figure[key, name[i]] = $i
    for (i = 3; i <= 10; i++)
        parts[key] = parts[key] (i > 3 ? OFS : "") $i
    add_shares(key, "")
    next
}
{
    key = $1 OFS $3
    if (!($1 in seen)) {
        seen[$1] = 1
        volume[++volumes] = $1
    }
    number[key] = $2
    numbered[$1, $2] = key
    if ($2 > most[$1])
        most[$1] = $2
    point[$1, $4, $5, ++points[$1, $4, $5]] = key
    mark = $4 ~ /31$/ ? toupper(substr($4, 1, 1)) : substr($4, 1, 1)
    on[key, $5] = on[key, $5] (on[key, $5] ? " " : "") mark ($8 ? "*" : "")
    if ($4 == "rmse31" && $5 == "m4")
        add_shares(key, $6 < 2000 ? "cheap" : $6 < 10000 ? "middle" : "dear")
    if ($4 == "rmse3" && $5 == "m4")
        add_shares(key, "early")
}
END {
    for (v = 1; v <= volumes; v++)
        write_volume(volume[v], most[volume[v]])
    write_budgets()
    write_shares()
}
