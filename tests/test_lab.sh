#!/bin/sh
# SPDX-License-Identifier: MIT
# shellcheck disable=SC2317
# The laboratory's tools: brume-lab measures what brume render and compare do,
# bad input leaves nothing, units resume and shard, and the page refuses figures
# that are not there.
set -u
: "${BUILD:=build}"
. tests/lib.sh
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
trap 'exit 1' INT TERM
lab=$BUILD/brume-lab
volume=$dir/block.brume
"$BUILD/brume-cloud" --type sphere --size 24 -o "$dir/block.vdb" >/dev/null &&
    "$BUILD/brume-bake" "$dir/block.vdb" -o "$volume" >/dev/null || exit 1
scene="--set size=40x30 --set background=0 --set jitter=both --set noise=white"

## Measures ##

# shellcheck disable=SC2086
"$BUILD/brume" render "$volume" $scene --set temporal=ema --frames 0:3 \
    -o "$dir/f%d.pfm"
# shellcheck disable=SC2086
"$BUILD/brume" render "$volume" $scene --set step=0.25 -o "$dir/truth.pfm"
# shellcheck disable=SC2086
"$lab" sequence "$volume" $scene --set temporal=ema --frames 0:3 \
    --reference "truth=$dir/truth.pfm" --region "left=0,0,0.5,1" \
    --picture "$dir/last.pfm" --mean "$dir/mean.pfm" --column a=b \
    >"$dir/rows.csv"

# Frame 3: the same numbers, in 1/255 there.
same_rmse()
{
    "$BUILD/brume" compare "$dir/truth.pfm" "$dir/f3.pfm" |
        awk -F= -v row="$(grep '^b,3,truth,all,' "$dir/rows.csv")" '
            BEGIN { split(row, cell, ",") }
            # Five digits there.
            $1 == "rmse" { good = ($2 / 255 / cell[5] - 1) ^ 2 < 1e-4 ^ 2 }
            END { exit !good }'
}
check "brume-lab draws what brume render does" \
    cmp "$dir/f3.pfm" "$dir/last.pfm"
check "and measures what brume compare does" same_rmse
check "a row for each frame and region, behind a head" \
    [ "$(wc -l <"$dir/rows.csv")" = 9 ]
check "a picture that is there gives the row of the frame" \
    [ "$("$lab" picture "$dir/f3.pfm" --reference "truth=$dir/truth.pfm" |
        sed -n 2p | cut -d, -f 4-9)" = \
    "$(grep '^b,3,truth,all,' "$dir/rows.csv" | cut -d, -f 5-10)" ]
"$lab" picture "$dir/f3.pfm" --reference "self=$dir/f3.pfm" >"$dir/self.csv"
check "no error to itself" grep -q '^0,self,all,0,0,0,inf,0,0,$' "$dir/self.csv"

"$lab" picture "$dir/f3.pfm" --flip --reference "self=$dir/f3.pfm" |
    sed -n 2p >"$dir/self.csv"
check "nor FLIP" grep -q ',0$' "$dir/self.csv"
# shellcheck disable=SC2086
"$lab" sequence "$volume" $scene --set temporal=ema --frames 0:3 --only 1 \
    --only 3 --flip --reference "truth=$dir/truth.pfm" >"$dir/only.csv"
check "rows of the frames that are named" \
    [ "$(cut -d, -f 1 "$dir/only.csv" | tr '\n' ' ')" = "frame 1 3 " ]
check "the same but for FLIP" \
    [ "$(sed 's/,[^,]*$//; s/^3/b,3/' "$dir/only.csv" | tail -n 1)" = \
    "$(grep '^b,3,truth,all,' "$dir/rows.csv")" ]

## For targets ##

# shellcheck disable=SC2086
"$lab" pack "$volume" $scene --frames 0:1 >"$dir/record"
check "a record begins with its name, its size and its frames" \
    [ "$(od -A n -t u4 -N 12 "$dir/record" | tr -s ' ')" = \
    " $((0x54464c42)) $(wc -c <"$dir/record") 2" ]
