#!/bin/sh
# SPDX-License-Identifier: MIT
# The error of light is known: docs/light.md as the core computes it, against
# the double-precision reference. 480x270, without noise; RMSE <= 0.5 and
# |mean| <= 0.1 of 255 over all channels, where nothing else is said.
set -eu
: "${BUILD:=build}" "${DATA:=../shared/data}"
. tests/lib.sh
out=$BUILD/light
mkdir -p "$out"

# bake NAME FILE OPTIONS...
bake()
{
    name=$1 file=$2
    shift 2
    "$BUILD/brume-bake" "$file" -o "$out/$name.brume" \
        --dump-float "$out/$name.float" "$@" >/dev/null
}

common="size = 480x270
output = linear
background = 0
min_transmittance = 0.01
step = 1
light = log
light_samples = 8
light_step = 1
jitter = none
noise = none"

# Views, and for each a sun that is seen through the volume.
cat >"$out/wdas.scene" <<END
$common
eye = 572.6,280.5,967.4
target = -10,75,-41.67
fov = 30
sun = -60 30
density_scale = 0.2
light_density_scale = 0.07
filter = trilinear
END
wdas_behind="-150 0"
cat >"$out/smoke.scene" <<END
$common
eye = 0,33,180
target = -24,33,-13
fov = 34
sun = 40 20
density_scale = 0.6
light_density_scale = 0.3
filter = nearest
END
smoke_behind="-173 5"
cat >"$out/cumulus.scene" <<END
$common
eye = 85,14,125
target = 32,20,32
fov = 30
sun = -75 32
density_scale = 0.5
light_density_scale = 0.15
filter = trilinear
END
cumulus_behind="-150 6"

# Z is up in it.
cat >"$out/fire.scene" <<END
$common
eye = -5,-420,-20
target = -5,-35,-62
up = 0,0,1
fov = 20
sun = 40 20
density_scale = 3
light_density_scale = 1
filter = trilinear
emission = blackbody:900,2300,4
emission_scale = 0.06
END

value() { sed -n "s/^$1=//p" "$out/metrics"; }

# metrics VOLUME PICTURE OPTION KEY=VALUE...: of the core's picture against
# the reference's, which takes the option, both of the volume's scene with these
# settings.
metrics()
{
    volume=$1 picture=$out/core.$2 option=$3
    shift 3
    for setting; do
        set -- "$@" --set "$setting"
        shift
    done
    echo "rmse=999" >"$out/metrics"
    # shellcheck disable=SC2086
    "$BUILD/brume-reference" "$out/$volume.float" $option \
        --scene "$out/$volume.scene" "$@" -o "$out/reference.pfm" || return 1
    "$BUILD/brume" render "$out/$volume.brume" \
        --scene "$out/$volume.scene" "$@" -o "$picture" || return 1
    "$BUILD/brume" compare "$out/reference.pfm" "$picture" \
        --metrics rmse,mean >"$out/metrics.new"
    mv "$out/metrics.new" "$out/metrics"
}

# within RMSE MEAN: are the metrics, in 1/255?
within()
{
    awk -v rmse="$(value rmse)" -v mean="$(value mean)" -v most="$1" \
        -v away="$2" 'BEGIN {
        exit !(rmse <= most && mean <= away && mean >= -away) }'
}

# light WHAT KEY=VALUE...: on $volume_name, as floats.
light()
{
    what=$1
    shift
    metrics "$volume_name" pfm --display "$@" || :
    check "$volume_name, $what: rmse $(value rmse) mean $(value mean)" \
        within 0.5 0.1
}

# shown WHAT KEY=VALUE...: the same in 8 bits, through the output's curve, both
# rounded.
shown()
{
    what=$1
    shift
    metrics "$volume_name" png "--bits 8" "$@" || :
    check "$volume_name, $what: rmse $(value rmse) mean $(value mean)" \
        within 0.5 0.1
}

# nearly RMSE MEAN WHAT KEY=VALUE...: with wider bounds, where the core has noise
# or an approximation that the reference does without.
nearly()
{
    most=$1 away=$2 what=$3
    shift 3
    metrics "$volume_name" pfm "--display --directions 32" "$@" || :
    check "$volume_name, $what: rmse $(value rmse) mean $(value mean)" \
        within "$most" "$away"
}

