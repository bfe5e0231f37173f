# SPDX-License-Identifier: MIT
# TAP-like lines for shell tests: `. tests/lib.sh`, then check, skip, finish.
passed=0 failed=0 skipped=0

# check NAME COMMAND...: ok when the command succeeds.
check()
{
    check_name=$1
    shift
    if "$@"; then
        passed=$((passed + 1))
        echo "ok $((passed + failed + skipped)) - $check_name"
    else
        failed=$((failed + 1))
        echo "not ok $((passed + failed + skipped)) - $check_name"
    fi
}

skip()
{
    skipped=$((skipped + 1))
    echo "ok $((passed + failed + skipped)) # SKIP $1"
}

finish()
{
    echo "$passed passed, $failed failed, $skipped skipped"
    [ "$failed" = 0 ]
    exit
}
