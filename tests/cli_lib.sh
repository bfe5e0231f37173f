# SPDX-License-Identifier: MIT
# What tests of a command share: `. tests/cli_lib.sh` after tests/lib.sh. Sets
# $work, a folder that goes away, and $none, $out and $err in it.
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
none=$work/none out=$work/out err=$work/err

show()
{
    echo "# status $status; left in the folder: $(ls -A "$none")"
    sed 's/^/# out: /' "$out" | head -n 5
    sed 's/^/# err: /' "$err" | head -n 5
}

# runs COMMAND...: succeeds, and says nothing on stderr
runs()
{
    "$@" >"$out" 2>"$err"
    status=$?
    [ $status -eq 0 ] && [ ! -s "$err" ] && return
    show
    return 1
}

# fails STATUS PATTERN COMMAND...: that status, one line on stderr that holds
# the pattern, nothing on stdout, no file in $none
fails()
{
    want=$1 pattern=$2
    shift 2
    rm -rf "$none" && mkdir "$none"
    "$@" >"$out" 2>"$err"
    status=$?
    [ $status -eq "$want" ] && [ "$(wc -l <"$err")" -eq 1 ] &&
        grep -q -e "$pattern" "$err" && [ ! -s "$out" ] &&
        [ -z "$(ls -A "$none")" ] && return
    show
    return 1
}