blue="sky=on sky_zenith=0.1,0.3,0.7 sky_horizon=0.6,0.7,0.8
    sky_ground=0.15,0.12,0.1 sun_disc=1,0.9,0.6 sun_size=2"

phases()
{
    for phase in hg:0.6 hg:-0.4 hg:0.99 hg:-0.99 schlick:0.6 schlick:0.99 \
        schlick:-0.99 draine:1,0 draine:22,0.55 droplet:1 droplet:10 \
        mix:0.3,10,0.5,-0.3; do
        light "$phase" "phase=$phase" exposure=0.5
        # Straight at the sun
        light "$phase before the sun" "phase=$phase" "sun=$1" exposure=0.0625
    done
}

octaves()
{
    for n in 1 2 4 8; do
        light "$n octaves" "octaves=$n" phase=hg:0.7
        light "$n octaves of droplets" "octaves=$n" phase=droplet:10 \
            octave_a=0.25 octave_b=0.6 octave_c=0.7
    done
    light "8 equal octaves" octaves=8 octave_a=1 octave_b=1 octave_c=1 \
        exposure=0.125
    light "octaves that lose all" octaves=3 octave_a=0 octave_b=0.3 \
        octave_c=0 phase=hg:0.9
    light "octaves, uniform light" octaves=4 light=uniform light_samples=32 \
        light_step=2.5
    light "octaves without shadows" octaves=3 light=none phase=hg:0.5 \
        exposure=0.5
}

ambient()
{
    light "constant ambient" ambient=constant ambient_colour=0.3,0.3,0.3
    light "blue ambient" ambient=constant ambient_colour=0.1,0.2,0.4
    light "gradient" ambient=gradient ambient_top=0.2,0.4,0.8 \
        ambient_bottom=0.3,0.2,0.1
    light "cube" ambient=cube ambient_px=0.6,0,0 ambient_nx=0,0.6,0 \
        ambient_py=0.3,0.6,1.2 ambient_ny=0.3,0.2,0.1 ambient_pz=0,0,0.6 \
        ambient_nz=0.2,0.2,0.2
    light "ambient alone, albedo 1, L + T = 1" ambient=constant \
        ambient_colour=1,1,1 sun_colour=0,0,0 background=1,1,1
}

behind()
{
    # shellcheck disable=SC2086
    light "sky" $blue
    # shellcheck disable=SC2086
    light "sky with the sun in it" $blue "sun=$1" phase=hg:0.5 \
        exposure=0.25
    # shellcheck disable=SC2086
    light "sky, straight up" $blue "sun=20 70" up=0,0,1 \
        "target=$2" fov=100
    light "haze over a background" haze=400 background=0.4,0.5,0.6
    # shellcheck disable=SC2086
    light "haze and sky" $blue haze=150
    light "haze so thick that nothing is left" haze=8 background=0.3
}

extremes()
{
    light "colours" sun_colour=1,0.8,0.5 ambient=constant \
        ambient_colour=0.1,0.15,0.3 exposure=0.7 octaves=3 phase=droplet:20 \
        background=0.2,0.3,0.5
    light "a dim sun" sun_colour=0.02,0.01,0.005 exposure=16 phase=hg:0.5
    light "a bright sun" sun_colour=16,8,4 exposure=0.0625
    light "a bright peak of a dim sun" sun_colour=0.02,0.02,0.01 \
        phase=hg:0.99 "sun=$1"
    light "albedo 0" albedo=0 ambient=constant ambient_colour=1,1,1 \
        sun_colour=1,0.5,0.25 background=1
    light "albedo 1" albedo=1 octaves=2
    light "albedo 0.5" albedo=0.5 octaves=2 ambient=constant \
        ambient_colour=0.5,0.5,0.5
    light "black sun" sun_colour=0,0,0
    light "black sun, ambient" sun_colour=0,0,0 ambient=gradient \
        ambient_top=0.5,0.5,1 ambient_bottom=0.5,0.3,0
    light "sun below the horizon" "sun=100 -60" octaves=3 phase=hg:0.6
    light "sun below, seen through it" "sun=$2" octaves=3 phase=hg:0.6 \
        exposure=0.25
}

