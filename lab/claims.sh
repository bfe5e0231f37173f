# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# `. lab/claims.sh`: figures out of $out/TABLE.csv, and what is claimed of them.
# Apart from lib.sh, so that a claim may change without measuring again.

passed=0 failed=0 skipped=0

# value TABLE COLUMN KEY=VALUE...: the one cell of $out/TABLE.csv that fits, or
# `missing` when no row does; more than one is an error.
value()
{
    value_table=$1 value_column=$2
    shift 2
    value_cell=missing
    [ ! -f "$out/$value_table.csv" ] ||
        value_cell=$(awk -f lab/cell.awk -v file="$out/$value_table.csv" \
            -v column="$value_column" -v where="$*")
    echo "${value_cell:-missing}"
}

# say RESULT NAME TEXT: to stdout as TAP, and to $out/claims.csv for the page.
say()
{
    echo "$2,$1,\"$3\"" >>"$out/claims.csv"
    say_n=$((passed + failed + skipped))
    case $1 in
    holds) echo "ok $say_n - $2: $3" ;;
    skipped) echo "ok $say_n # SKIP $2" ;;
    *) echo "not ok $say_n - $2: $3" ;;
    esac
}

# holds A OP B: awk's comparison of two sums of numbers.
holds() { awk "BEGIN { exit !(($1) $2 ($3)) }"; }

# Sums may be written over several lines.
one_line() { printf %s "$1" | tr -s '\n ' '  '; }

# claim NAME A OP B TEXT: fails the laboratory when it does not hold. Skipped
# where a figure is missing and units were skipped for want of a volume.
claim()
{
    set -- "$1" "$(one_line "$2")" "$3" "$(one_line "$4")" "$5"
    case "$2 $4" in *missing*)
        if [ -s "$lab/skipped" ]; then
            skipped=$((skipped + 1))
            say skipped "$1" "$5"
        else
            failed=$((failed + 1))
            say "has no figure" "$1" "$5"
        fi
        return
        ;;
    esac
    if holds "$2" "$3" "$4"; then
        passed=$((passed + 1))
        say holds "$1" "$5 ($2 $3 $4)"
    else
        failed=$((failed + 1))
        say "does not hold" "$1" "$5 (not $2 $3 $4)"
    fi
}

# published NAME A OP B TEXT: what a paper found. Recorded for the page, which
# has to say why when it does not come out; fails nothing.
published()
{
    set -- "$1" "$(one_line "$2")" "$3" "$(one_line "$4")" "$5"
    case "$2 $4" in
    *missing*) published_result=skipped ;;
    *)
        if holds "$2" "$3" "$4"; then
            published_result="comes out"
        else
            published_result="does not come out"
        fi
        ;;
    esac
    echo "# published: $1: $5: $published_result ($2 $3 $4)"
    echo "$1,$published_result,\"$5 ($2 $3 $4)\"" >>"$out/claims.csv"
}
