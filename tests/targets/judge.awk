# SPDX-License-Identifier: MIT
# judge.awk: what run.sh makes of result.txt files, the host's reference first.
#   mode=table    the tables of docs/TARGETS.md
#   mode=verdict  a line each: pass, fail or skip, and a text
#   mode=counts   a new counts.txt; of what did not run, the old lines
BEGIN {
    while ((getline line < golden) > 0) {
        split(line, word, " ")
        golden_hash[word[1]] = word[2]
    }
    while ((getline line < counts) > 0) {
        if (line ~ /^#/ || split(line, word, " ") != 5)
            continue
        key = word[1] " " word[3]
        old_line[++olds] = line
        old_compiler[key] = word[2]
        old_count[key] = word[4]
        old_begin[key] = word[5]
    }
    while ((getline line < limits) > 0)
        if (line !~ /^#/)
            limit_line[++limit_lines] = line
}


FNR == 1 {
    n = split(FILENAME, word, "/")
    target = word[n - 1]
    if (target != "reference")
        targets[++target_count] = target
}
$1 == "scene" {
    hash[target, $2] = $3
    count[target, $2] = $5
    begin[target, $2] = $6
    if (target == "reference") {
        scenes[++scene_count] = $2
        size_of[$2] = $4
    }
}
$1 == "passes" {
    for (i = 1; i <= 4; i++)
        passes[target, $2, i] = $(i + 2)
}
$1 == "tally" {
    view[$2] = $3
    light[$2] = $5
    rays[$2] = $6
}
$1 == "error" || $1 == "forbidden" { bad[target] = bad[target] " " $0 }
$1 == "linked" { linked[target] = 1 }
$1 == "compiler" { compiler[target] = $2 }
$1 == "flags" { flags[target] = substr($0, 7) }
$1 == "stack" { painted[target] = $2 }
$1 == "bound" { bound[target] = $2; bound_text[target] = substr($0, 7) }
$1 == "size" {
    code[target] = $2
    rodata[target] = $3
    data[target] = $4
    bss[target] = $5
}
$1 == "demo" { demo[target] = substr($0, 6) }
$1 == "demo_size" { demo_size[target] = substr($0, 11) }
$1 == "state" {
    state[target] = $2
    state_text[target] = substr($0, 8 + length($2))
}

function ratio(a, b, digits) {
    return a > 0 && b > 0 ? sprintf("%." digits "f", a / b) : "-"
}
function lookups(s) {
    return view[s] + light[s]
}

# The scene that stands for the target in the table.
function headline(t) {
    return (t, "disney_160") in hash ? "disney_160" \
        : (t, "disney_u4r") in hash ? "disney_u4r" \
        : (t, "disney_lod1") in hash ? "disney_lod1" : "block_none"
}
function light_cost(t, s) {
    u = s "_unlit"
    return (t, u) in hash ? ratio(count[t, s] - count[t, u], light[s], 1) : "-"
}

function view_cost(t, s) {
    s = s "_unlit"
    return ratio(count[t, s], view[s], 1)
}

# Letters of the scenes that have the host's hash; `!` after one that has not.
function letters(t, text, i) {
    text = ""
    for (i = 1; i <= scene_count; i++)
        if ((t, scenes[i]) in hash)
            text = text letter(i) (hash[t, scenes[i]] == \
                hash["reference", scenes[i]] ? "" : "!")
    return text == "" ? "-" : text
}
function letter(i) {
    return substr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", \
        (i - 1) % 52 + 1, 1) (i > 52 ? "'" : "")
}
function or_dash(text) {
    return text == "" || text == 0 ? "-" : text
}

# Of "...: I instructions, S bytes of stack" the number before a word.
function number_before(text, what) {
    return match(text, "[0-9]+ " what) ? substr(text, RSTART, RLENGTH) + 0 : "-"
}
function demo_table(i, t, size) {
    print ""
    print "| demo | program | asset | of flash | static RAM | stack |" \
        " of RAM | instructions per frame |"
    print "|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= target_count; i++) {
        t = targets[i]
        if (!(t in demo) || split(demo_size[t], size, " ") != 5)
            continue
        text = demo[t]
        sub(/: [0-9]+ instructions.*/, "", text)
        print "| " text " | " size[1] " | " size[2] " | " size[4] " | " \
            size[3] " | " number_before(demo[t], "bytes of stack") " | " \
            size[5] " | " number_before(demo[t], "instructions") " |"
    }
}

# Instructions per pixel of each pass of the sequences, beyond those of the
# same rays without: on one target of each kind.
function pass_table(i, s, t, size, pixels, n, name) {
    n = split("mps2-an386 mps2-an386-Os mps2-m0 mps2-m0-Os", name, " ")
    print ""
    print "| passes, instructions per pixel | " name[1] " | " name[2] " | " \
        name[3] " | " name[4] " |"
    print "|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        s = scenes[i]
        if (!((name[1], s, 1) in passes))
            continue
        split(size_of[s], size, "x")
        pixels = size[1] * size[2]
        printf "| %s", s
        for (t = 1; t <= n; t++)
            if ((name[t], s, 1) in passes)
                printf " | %.0f + %.0f + %.0f", \
                    passes[name[t], s, 2] / pixels, \
                    passes[name[t], s, 3] / pixels, \
                    passes[name[t], s, 4] / pixels
            else
                printf " | -"
        print " |"
    }
}

