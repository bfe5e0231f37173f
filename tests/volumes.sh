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
        "$BUILD/brume-bake" "$DATA/$2" -o "$BUILD/volumes/$1.brume" \
            --format "$3" --dump-float "$BUILD/volumes/${1%_*}.float" \
            >/dev/null || exit 1
        volumes="$volumes $1=$BUILD/volumes/$1.brume"
    }
    bake_one wdas_u8 wdas_cloud_sixteenth.vdb u8
    bake_one smoke_u8r openvdb_smoke1.vdb u8r
    bake_one smoke_u4r openvdb_smoke1.vdb u4r
else
    echo "# REAL VOLUMES ARE NOT IN $DATA: tests of them are skipped" >&2
fi
