# SPDX-License-Identifier: MIT
# cell.awk -v file=CSV -v column=NAME -v where="KEY=VALUE ...": prints the cell
# of that column in the one row that fits. Nothing when none does; an error when
# several do or a column is not there.
function stop(what)
{
    print "lab: " file ": " what >"/dev/stderr"
    exit 1
}
BEGIN {
    FS = ","
    if ((getline <file) < 1)
        stop("cannot be read")
    for (i = 1; i <= NF; i++)
        at[$i] = i
    n = split(where, pairs, " ")
    for (i = 1; i <= n; i++) {
        equals = index(pairs[i], "=")
        key[i] = substr(pairs[i], 1, equals - 1)
        want[i] = substr(pairs[i], equals + 1)
        if (!(key[i] in at))
            stop("there is no column '" key[i] "'")
    }
    if (!(column in at))
        stop("there is no column '" column "'")
    while ((getline <file) > 0) {
        for (i = 1; i <= n && $at[key[i]] == want[i]; i++)
            ;
        if (i > n) {
            found++
            cell = $at[column]
        }
    }
    if (found > 1)
        stop(found " rows are of " where)
    if (found)
        print cell
}