# Instructions per covered pixel of the scenes with lighting, on the same
# targets.
function light_table(i, s, t, n, name) {
    n = split("mps2-an386 mps2-an386-Os mps2-m0 mps2-m0-Os", name, " ")
    print ""
    print "| lighting, instructions per covered pixel | " name[1] " | " \
        name[2] " | " name[3] " | " name[4] " |"
    print "|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        s = scenes[i]
        if (s !~ /^lit_/ || !((name[1], s) in count))
            continue
        printf "| %s", s
        for (t = 1; t <= n; t++)
            printf " | %s", (name[t], s) in count ? \
                ratio(count[name[t], s], rays[s], 0) : "-"
        print " |"
    }
}

function table(i, t, s) {
    print "| target | compiler | flags | images | px | lookup | view |" \
        " light | code | rodata | data | bss | painted | bound |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= target_count; i++) {
        t = targets[i]
        s = headline(t)
        if (state[t] != "ok") {
            print "| " t " | " state[t] ": " state_text[t] " |" \
                " | | | | | | | | | | | |"
            continue
        }
        print "| " t " | " compiler[t] " | " flags[t] " | " letters(t) " | " \
            ratio(count[t, s], rays[s], 0) " | " \
            ratio(count[t, s], lookups(s), 1) " | " view_cost(t, s) " | " \
            light_cost(t, s) " | " \
            code[t] " | " rodata[t] " | " data[t] " | " bss[t] " | " \
            or_dash(painted[t]) " | " or_dash(bound[t]) " |"
    }
    print ""
    print "| image | scene | size | hash | covered px | view lookups |" \
        " light lookups |"
    print "|---|---|---|---|---|---|---|"
    for (i = 1; i <= scene_count; i++) {
        s = scenes[i]
        print "| " letter(i) " | " s " | " size_of[s] " | " \
            hash["reference", s] " | " or_dash(rays[s]) " | " \
            or_dash(view[s]) " | " or_dash(light[s]) " |"
    }
    pass_table()
    light_table()
    demo_table()
}

