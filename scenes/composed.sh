#!/bin/sh
# SPDX-License-Identifier: MIT
# composed.sh [VOLUME.vdb [FILE.scene]]: volumes and fog among solid things, in
# $BUILD/demo: light through a window of bars, a street of lamps, a cloud and
# its shadow on a plain. Each is `brume surface`, whose files `brume render`
# ends its rays at and draws over.
#   VOLUME.vdb   in place of the last picture's cloud (or VDB=VOLUME.vdb)
#   FILE.scene   its scene, whose fog_base is the height of the plain; without
#                one, scenes/cloud_plane.scene is fitted to the volume's box.
#                That of the Disney cloud is scenes/disney_plane.scene, which is
#                taken for a wdas_cloud_sixteenth*.vdb
#   SIZE=WxH     of the pictures, in place of the scenes' own
#   OUT=FOLDER   in place of $BUILD/demo
set -eu
case ${1-} in
--help | -h)
    sed -n '/^# composed/,/^set/s/^# //p' "$0"
    exit
    ;;
esac
[ $# -le 2 ] || {
    echo "composed.sh: too many arguments; see --help" >&2
    exit 2
}
vdb=${1:-${VDB:-}} scene=${2:-}
# Those of the caller's folder, not of the one that this goes to.
for file in "$vdb" "$scene"; do
    [ -z "$file" ] || [ -r "$file" ] || {
        echo "composed.sh: cannot read $file" >&2
        exit 2
    }
done
[ -z "$vdb" ] || vdb=$(realpath "$vdb")
[ -z "$scene" ] || scene=$(realpath "$scene")
cd "$(dirname "$0")/.."
: "${BUILD:=build}" "${SIZE:=}"
out=${OUT:-$BUILD/demo}
brume=$BUILD/brume cloud=$out/cumulus.brume
mkdir -p "$out"

# As `make demo` makes it: the cloud of the last picture, and the world of all.
if [ ! -f "$cloud" ]; then
    "$BUILD/brume-cloud" -o "$out/cumulus.vdb" --size 256
    "$BUILD/brume-bake" "$out/cumulus.vdb" -o "$cloud"
fi

# things NAME SCENE OPTION...: depth and colour of a scene's things
things()
{
    name=$1 file=$2
    shift 2
    "$brume" surface "$cloud" --scene "$file" ${SIZE:+--set size="$SIZE"} \
        "$@" --depth "$out/${name}_depth.png" \
        --colour "$out/${name}_colour.png"
}

# compose NAME SCENE OPTION...: the scene over them
compose()
{
    name=$1 file=$2
    shift 2
    echo "drawing $out/$name.png"
    "$brume" render "$cloud" --scene "$file" ${SIZE:+--set size="$SIZE"} \
        --set surface="$out/${name}_depth.png" \
        --over "$out/${name}_colour.png" "$@" -o "$out/$name.png"
}

# fitted SCENE: that of the cumulus, whose box is 10,8,14 to 248,174,246 and
# whose voxels are 1, for the box of the volume: camera about its middle, plain
# below its lower end. Extinction is the volume's own.
fitted()
{
    "$brume" info "$cloud" | LC_ALL=C awk '
        NR == FNR && sub(/^box_world=/, "") {
            gsub(/,| to /, " ")
            split($0, box, " ")
        }
        NR == FNR && sub(/^voxel_size=/, "") { voxel = $0 }
        NR == FNR { next }
        FNR == 1 {
            for (i = 1; i <= 3; i++) {
                middle[i] = (box[i] + box[i + 3]) / 2
                # The view has room for 190 above each other.
                s = (box[i + 3] - box[i]) / (i == 2 ? 190 : 238)
                scale = s > scale ? s : scale
            }
        }
        $1 == "eye" || $1 == "target" {
            split($3, at, ",")
            $3 = sprintf("%.9g,%.9g,%.9g", middle[1] + scale * (at[1] - 129),
                middle[2] + scale * (at[2] - 91),
                middle[3] + scale * (at[3] - 130))
        }
        $1 == "fog_base" { $3 = sprintf("%.9g", box[2] + scale * ($3 - 8)) }
        $1 == "fog_falloff" || $1 == "fog_far" {
            $3 = sprintf("%.9g", scale * $3)
        }
        $1 == "fog_density" { $3 = sprintf("%.9g", $3 * voxel / scale) }
        !/^#/ && $1 !~ /density_scale$/' - "$1"
}

sh scenes/things.sh bars >"$out/bars.obj"
things bars_fog scenes/bars_fog.scene --albedo 0.25 --mesh "$out/bars.obj" \
    --albedo 0.2 --plane 0 --area -600,-600,600,600 --samples 4 \
    --sun-map "$out/bars_fog_sun.pgm" --size 2048x1024 \
    --cover -300,0,-300,300,130,10
compose bars_fog scenes/bars_fog.scene --set sun_map="$out/bars_fog_sun.pgm"

sh scenes/things.sh posts >"$out/posts.obj"
things lamp_street scenes/lamp_street.scene --albedo 0.15 --plane 0 \
    --area -600,-600,600,1200 --albedo 0.1 --mesh "$out/posts.obj" --samples 4
compose lamp_street scenes/lamp_street.scene

plain=scenes/cloud_plane.scene
if [ -n "$vdb" ]; then
    cloud=$out/cloud_plane.brume
    "$BUILD/brume-bake" "$vdb" -o "$cloud"
    case $scene,$(basename "$vdb") in
    ,wdas_cloud_sixteenth*) plain=scenes/disney_plane.scene ;;
    ,*)
        plain=$out/cloud_plane.scene
        fitted scenes/cloud_plane.scene >"$plain"
        ;;
    *) plain=$scene ;;
    esac
fi
base=$(sed -n 's/^fog_base *= *\([^ #]*\).*/\1/p' "$plain")
# As far as a camera sees: 30000 voxels to each side of the volume.
ground=$("$brume" info "$cloud" | LC_ALL=C awk '
    sub(/^voxel_size=/, "") { far = 30000 * $0 }
    sub(/^box_world=/, "") {
        gsub(/,| to /, " ")
        split($0, box, " ")
    }
    END {
        x = (box[1] + box[4]) / 2
        z = (box[3] + box[6]) / 2
        printf "%.9g,%.9g,%.9g,%.9g", x - far, z - far, x + far, z + far
    }')
area=$("$brume" shadow "$cloud" --scene "$plain" --plane "${base:-0}" \
    --size 512x512 -o "$out/cloud_plane_shadow.png" | sed -n 's/^area=//p')
things cloud_plane "$plain" --albedo 0.025,0.04,0.015 --plane "${base:-0}" \
    --area "$ground" --samples 2 \
    --shadow "$out/cloud_plane_shadow.png" --shadow-area "$area"
compose cloud_plane "$plain"