## Frames over time ##

# shellcheck disable=SC2086
draw() { "$lab" sequence "$volume" $scene "$@"; }
draw --frames 0:3 --cumulative --picture "$dir/so_far.pfm" \
    --mean "$dir/mean.pfm" && draw --frames 0:5 --cycle 3 --picture \
    "$dir/cycle.pfm" && draw --frames 2:2 --picture "$dir/two.pfm"
check "the mean so far is the mean at the end" \
    cmp "$dir/so_far.pfm" "$dir/mean.pfm"
check "of a cycle of 3, frame 5 is frame 2" cmp "$dir/cycle.pfm" "$dir/two.pfm"
draw --frames 2:2 --reference "self=$dir/two.pfm" --spectrum "$dir/zero" \
    >/dev/null
draw --frames 0:1 --reference "truth=$dir/truth.pfm" --column a=b \
    --spectrum "$dir/some" >/dev/null
check "no power where nothing is wrong" [ \
    "$(sed 1d "$dir/zero.csv" | cut -d, -f 2 | sort -u)" = 0 ]
check "16 bands of it" [ "$(grep -c '^b,0' "$dir/some.csv")" = 16 ]
check "and a picture" [ -s "$dir/some.png" ]

## What papers do ##

"$BUILD/brume-bake" "$dir/block.vdb" -o "$dir/again.brume" \
    --dump-float "$dir/voxels.float" >/dev/null
view="--set size=40x30 --set fov=40 --set eye=60,20,60 --set target=0,0,0
    --set step=1 --set sun=60,30
    --set density_scale=0.2 --set light_density_scale=0.2 --set background=0
    --set light=log --set light_samples=4 --set light_step=1
    --set jitter=none --set filter=trilinear --set min_density=0
    --set min_transmittance=0.01"
# double PROGRAM OUT [OPTION]...
double()
{
    double_out=$dir/$2.pfm
    double_program=$BUILD/brume-$1
    shift 2
    # shellcheck disable=SC2086
    "$double_program" "$dir/voxels.float" $view "$@" -o "$double_out"
}
# More or less light, or lookups of a kind, than `plain`.
mean_of() { "$lab" picture "$dir/$1.pfm" --reference "a=$dir/plain.pfm" |
    awk -F, 'NR == 2 { print $5 }'; }
more() { awk "BEGIN { exit !($1 > $2) }"; }
count() { sed -n "s/^$1=//p" "$dir/$2.txt"; }
double reference exact >/dev/null
for way in plain euler all-lit adaptive; do
    option=--$way
    [ $way != plain ] || option=
    # shellcheck disable=SC2086
    double papers $way $option >"$dir/$way.txt"
done
check "brume-papers is brume-reference" cmp "$dir/exact.pfm" "$dir/plain.pfm"
check "Euler's steps are brighter" more "$(mean_of euler)" 0
check "light for what is empty changes nothing" \
    cmp "$dir/all-lit.pfm" "$dir/plain.pfm"
check "and costs" more "$(count light all-lit)" "$(count light plain)"
check "steps that adapt look up less" \
    more "$(count view plain)" "$(count view adaptive)"

## Bad input ##

# refuses WORDS ARGUMENT...: status 2, one line with the words, no rows.
refuses()
{
    refuses_words=$1
    shift
    "$lab" "$@" >"$dir/out" 2>"$dir/err"
    [ $? = 2 ] && [ ! -s "$dir/out" ] && [ "$(wc -l <"$dir/err")" = 1 ] &&
        grep -q -- "$refuses_words" "$dir/err"
}
ref=truth=$dir/truth.pfm
check "no command" refuses "commands are"
check "no volume" refuses "no volume" sequence
check "nothing to do" refuses "no --reference" sequence "$volume"
check "unknown key" refuses "unknown key" sequence "$volume" --set foo=1
check "region outside" refuses "fractions" sequence "$volume" \
    --region a=0,0,2,1