function say(good, text) {
    print (good ? "pass" : "fail"), text
}
function check_images(t, i, s, same, differ) {
    for (i = 1; i <= scene_count; i++) {
        s = scenes[i]
        if (!((t, s) in hash))
            continue
        if (hash[t, s] == hash["reference", s])
            same++
        else
            differ = differ ", " s " " hash[t, s]
    }
    say(same > 0 && differ == "" && bad[t] == "", t ": " same + 0 \
        " images are the host's" differ bad[t])
}
function moved(old, new) {
    return old > 0 && (new > old * 1.01 || new < old * 0.99)
}
function check_counts(t, i, s, key, worst, n) {
    for (i = 1; i <= scene_count; i++) {
        s = scenes[i]
        key = t " " s
        if (count[t, s] + 0 == 0) {
            if (old_count[key] > 0)
                worst = worst ", " s " was counted and is not"
            continue
        }
        n++
        if (!(key in old_count) && !(("reference", "disney_160") in hash))
            continue # other volumes than those of counts.txt
        if (!(key in old_count))
            worst = worst ", " s " is not in counts.txt"
        else if (old_compiler[key] != compiler[t]) {
            print "skip " t ": counts.txt is of " old_compiler[key] ", not " \
                compiler[t]
            return
        } else if (moved(old_count[key], count[t, s]))
            worst = worst ", " s " " old_count[key] " -> " count[t, s]
        else if (moved(old_begin[key], begin[t, s]))
            worst = worst ", " s " beginning " old_begin[key] " -> " \
                begin[t, s]
    }
    if (n || worst != "")
        say(worst == "", t ": " n + 0 " instruction counts within 1 %" worst)
}
function figure(t, name) {
    return name == "code" ? code[t] + rodata[t] \
        : name == "bound" ? bound[t] : name == "painted" ? painted[t] \
        : name == "lookup" ? ratio(count[t, headline(t)], \
            lookups(headline(t)), 3) \
        : name == "view" ? view_cost(t, headline(t)) \
        : name == "light" ? light_cost(t, headline(t)) \
        : name == "pixel" ? ratio(count[t, headline(t)], \
            rays[headline(t)], 3) : ""
}
function check_limits(t, i, word, value) {
    for (i = 1; i <= limit_lines; i++) {
        split(limit_line[i], word, " ")
        if (word[1] != t)
            continue
        value = figure(t, word[2])
        say(value + 0 > 0 && value + 0 <= word[3] + 0, t ": " word[2] " " \
            value ", at most " word[3])
    }
}
function verdict(i, t, wrong) {
    for (i = 1; i <= scene_count; i++)
        if (golden_hash[scenes[i]] != hash["reference", scenes[i]])
            wrong = wrong " " scenes[i]
    say(wrong == "" && scene_count > 0, "the host's " scene_count + 0 \
        " images are the golden ones" (wrong == "" ? "" : ", but not" wrong))
    for (i = 1; i <= target_count; i++) {
        t = targets[i]
        if (state[t] == "skip") {
            print "skip " t ": " state_text[t]
            continue
        }
        if (state[t] != "ok")
            print "fail " t ": " state_text[t] bad[t]
        if (state[t] != "ok")
            continue
        check_images(t)
        say(data[t] + bss[t] == 0, t ": the core has no .data and no .bss")
        if (linked[t])
            say(bad[t] == "", t ": no float, libm, heap or 64-bit division" \
                bad[t])
        if (bound_text[t] != "")
            say(bound[t] > 0, t ": stack bound " bound_text[t])
        if (bound[t] > 0 && painted[t] > 0)
            say(painted[t] <= bound[t] + 256, t ": painted stack " painted[t] \
                " is within the bound, but for the test's own frame")
        if (t in demo)
            say(demo[t] ~ /instructions/, t ": demo: " demo[t])
        check_counts(t)
        check_limits(t)
    }
}

function new_counts(i, j, t, word) {
    print "# Instructions of brume_render_rect and of brume_begin_frame, per" \
        " frame."
    print "# target compiler scene instructions begin"
    for (i = 1; i <= target_count; i++) {
        t = targets[i]
        if (state[t] != "ok") {
            for (j = 1; j <= olds; j++) {
                split(old_line[j], word, " ")
                if (word[1] == t)
                    print old_line[j]
            }
            continue
        }
        for (j = 1; j <= scene_count; j++)
            if (count[t, scenes[j]] > 0)
                print t, compiler[t], scenes[j], count[t, scenes[j]], \
                    begin[t, scenes[j]]
    }
}
END {
    if (mode == "table")
        table()
    else if (mode == "counts")
        new_counts()
    else
        verdict()
}