# One beside, one in it of three colours, one all of whose reach is its size, a
# spot with a shadow, one with both cones equal. Distances of the list are parts
# of 1/64 of the volume's own size.
lamps()
{
    awk -v centre="$1" -v unit="$2" 'BEGIN {
        split(centre, c, ",")
        while ((getline <"tests/light.lamps") > 0) {
            if ($0 ~ /^#/ || NF == 0)
                continue
            split($1, p, ",")
            printf "%g,%g,%g %g %g", c[1] + p[1] * unit, c[2] + p[2] * unit,
                c[3] + p[3] * unit, $2 * unit, $3 * unit
            for (i = 4; i <= NF; i++)
                printf " %s", $i
            print ""
        }
    }' >"$out/$volume_name.lamps"
    light "lamps" "lamps=$out/$volume_name.lamps"
    black="sun_colour=0,0,0 lamps=$out/$volume_name.lamps"
    # shellcheck disable=SC2086
    light "lamps alone, trilinear" $black filter=trilinear
    # shellcheck disable=SC2086
    light "lamps alone, nearest" $black filter=nearest
    for phase in hg:0.7 droplet:10 hg:-0.99; do
        # shellcheck disable=SC2086
        light "lamps alone, $phase" $black "phase=$phase" exposure=0.5
    done
    # shellcheck disable=SC2086
    light "lamps that are dim, albedo 0.5, octaves" $black exposure=0.0625 \
        albedo=0.5 octaves=4 phase=hg:0.3
    # shellcheck disable=SC2086
    light "lamps that are too bright" $black exposure=16
    # shellcheck disable=SC2086
    light "lamps, haze, jitter" lamps="$out/$volume_name.lamps" haze=300 \
        jitter=both noise=white
}

cones()
{
    for filter in nearest trilinear; do
        light "cone, $filter" light=cone light_samples=10 "filter=$filter"
        light "cone, $filter, steps of 2.5" light=cone light_samples=8 \
            light_step=2.5 "filter=$filter" octaves=3
    done
    light "cone, steps of 0.3" light=cone light_samples=12 light_step=0.3
}

# What has noise of its own is asked for its mean; what is baked, for being
# near the exact depth and visibility that it stands for.
approximations()
{
    small="size=96x54 ambient_colour=0.5,0.5,0.5 sun_colour=0.5,0.5,0.5
        jitter=primary noise=white visibility_step=2 visibility_samples=6"
    # shellcheck disable=SC2086
    nearly 8 0.3 "visibility sampled" $small ambient=constant \
        visibility=sampled
    # shellcheck disable=SC2086
    nearly 8 0.3 "visibility sampled, cube" $small ambient=cube \
        ambient_px=0.6,0,0 ambient_nx=0,0.6,0 ambient_py=0.3,0.6,1.2 \
        ambient_ny=0.3,0.2,0.1 ambient_pz=0,0,0.6 ambient_nz=0.2,0.2,0.2 \
        visibility=sampled
    # shellcheck disable=SC2086
    nearly 5 2 "visibility baked" $small ambient=constant visibility=baked
    nearly 5 2 "cache" light=cache filter=trilinear
    nearly 5 2 "cache, nearest" light=cache filter=nearest
    # exp of a mean density is not the mean of exp: hence not 0.
    nearly 8 0.5 "stochastic" filter=stochastic jitter=both noise=white
}

# glows WHAT KEY=VALUE...: as light, with the volume's emission.
glows()
{
    what=$1
    shift
    metrics "$volume_name" pfm \
        "--display --emission $out/$volume_name.emission" "$@" || :
    check "$volume_name, $what: rmse $(value rmse) mean $(value mean)" \
        within 0.5 0.1
}

