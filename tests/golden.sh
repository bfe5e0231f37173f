#!/bin/sh
# SPDX-License-Identifier: MIT
# golden.sh check|update: the golden hashes and pictures of all test scenes.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/volumes.sh
mkdir -p "$BUILD/golden" tests/golden
# shellcheck disable=SC2086
exec "$BUILD/tests/test_golden" "$1" tests/golden "$BUILD/golden" $volumes