check "region without a pixel" refuses "region a: no pixel" picture \
    "$dir/truth.pfm" --reference "$ref" --region a=0.5,0.5,0.001,0.001
check "reference of another size" refuses "40 x 30" sequence "$volume" \
    --set size=41x30 --set background=0 --reference "$ref"
check "no such reference" refuses "gone.pfm" sequence "$volume" \
    --reference "a=$dir/gone.pfm"
check "a comma in a column" refuses "without commas" sequence "$volume" \
    --column "a=b,c"
check "frames backwards" refuses "first to the last" sequence "$volume" \
    --frames 3:1
check "light that is not packed" refuses "not packed" pack "$volume" \
    --set octaves=2

## Cells and pages ##

cells()
{
    awk -f lab/cell.awk -v file="$dir/t.csv" -v column="$1" -v where="$2" \
        2>"$dir/err"
}
page() { awk -v dir="$dir" -f lab/page.awk "$dir/p.md" 2>"$dir/err"; }
page_of() { echo "$1" >"$dir/p.md" && page; }
printf 'name,x,y\na,1,2\nb,3,4\nb,5,4.5\n' >"$dir/t.csv"
check "a cell" [ "$(cells y "name=b x=5")" = 4.5 ]
check "no cell" [ -z "$(cells y name=c)" ]
check "two cells are an error" eval '! cells y name=b'
check "no such column is an error" eval '! cells z name=a'
check "figures are filled in" [ "$(page_of \
    'is {{%.2f [t x name=a] + 3 / [t y name=a]}}.')" = "is 2.00." ]
check "a missing figure fails" eval "! page_of '{{%.2f [t x name=c]}}'"
check "an unknown placeholder fails" eval "! page_of '{{moon}}'"
check "what the text expects" [ -z "$(page_of '{{expect [t x name=a] < 2}}')" ]
check "and does not get fails" eval \
    "! page_of '{{expect [t x name=a] > 2}}' >/dev/null"

## The front ##

# Six settings of one volume: b is dearer and worse than a, e costs what d does.
# The knee is where the front is farthest below its chord, at c.
{
    echo volume,setting,format,lookup,light,step,noise,temporal,spatial,rays,\
rmse3,flip3,rmse31,flip31,m4,time
    for row in a,100,1 b,200,1.5 c,200,0.1 d,1000,0.05 e,1000,0.06 f,9999,0.01
    do
        echo "$row" | awk -F, -v OFS=, '{
            print "v", $1 "-1-2-3-4-5-6-7", $1, 1, 2, 3, 4, 5, 6, 7, $3, $3, \
                $3, $3, $2, ""
        }'
    done
} >"$dir/all.csv"
awk -f lab/front/fronts.awk "$dir/all.csv" >"$dir/fronts.csv"
check "the front, numbered, and its knee" \
    [ "$(awk -F, '$4 == "rmse31" { printf "%s%s%s ", $2, substr($3, 1, 1), \
        $8 ? "*" : "" }' "$dir/fronts.csv")" = "1a 2c* 3d 4f " ]
check "none of a cost that was not measured" \
    [ "$(grep -c ,time, "$dir/fronts.csv")" = 0 ]

## Units ##

units() { BUILD=$BUILD sh lab/run.sh "$@" 2>/dev/null; }
units list | cut -d ' ' -f 1 | sort >"$dir/all"
for i in 1 2 3; do
    units --shard $i/3 list
done | cut -d ' ' -f 1 | sort >"$dir/shards"
check "units have names" [ -s "$dir/all" ]
check "none twice" [ -z "$(uniq -d "$dir/all")" ]
check "three shards have each once" cmp "$dir/all" "$dir/shards"
check "no shard 4 of 3" eval '! units --shard 4/3 list'
check "no such unit" eval '! units unit rq1/moon'
finish
