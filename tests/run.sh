#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh [NAME...]: runs every test program and script (or those whose name
# holds NAME), prints their output, and adds up their last lines.
set -u
: "${BUILD:=build}" "${DATA:=../shared/data}"
export BUILD DATA
passed=0 failed=0 skipped=0
[ -d "$DATA" ] || echo "# REAL VOLUMES ARE NOT IN $DATA: SOME TESTS SKIP" >&2

wanted()
{
    [ "$#" -gt 1 ] || return 0
    subject=$1
    shift
    for pattern; do
        case $subject in *"$pattern"*) return 0 ;; esac
    done
    return 1
}

# run NAME COMMAND...: a program that dies without a last line has failed.
run()
{
    name=$1
    shift
    log=$BUILD/tests/$name.log
    start=$(date +%s)
    echo "# $name"
    "$@" >"$log" 2>&1
    status=$?
    grep -E '^not ok|SKIP' "$log"
    line=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$log" |
        tail -n 1)
    if [ -z "$line" ]; then
        cat "$log"
        line="0 passed, 1 failed, 0 skipped"
        echo "not ok - $name died (status $status)"
    elif [ $status != 0 ] && [ "${line#* 0 failed}" != "$line" ]; then
        line="0 passed, 1 failed, 0 skipped"
        echo "not ok - $name: status $status"
    fi
    echo "  $line ($(($(date +%s) - start)) s)"
    # shellcheck disable=SC2086
    set -- $line
    passed=$((passed + $1)) failed=$((failed + $3)) skipped=$((skipped + $5))
}

mkdir -p "$BUILD/tests"
. tests/volumes.sh
! wanted golden "$@" || run golden sh tests/golden.sh check
# shellcheck disable=SC2086
! wanted render "$@" || run render "$BUILD/tests/test_render" $volumes
# shellcheck disable=SC2086
! wanted wide "$@" || run wide "$BUILD/tests/test_wide" $volumes
for test in "$BUILD"/tests/test_*; do
    name=$(basename "$test")
    [ -x "$test" ] || continue
    case $name in *.* | test_golden | test_render | test_wide) continue ;; esac
    ! wanted "$name" "$@" || run "$name" "$test"
done
for test in tests/test_*.sh; do
    name=$(basename "$test")
    ! wanted "$name" "$@" || run "$name" sh "$test"
done
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
