#!/bin/sh
# SPDX-License-Identifier: MIT
# The stability atlas: a unit runs alone and what it claims holds; one that
# fails, or is no unit, leaves nothing. `make lab-quick` runs all of them.
set -u
: "${BUILD:=build}" "${DATA:=../shared/data}"
export BUILD DATA
. tests/lib.sh
. tests/cli_lib.sh
run=lab/atlas/run.sh
columns=unit,method,scene,setting,metric,value,unit_of_metric,truth,remedy,\
remedy_value

# tells FILE: adds its ok and not ok lines to this test's
tells()
{
    while read -r line; do
        case $line in
        *"# SKIP"*) skip "${line#*SKIP }" ;;
        "ok "*) check "${line#* - }" true ;;
        *) check "${line#* - }" false ;;
        esac
    done <"$1"
}

# is_table UNIT: one header, rows of ten fields that are all there
is_table()
{
    [ "$(head -n 1 "$work/atlas/$1.csv")" = "$columns" ] &&
        awk -F, -v unit="$1" 'NF != 10 || (NR > 1 && $1 != unit) { bad = 1 }
            { for (i = 1; i <= NF; i++) if ($i == "") bad = 1 }
            END { exit bad || NR < 2 }' "$work/atlas/$1.csv"
}

# is_small UNIT: a picture of a few kilobytes
is_small()
{
    [ -s "$work/atlas/$1.png" ] &&
        [ "$(wc -c <"$work/atlas/$1.png")" -lt 40000 ]
}

refused()
{
    "$@" >"$out" 2>"$err"
    status=$?
    [ $status -eq 2 ] && [ "$(wc -l <"$err")" -eq 1 ] && [ ! -e "$none/atlas" ]
}

mkdir "$none"
check "refused: no unit of that name" refused sh $run nothing "$none"
check "refused: no folder" refused sh $run banding
check "refused: check without a folder" refused sh $run check banding
check "nothing to check" grep -q SKIP - <<END
$(sh $run check banding "$none")
END
check "a program that is missing" sh -c "! BUILD=$none sh $run banding $none \
2>/dev/null && [ -z \"\$(find $none -type f)\" ]"

for unit in banding real_cloud_log few_levels; do
    if ! sh $run "$unit" "$work" >"$out" 2>"$err"; then
        check "$unit: $(cat "$err")" false
        continue
    fi
    if grep -q "^SKIP" "$out"; then
        skip "$(sed -n 's/^SKIP //p' "$out")"
        continue
    fi
    check "$unit: a table" is_table "$unit"
    check "$unit: a picture" is_small "$unit"
    sed "s/^/# /" "$work/atlas/$unit.csv"
    sh $run check "$unit" "$work" >"$out"
    tells "$out"
done
check "nothing else is left" \
    [ -z "$(find "$work/atlas" -type f ! -name '*.csv' ! -name '*.png')" ]
finish