emission()
{
    # A file of colours: green at low values, then white, then violet.
    awk 'BEGIN { for (i = 0; i < 256; i++)
        print i / 255, i < 128 ? 0.5 : 1 - i / 300, (i / 255) ^ 2 }' \
        >"$out/colours.txt"
    awk 'BEGIN { for (i = 0; i < 256; i++) print i / 100, i / 100, i / 100 }' \
        >"$out/greys.txt"
    for filter in nearest trilinear; do
        glows "fire, $filter" "filter=$filter"
        glows "colours of a file, $filter" "filter=$filter" \
            "emission=$out/colours.txt"
        glows "thin, $filter" "filter=$filter" emission_scale=0.004 \
            exposure=4 sun_colour=0.25,0.25,0.25
        glows "opaque, $filter" "filter=$filter" emission_scale=5 \
            "emission=$out/colours.txt"
    done
    glows "grey" "emission=$out/greys.txt"
    glows "hot" emission=blackbody:3000,12000,0.5
    glows "emission alone" density_scale=0 sun_colour=0,0,0
    glows "albedo 0" albedo=0 background=0.3
    glows "no scale" emission_scale=0
    glows "no colours" emission=none
    glows "with all else" octaves=4 phase=hg:0.6 ambient=gradient \
        ambient_top=0.2,0.4,0.8 ambient_bottom=0.3,0.2,0.1 haze=900 \
        exposure=0.7 light=cone light_samples=10 min_density=0.01
    glows "short steps" step=0.3
    glows "long steps" step=7.5
    glows "brighter than 8" exposure=16 emission_scale=1
}

# What is shown: 8 bits through a curve.
curves()
{
    shown "filmic" output=filmic exposure=1.5 octaves=3 phase=hg:0.3
    # shellcheck disable=SC2086
    shown "filmic, colours" $blue output=filmic exposure=3 ambient=constant \
        ambient_colour=0.2,0.3,0.5
    # shellcheck disable=SC2086
    shown "sRGB, colours" $blue output=srgb ambient=constant \
        ambient_colour=0.2,0.3,0.5
}

# Things of a volume whose middle is at X Y Z of the world and which is L wide:
# shapes of fog, one of them around the eye; bars between it and the sun and a
# ground below, as the camera and the sun see them.
things_of()
{
    eye=$(sed -n 's/^eye = //p' "$out/$volume_name.scene")
    awk -v x="$1" -v y="$2" -v z="$3" -v l="$4" -v d="$5" -v eye="$eye" 'BEGIN {
        printf "sphere %g,%g,%g %g %g 0.5\n", x + .4 * l, y, z + .3 * l,
            .3 * l, 4 * d
        printf "box %g,%g,%g %g,%g,%g %g 0.2\n", x - .4 * l, y, z, .2 * l,
            .3 * l, .25 * l, 2 * d
        printf "sphere %s %g %g 1\n", eye, .2 * l, 2 * d }' \
        >"$out/$volume_name.shapes"
    awk -v x="$1" -v y="$2" -v z="$3" -v l="$4" 'BEGIN {
        for (i = -3; i < 3; i++) {
            for (n = 0; n < 4; n++)
                printf "v %g %g %g\n", x + l * (i + (n % 3 ? .5 : 0)) / 4,
                    y + .7 * l, z + l * (n > 1 ? 1 : -1)
            print "f -4 -3 -2 -1" } }' >"$out/$volume_name.obj"
    area=$(awk -v x="$1" -v z="$3" -v l="$4" 'BEGIN {
        printf "%g,%g,%g,%g", x - 2 * l, z - 2 * l, x + 2 * l, z + 2 * l }')
    plane=$(awk -v y="$2" -v l="$4" 'BEGIN { print y - .4 * l }')
    "$BUILD/brume" surface "$out/$volume_name.brume" \
        --scene "$out/$volume_name.scene" --set size=160x90 \
        --mesh "$out/$volume_name.obj" --area "$area" --plane "$plane" \
        --depth "$out/$volume_name.depth.pgm" \
        --sun-map "$out/$volume_name.sun.pgm" --size 256x256 >/dev/null
}

