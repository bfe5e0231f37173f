#!/bin/sh
# SPDX-License-Identifier: MIT
# What brume-bake writes, against all that docs/SPEC.md says, by a reader that
# was written from that page alone and shares no code with converter or core.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
out=$BUILD/spec
mkdir -p "$out"

# conforms NAME FILE OPTIONS...: baked in every format, with and without apron
conforms()
{
    name=$1 file=$2
    shift 2
    for format in u8 u8r u4r; do
        for apron in "" --apron; do
            # shellcheck disable=SC2086
            "$BUILD/brume-bake" "$file" -o "$out/a.brume" --format $format \
                $apron --dump-float "$out/a.float" "$@" >/dev/null 2>&1 ||
                rm -f "$out/a.brume"
            check "$name, $format $apron: as SPEC.md says" \
                "$BUILD/brume-spec-dump" "$out/a.brume" --check \
                --against "$out/a.float"
        done
    done
}

for type in cumulus plume block voxel; do
    "$BUILD/brume-cloud" -o "$out/$type.vdb" --size 64 --type $type >/dev/null
    conforms $type "$out/$type.vdb"
done
conforms "cumulus at half resolution" "$out/cumulus.vdb" --lod 1
# Bricks at both ends of a row: their numbers must not get mixed up.
conforms "cumulus in linear order" "$out/cumulus.vdb" --order linear
conforms "cumulus with all for light" "$out/cumulus.vdb" --mips --sun-cache 4 \
    --sun 30,20 --sky-visibility --sky-extinction 0.1
for file in wdas_cloud_sixteenth.vdb openvdb_smoke1.vdb \
    robustness/scivis_grid0.vdb robustness/serg_dragon_with_xform.vdb; do
    if [ -f "$DATA/$file" ]; then
        conforms "$file" "$DATA/$file"
    else
        skip "$file is not in $DATA"
    fi
done
rm -f "$out"/*.float
finish
