# SPDX-License-Identifier: MIT
# shellcheck shell=sh disable=SC2154
# Where methods fail: the units of lab/atlas, one each. Read by run.sh.

atlas_list() { sh lab/atlas/run.sh list; }

atlas_run()
{
    atlas_said=$(sh lab/atlas/run.sh "$1" "$lab") || return 1
    case $atlas_said in SKIP*) return 3 ;; esac
    cat "$lab/atlas/$1.csv"
}

## Claims ##

# What a unit claims of its table is in its own words.
atlas_check()
{
    atlas_list >"$lab/atlas_units"
    while read -r atlas_unit; do
        sh lab/atlas/run.sh check "$atlas_unit" "$lab" \
            >"$lab/atlas_said" || :
        while read -r atlas_line; do
            atlas_text=$(echo "${atlas_line#*- }" | tr '"' "'")
            case $atlas_line in
            *"# SKIP"*)
                skipped=$((skipped + 1))
                say skipped "atlas_$atlas_unit" "no volume"
                ;;
            "ok "*)
                passed=$((passed + 1))
                say holds "atlas_$atlas_unit" "$atlas_text"
                ;;
            *)
                failed=$((failed + 1))
                say "does not hold" "atlas_$atlas_unit" "$atlas_text"
                ;;
            esac
        done <"$lab/atlas_said"
    done <"$lab/atlas_units"
}

# The section: its text, and a row and a picture for each unit.
atlas_page()
{
    mkdir -p "$out/atlas"
    cp "$lab"/atlas/*.png "$out/atlas/"
    cat lab/page/atlas.md
    awk -F, '
        NR == 1 { next }
        $1 != unit {
            unit = $1
            printf "%s\n| ![%s](atlas/%s.png) | **%s** | %s | ", \
                (NR > 2 ? " |" : ""), unit, unit, $2, $3
            n = 0
        }
        {
            kind = $5
            measure = $7
            gsub("_", " ", kind)
            gsub("_", " ", measure)
            printf "%s%s: %s %.3g %s; %s: %.3g", n++ ? "<br>" : "", $4, kind, \
                $6, measure, $9, $10
        }
        END { print " |" }' "$out/atlas.csv"
}
