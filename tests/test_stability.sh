#!/bin/sh
# SPDX-License-Identifier: MIT
# Pictures over time, where methods usually fail: ghosting, flicker and blur
# against the truth, and the bounds that are promised of them. Every figure is
# in the log.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/volumes.sh
given=
[ -z "$volumes" ] || given="disney=$BUILD/volumes/wdas_u8.brume"
fire=$DATA/embergen_fire/embergen_fire_a
if [ -f "${fire}_70.vdb" ]; then
    for i in 0 1 2 3 4; do
        "$BUILD/brume-bake" "${fire}_7$i.vdb" --grid flames --format u8 \
            -o "$BUILD/volumes/fire$i.brume" >/dev/null
        given="$given fire$i=$BUILD/volumes/fire$i.brume"
    done
fi
# shellcheck disable=SC2086
exec "$BUILD/brume-stability" --check $given
