#!/bin/sh
# SPDX-License-Identifier: MIT
# fit_octaves.sh [PASSES]: the tables of docs/octaves.md, on stdout, from the
# volumes in $DATA and a made one. Pictures are kept in $BUILD/octaves, so that
# more passes go on from fewer.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}" "${THREADS:=1}"
case ${1:-} in
-h | --help)
    echo "usage: [BUILD=dir] [DATA=dir] [THREADS=n] $0 [PASSES]"
    echo "Fits octaves to PASSES (1024) Monte Carlo paths a pixel; prints tables."
    exit
    ;;
esac
out=$BUILD/octaves
mkdir -p "$out"

# dump NAME FILE: the voxels as floats
dump()
{
    [ -f "$2" ] || {
        echo "$0: $2 is not there" >&2
        exit 1
    }
    "$BUILD/brume-bake" "$2" -o "$out/$1.brume" \
        --dump-float "$out/$1.float" >/dev/null
}

"$BUILD/brume-cloud" --size 96 -o "$out/cumulus.vdb" >/dev/null
dump cumulus "$out/cumulus.vdb"
dump disney "$DATA/wdas_cloud_sixteenth.vdb"
dump smoke "$DATA/openvdb_smoke1.vdb"

# Extinctions: those of the default scenes; of scenes/cumulus.scene, whose
# voxels are 96/256 of these; and the Disney cloud thicker and thinner.
exec "$BUILD/brume-octave-fit" --passes "${1:-1024}" --threads "$THREADS" \
    --cache "$out" \
    "disney=$out/disney.float,0.134" \
    "smoke=$out/smoke.float,0.32" \
    "cumulus=$out/cumulus.float,0.427" \
    "+disney x4=$out/disney.float,0.536" \
    "+disney /4=$out/disney.float,0.0335"
