#!/bin/sh
# SPDX-License-Identifier: MIT
# `make demo`: a cloud (or $VDB), baked, pictures of it in $BUILD/demo and a
# short film; at the end, where the time went.
set -eu
: "${BUILD:=build}" "${VDB:=}"
out=$BUILD/demo
mkdir -p "$out"
times=$out/times.txt
: >"$times"

# draw FILE VOLUME OPTIONS...
draw()
{
    file=$out/$1 volume=$2
    shift 2
    echo "drawing $file"
    "$BUILD/brume" render "$volume" "$@" --profile -o "$file" \
        2>"$out/profile.txt" || {
        cat "$out/profile.txt" >&2
        exit 1
    }
    row=$(basename "${file%.*}")
    sed -n -e '/^ms /p' -e "s/^all /$row /p" "$out/profile.txt" >>"$times"
    pictures="$pictures
  $file"
}

# The tables of all pictures as one.
report()
{
    echo "milliseconds by pass, all threads together; the march's share of busy:"
    awk '
    /^ms / && NR > 1 { next }
    /^ms / {
        for (i = 2; i < NF; i++) column[$i] = i
        $1 = ""
    }
    {
        line = sprintf("%-28s", $1)
        for (i = 2; i <= NF; i++) line = line sprintf(" %8s", $i)
        print line
        for (i = 2; i < NF; i++) sum[i] += $i
        last = NF
    }
    END {
        line = sprintf("%-28s", "all")
        for (i = 2; i < last; i++) line = line sprintf(" %8.2f", sum[i])
        printf "%s %7.1f%%\n", line,
            100 * sum[column["march"]] / sum[column["busy"]]
    }' "$times"
}

pictures=
if [ -n "$VDB" ]; then
    name=$(basename "${VDB%.*}")
    "$BUILD/brume-bake" "$VDB" -o "$out/$name.brume"
    draw "$name.png" "$out/$name.brume" --set size=1280x720
    draw "${name}_low_sun.png" "$out/$name.brume" --set size=1280x720 \
        --set sun=-100,8 --set background=0.045,0.06,0.11
else
    name=cumulus
    "$BUILD/brume-cloud" -o "$out/cumulus.vdb" --size 256
    "$BUILD/brume-bake" "$out/cumulus.vdb" -o "$out/cumulus.brume"
    draw cumulus.png "$out/cumulus.brume" --scene scenes/cumulus.scene
    draw cumulus_low_sun.png "$out/cumulus.brume" \
        --scene scenes/cumulus_low_sun.scene
    draw cumulus_sky.png "$out/cumulus.brume" \
        --scene scenes/cumulus_sky.scene
    draw cumulus_panel.png "$out/cumulus.brume" \
        --scene scenes/panel.scene --pixels l1
    draw cumulus_default.png "$out/cumulus.brume"
fi
draw "${name}_day.apng" "$out/$name.brume" --frames 0:47 \
    --path scenes/day.path --set size=320x180 --set fov=31
echo "pictures:$pictures"
report
echo "try:
  $BUILD/brume render $volume --set sun=60,20 -o cloud.png
  $BUILD/brume render $volume --frames 0:47 --path scenes/day.path -o day.y4m
  $BUILD/brume info $volume
  sh scenes/composed.sh    # volumes and fog among solid things"
