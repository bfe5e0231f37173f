# SPDX-License-Identifier: MIT
# Read by run.sh: how long brume render takes to the first ray of a volume,
# beside reading its file once.

part_start()
{
    cloud cloud512 --size 512
    say start
    file=$volumes/cloud512.brume
    : >"$out/start.txt"
    cat "$file" >/dev/null # in the system's cache from here on
    n=0
    while [ $n -lt "$RUNS" ]; do
        n=$((n + 1))
        # As much as a program must do that reads it: into one buffer.
        dd if="$file" of=/dev/null bs=16M 2>&1 |
            sed -n 's/.* copied, \([0-9.e-]*\) s.*/read \1/p'
        "$BUILD/brume" render "$file" --threads 1 --kernel scalar \
            --set size=1x1 --profile -o "$out/start.ppm" 2>&1 |
            awk '/^all / {
                printf "open %.6f\nwhole %.6f\n", ($2 + $3) / 1000, $13 / 1000
            }'
    done >"$out/start.txt"
    printf '\n**Cloud of 512^3, from its file to the first ray**\n\n'
    echo "| | ms, median | least | most |"
    echo "|---|---|---|---|"
    start_row read "reading its $(wc -c <"$file") bytes once, on the clock"
    start_row open "mapping, checking, tables of the frame; processor time"
    start_row whole "the same, one ray, and the picture written, on the clock"
}

# start_row KIND TITLE
start_row()
{
    awk -v kind="$1" '$1 == kind { print $2 * 1000 }' "$out/start.txt" |
        sort -g | awk -v title="$2" '{ v[NR] = $1 } END {
            printf "| %s | %.2f | %.2f | %.2f |\n", title,
                v[int((NR + 1) / 2)], v[1], v[NR]
        }'
}