# fog MIDDLE... L DENSITY: density is per voxel. 160x90, as every sample of the
# air counts.
fog()
{
    things_of "$@"
    small="size=160x90 fog_density=$5 fog_base=$2 fog_far=$(
        awk -v l="$4" 'BEGIN { print 6 * l }')"
    falloff="fog_falloff=$(awk -v l="$4" 'BEGIN { print l / 2 }')"
    steep="fog_falloff=$(awk -v l="$4" 'BEGIN { print l / 20 }')"
    shapes="fog_shapes=$out/$volume_name.shapes"
    surface="surface=$out/$volume_name.depth.pgm"
    map="sun_map=$out/$volume_name.sun.pgm"
    # shellcheck disable=SC2086
    {
        light "fog without end" $small
        light "fog by height" $small $falloff
        light "a layer of fog" $small $steep
        light "fog to the top" $small $falloff fog_base=1000
        light "fog, nearest" $small $falloff filter=nearest
        light "fog, steps of 0.4" $small $falloff step=0.4
        light "fog, uniform light" $small $falloff light=uniform \
            light_samples=40 light_step=2
        light "fog, no light" $small $falloff light=none
        light "fog, cones" $small $falloff light=cone light_samples=10
        nearly 5 2 "fog, cache" $small $falloff light=cache light_samples=8
        light "fog, octaves of droplets" $small $falloff octaves=4 \
            phase=droplet:10
        light "fog before the sun" $small $falloff "sun=$6" phase=hg:0.8 \
            exposure=0.25
        light "fog, sun below the horizon" $small $falloff "sun=100 -20"
        light "fog, gradient" $small $falloff ambient=gradient \
            ambient_top=0.2,0.4,0.8 ambient_bottom=0.3,0.2,0.1
        light "fog, sky, haze" $small $falloff $blue haze=300
        light "opaque fog" $small fog_density=0.9
        light "fog, albedo 0" $small $falloff albedo=0 background=1
        light "shapes" $small fog_density=0 $shapes
        light "shapes in fog" $small $falloff $shapes octaves=2
        light "shapes, uniform light" $small $falloff $shapes light=uniform \
            light_samples=40 light_step=2
        light "shapes, cones" $small $falloff $shapes light=cone \
            light_samples=10
        light "surface" size=160x90 $surface
        light "surface in fog" $small $falloff $surface
        light "sun map" size=160x90 $map
        light "sun map, nearest" size=160x90 $map filter=nearest
        light "fog, shapes, surface, sun map" $small $falloff $shapes \
            $surface $map octaves=3 phase=hg:0.3
    }
}

all_of()
{
    volume_name=$1 sun_behind=$2
    phases "$sun_behind"
    octaves
    ambient
    cones
    approximations
    behind "$sun_behind" "$3"
    extremes "$sun_behind" "$4"
    curves
    lamps "$5" "$6"
}

# A volume that is always there.
"$BUILD/brume-cloud" -o "$out/cumulus.vdb" --size 64 >/dev/null
bake cumulus "$out/cumulus.vdb" --format u8r --mips --sun-cache 2 \
    --sun -75,32 --sky-visibility --sky-extinction 0.15
all_of cumulus "$cumulus_behind" "100,200,130" "-150 -2" 32,20,32 1
fog 32 20 32 55 0.004 "$cumulus_behind"

if [ -f "$DATA/wdas_cloud_sixteenth.vdb" ]; then
    bake wdas "$DATA/wdas_cloud_sixteenth.vdb" --format u8 --mips \
        --sun-cache 2 --sun -60,30 --sky-visibility --sky-extinction 0.07
    all_of wdas "$wdas_behind" "600,1200,960" "-150 -20" -10,75,-41 7
    fog -10 75 -41 400 0.0015 "$wdas_behind"
else
    echo "# REAL VOLUMES ARE NOT IN $DATA" >&2
    skip "light on the Disney cloud: wdas_cloud_sixteenth.vdb absent"
fi
if [ -f "$DATA/openvdb_smoke1.vdb" ]; then
    # Clamped, as in test_accuracy.sh.
    bake smoke "$DATA/openvdb_smoke1.vdb" --format u8r --max-density 1 \
        --mips --sun-cache 2 --sun 40,20 --sky-visibility --sky-extinction 0.3
    all_of smoke "$smoke_behind" "1,200,181" "-173 -5" -24,33,-13 1.2
    fog -8 40 0 100 0.0012 "$smoke_behind"
else
    skip "light on the smoke: openvdb_smoke1.vdb absent"
fi
fire=$DATA/embergen_fire/embergen_fire_a_70.vdb
if [ -f "$fire" ]; then
    for form in "u8" "u8r --apron"; do
        # shellcheck disable=SC2086
        bake fire "$fire" --grid flames --emission temperature --mips \
            --dump-emission "$out/fire.emission" --format $form
        volume_name=fire
        emission
    done
else
    skip "light of the fire: embergen_fire_a_70.vdb absent"
fi
finish
