# SPDX-License-Identifier: MIT
# `. tests/volumes.sh`: bakes the real volumes of the test scenes from $DATA
# into $BUILD/volumes, and sets $volumes to NAME=FILE arguments for them. Empty,
# with a loud line, when the data is not there.
volumes=
if [ -f "$DATA/wdas_cloud_sixteenth.vdb" ] &&
    [ -f "$DATA/openvdb_smoke1.vdb" ]; then
    mkdir -p "$BUILD/volumes"
    bake_one()
    {
        bake_name=$1 bake_file=$2 bake_format=$3
        shift 3
        "$BUILD/brume-bake" "$DATA/$bake_file" \
            -o "$BUILD/volumes/$bake_name.brume" \
            --format "$bake_format" "$@" \
            --dump-float "$BUILD/volumes/${bake_name%_*}.float" \
            >/dev/null || exit 1
        volumes="$volumes $bake_name=$BUILD/volumes/$bake_name.brume"
    }
    bake_one wdas_u8 wdas_cloud_sixteenth.vdb u8
    bake_one wdas_u4r wdas_cloud_sixteenth.vdb u4r
    bake_one wdas1_u8 wdas_cloud_sixteenth.vdb u8 --lod 1
    bake_one smoke_u8r openvdb_smoke1.vdb u8r
    bake_one smoke_u4r openvdb_smoke1.vdb u4r
else
    echo "# REAL VOLUMES ARE NOT IN $DATA: tests of them are skipped" >&2
fi
