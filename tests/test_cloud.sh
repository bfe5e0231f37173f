#!/bin/sh
# SPDX-License-Identifier: MIT
# brume-cloud: every type bakes, lies in its box, and does not depend on the
# number of threads; the analytic shapes hold what they should; bad options and
# places get one line and leave nothing behind.
set -eu
: "${BUILD:=build}"
. tests/lib.sh
out=$BUILD/cloud
rm -rf "$out"
mkdir -p "$out/none"

# make NAME OPTIONS...: a cloud and what `brume info` says of it
make_cloud()
{
    name=$1
    shift
    "$BUILD/brume-cloud" -o "$out/$name.vdb" "$@" >/dev/null &&
        "$BUILD/brume-bake" "$out/$name.vdb" -o "$out/$name.brume" \
            >/dev/null 2>&1 &&
        "$BUILD/brume" info "$out/$name.brume" >"$out/$name.info"
}

says()
{
    grep -qx "$2" "$out/$1.info" || { cat "$out/$1.info"; return 1; }
}

same_for_threads()
{
    make_cloud one --size 48 --type "$1" --threads 1 &&
        make_cloud two --size 48 --type "$1" --threads 2 &&
        cmp "$out/one.brume" "$out/two.brume"
}

# Non-zero voxels of NX x NY x NZ lie in [0, NX) x [0, NY) x [0, NZ).
in_box()
{
    make_cloud box --size 72x40x56 --type "$1" &&
        sed -n 's/^box_world=//p' "$out/box.info" | tr ',' ' ' |
        awk '{ exit !($1 >= 0 && $2 >= 0 && $3 >= 0 &&
                      $5 < 72 && $6 < 40 && $7 < 56) }'
}

for type in cumulus stratus cirrus plume fog sphere block ramp voxel; do
    check "$type: the same for 1 and 2 threads" same_for_threads $type
    check "$type: inside its box" in_box $type
done
differs()
{
    make_cloud s1 --size 48 --seed 1 && make_cloud s2 --size 48 --seed 2 &&
        ! cmp -s "$out/s1.brume" "$out/s2.brume"
}
check "seeds differ" differs

make_cloud block --size 32 --type block
check "a block of 32 is full" says block "voxels=32768"
check "and of density 1" says block "density_mean=1"
make_cloud voxel --size 9 --type voxel
check "a voxel is one voxel" says voxel "voxels=1"
make_cloud ramp --size 17 --type ramp
check "a ramp starts with a plane of zero" says ramp "voxels=4624"
check "a ramp's mean is that of 1/16 .. 16/16" says ramp "density_mean=0.53125"
make_cloud sphere --size 64 --type sphere
sphere_volume()
{
    # 4/3 pi 25.6^3 = 70276, to 1 % for the voxels on its surface
    awk -F= '$1 == "voxels" { exit !($2 > 69573 && $2 < 70979) }' \
        "$out/sphere.info"
}
check "a sphere has the volume of a ball" sphere_volume
make_cloud scaled --size 16 --type block --voxel-size 0.25
check "--voxel-size" says scaled "voxel_size=0.25"

# refused TEXT STATUS PATTERN OPTIONS...
refused()
{
    refused_status=$1 refused_pattern=$2 refused_got=0
    shift 2
    "$BUILD/brume-cloud" "$@" >"$out/stdout" 2>"$out/stderr" || refused_got=$?
    [ $refused_got = "$refused_status" ] && [ ! -s "$out/stdout" ] &&
        [ "$(wc -l <"$out/stderr")" = 1 ] &&
        grep -q "^brume-cloud: .*$refused_pattern" "$out/stderr" &&
        [ -z "$(ls -A "$out/none")" ] || { cat "$out/stderr"; return 1; }
}
vdb=$out/none/a.vdb
check "no output" refused 2 "" --size 16
check "unknown type lists the types" refused 2 "cumulus.*voxel" \
    -o "$vdb" --type nimbus
for size in 7 4097 0 -5 16x16 16x16x16x16 16x1e9x16 big ''; do
    check "--size '$size'" refused 2 "" -o "$vdb" --size "$size"
done
check "more memory than there could be" refused 2 "" -o "$vdb" \
    --size 4096x4096x4096
check "--voxel-size 0" refused 2 "" -o "$vdb" --voxel-size 0
check "--seed x" refused 2 "" -o "$vdb" --seed x
check "unknown option" refused 2 "" -o "$vdb" --sise 16
check "a folder that is not there" refused 1 "" -o "$out/no/such/a.vdb" \
    --size 16
check "a folder as output" refused 1 "" -o "$out/none" --size 16
finish
