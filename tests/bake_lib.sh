# SPDX-License-Identifier: MIT
# TAP-like lines for the tests of brume-bake: `. tests/bake_lib.sh`, with $work
# set. A check shows what its command printed when it fails.
passed=0 failed=0 skipped=0

number() { echo $((passed + failed + skipped + 1)); }
ok() { echo "ok $(number) - $1"; passed=$((passed + 1)); }
not_ok() { echo "not ok $(number) - $1"; failed=$((failed + 1)); }
skip() { echo "ok $(number) # SKIP $1"; skipped=$((skipped + 1)); }

# check TEXT COMMAND...: the command succeeds
check() {
    text=$1
    shift
    if "$@" >"$work/log" 2>&1; then ok "$text"; else
        not_ok "$text"
        sed 's/^/# /' "$work/log"
    fi
}
