# SPDX-License-Identifier: MIT
# page.awk -v dir=TABLES TEMPLATE...: the templates, one after the other, with
# their placeholders filled in from dir/*.csv. A figure that is not there, or
# that several rows could be, is an error, and so is an unknown placeholder.
#
#   {{FORMAT SUM}}      a number by printf's FORMAT. SUM: terms and + - * /
#                       between spaces, from left to right; a term is a number
#                       or [TABLE COLUMN KEY=VALUE ...]
#   {{claim NAME}}      how the claim came out
#   {{expect SUM < SUM}}     nothing; an error unless it is so, or >
#   {{expect NAME RESULT}}   the same of how a claim came out
#                       so that prose which no longer fits is found
#   {{table TABLE FORMAT}}   the whole table, whose numbers that are not whole
#                       are written by FORMAT
function stop(what)
{
    print "lab: " FILENAME ":" FNR ": " what >"/dev/stderr"
    failed = 1
    exit 1
}

function cell(text,    command, got, words, n, i, where, status)
{
    n = split(text, words, " ")
    for (i = 3; i <= n; i++)
        where = where (i > 3 ? " " : "") words[i]
    if (text in known)
        return known[text]
    if (text !~ /^[A-Za-z0-9_.= +-]+$/)
        stop("not a cell: " text)
    command = "awk -f lab/cell.awk -v file='" dir "/" words[1] \
        ".csv' -v column='" words[2] "' -v where='" where "'"
    got = ""
    command | getline got
    status = close(command)
    if (got == "" || status != 0)
        stop("there is no figure [" text "]")
    known[text] = got
    return got
}

function term(text)
{
    if (text ~ /^\[.*\]$/)
        return cell(substr(text, 2, length(text) - 2))
    if (text !~ /^-?[0-9.]+$/)
        stop("not a number: " text)
    return text
}

# Cuts the first term off `rest`.
function next_term(    text, end)
{
    sub(/^ +/, "", rest)
    end = index(rest, "]")
    if (substr(rest, 1, 1) != "[")
        end = index(rest " ", " ") - 1
    text = substr(rest, 1, end)
    rest = substr(rest, end + 1)
    sub(/^ +/, "", rest)
    return term(text)
}

function number(format, text,    sum, sign, other)
{
    rest = text
    sum = next_term()
    while (rest != "") {
        sign = substr(rest, 1, 1)
        rest = substr(rest, 2)
        other = next_term()
        if (sign == "+")
            sum += other
        else if (sign == "-")
            sum -= other
        else if (sign == "*")
            sum *= other
        else if (sign == "/")
            sum /= other
        else
            stop("not + - * /: " sign)
    }
    return sprintf(format, sum)
}

function table(name, format,    file, line, parts, n, i, text, rows)
{
    file = dir "/" name ".csv"
    while ((getline line <file) > 0) {
        n = split(line, parts, ",")
        text = text (rows ? "\n" : "") "|"
        for (i = 1; i <= n; i++)
            text = text " " (parts[i] ~ /^-?[0-9.]+(e[-+]?[0-9]+)?$/ && \
                parts[i] ~ /[.e]/ ? sprintf(format, parts[i]) : parts[i]) " |"
        if (!rows++) {
            text = text "\n|"
            for (i = 1; i <= n; i++)
                text = text "---|"
        }
    }
    close(file)
    if (rows < 2)
        stop("there is no table " file)
    return text
}

function expect(text,    sides, side)
{
    side = index(text, " < ") ? " < " : " > "
    if (split(text, sides, side) != 2) {
        sub(/^ +/, "", text)
        side = text
        sub(/ .*/, "", side)
        sub(/^[^ ]+ /, "", text)
        if (cell("claims result claim=" side) != text)
            stop("the text expects: " side " " text)
    } else if (side == " < " ? number("%.12g", sides[1]) + 0 >= \
                   number("%.12g", sides[2]) + 0 : \
               number("%.12g", sides[1]) + 0 <= \
                   number("%.12g", sides[2]) + 0)
        stop("the text expects:" text)
    return ""
}

function fill(text,    words)
{
    split(text, words, " ")
    if (words[1] == "claim")
        return cell("claims result claim=" words[2])
    if (words[1] == "expect")
        return expect(substr(text, 7))
    if (words[1] == "table")
        return table(words[2], words[3])
    if (words[1] ~ /^%[-+0-9.]*[dfgs]$/)
        return number(words[1], substr(text, length(words[1]) + 1))
    stop("not a placeholder: " text)
}

{
    line = $0
    done = ""
    while ((at = index(line, "{{")) > 0) {
        end = index(line, "}}")
        if (end < at)
            stop("{{ without }} in its line")
        done = done substr(line, 1, at - 1) \
            fill(substr(line, at + 2, end - at - 2))
        line = substr(line, end + 2)
    }
    print done line
}
END {
    exit failed
}
