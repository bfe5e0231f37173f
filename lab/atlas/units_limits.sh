# SPDX-License-Identifier: MIT
# Where integers and formats could fail: extremes of extinction, of distance
# and of coordinates; few bits.

## Extinction from 1e-4 to 1e3 per voxel

unit_extinction()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
step = 0.5"
    for sigma in 0.0001 0.001 0.01 0.1 1 10 100 1000; do
        truth truth$sigma block --set density_scale=$sigma
        draw on$sigma block --set density_scale=$sigma
        for metric in rmse mean; do
            row "brume's integers" "block; unlit" "extinction $sigma" $metric \
                "$(error $metric truth$sigma on$sigma)" 1/255 \
                "reference; same lattice" "none needed" 0
        done
    done
    heat heat truth0.1 on0.1 2
    picture 1 on0.1.pfm heat.png truth0.1.pfm
}
claim_extinction()
{
    for r in 1 3 5 7 9 11 13 15; do
        claim_within $r value 0.35
        claim_within $((r + 1)) value 0.05
    done
}

# The same with light, on a cloud whose densities go from 1/255 to 1: with
# trilinear lookups the least trace beside a voxel is opaque in the end, and
# codes of 1/65280 and places of 1/256 voxel no longer tell where it begins.
unit_extinction_lit()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 32
sun = 40 30
step = 1
light = uniform
light_samples = 64
light_step = 1"
    for filter in nearest trilinear; do
        for sigma in 0.0001 0.01 1 100 1000 1000000; do
            truth truth$sigma cloud --set filter=$filter \
                --set density_scale=$sigma --set light_density_scale=$sigma
            draw on$sigma cloud --set filter=$filter \
                --set density_scale=$sigma --set light_density_scale=$sigma
            figure=$(error rmse truth$sigma on$sigma)
            case $filter in
            nearest)
                remedy="none needed" remedy_figure=0
                echo "$figure" >"$work/nearest$sigma"
                ;;
            *) remedy=nearest remedy_figure=$(cat "$work/nearest$sigma") ;;
            esac
            row "brume's integers" "lit cloud; $filter" "extinction $sigma" \
                rmse "$figure" 1/255 "reference; same lattice" "$remedy" \
                "$remedy_figure"
        done
    done
    heat heat truth1000000 on1000000 64
    picture 1 on1000000.pfm heat.png truth1000000.pfm
}
# Rows 1 to 6 are nearest, 7 to 12 trilinear. From 100 per voxel on, a sample
# that double precision sees on the other side of a face is a whole pixel.
claim_extinction_lit()
{
    for r in 1 2 3 5 6 7 8 9 10; do claim_within $r value 0.35; done
    for r in 4 11; do claim_within $r value 0.6; done
    claim_better 12 50
}

## Underflow along faint rays

# Optical depth tau over 4000 voxels, in steps of which each takes tau * 2.5e-4
# at 1 voxel.
unit_underflow()
{
    volume beam
    scene "eye = 11.5,11.5,-20
target = 11.5,11.5,4000
up = 0,1,0
fov = 2
light = none"
    for tau in 0.001 0.01 0.1 1 4; do
        sigma=$(awk "BEGIN { print $tau / 4000 }")
        truth truth$tau beam --set density_scale=$sigma --set step=1
        draw fine$tau beam --set density_scale=$sigma --set step=0.0625
        draw one$tau beam --set density_scale=$sigma --set step=1
        row "steps of 1/16" "4000 voxels; unlit" "tau $tau" mean \
            "$(error mean truth$tau fine$tau)" 1/255 "reference; step 1" \
            "step 1" "$(error mean truth$tau one$tau)"
    done
    heat heat truth1 fine1 2
    picture 1 fine1.pfm heat.png truth1.pfm
}
claim_underflow()
{
    for r in 1 2 3 4 5; do
        claim_within $r value 0.05
        claim_within $r remedy_value 0.005
    done
}

## Coordinates at the far end

# Voxel 0 of the ball is 32728 voxels from the pool's corner. An eye beyond
# BRUME_MAX_COORDINATE is refused at the border.
unit_far_coordinates()
{
    volume_alone ball
    volume_alone farball
    scene "fov = 20
filter = trilinear
density_scale = 0.3
light_density_scale = 0.1
light = uniform
light_samples = 64
light_step = 1
sun = 150 30
step = 0.5"
    draw near ball --set eye=26,20,-80 --set target=16,16,16
    draw far farball --set eye=26,20,32648 --set target=16,16,32744
    heat heat near far 2
    row "brume's integers" "ball at the far end of 32760 voxels" \
        "eye at 32648" max "$(error max near far)" 1/255 \
        "the same at the pool's corner" "none needed" 0
    "$brume" render "$work/farball.brume" --scene "$work/scene" \
        --set eye=16,16,32767 --set target=16,16,0 -o "$work/beyond.pfm" \
        2>"$work/refusal"
    row "brume's Q16.16 positions" "ball at the far end of 32760 voxels" \
        "eye at 32767" exit_status $? status \
        "$(grep -c 'at most 32766' "$work/refusal") line names the limit" \
        "eye within 32766 of the corner" 0
    [ ! -f "$work/beyond.pfm" ] || die "a picture from beyond the limit"
    picture 1 far.pfm heat.png near.pfm
}
claim_far_coordinates()
{
    claim_within 1 value 0.5
    verdict "an eye beyond the limit: exit status $(field 2 value)" \
        "$(field 2 value) == 2"
}

## Faint clamps

# Counted in 1/65280 of the volume's largest density, rounded down: below that
# a clamp is refused. The extinction is such that the truth stays the same.
unit_max_density()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 32
step = 1"
    for limit in 0.1 0.001 0.0001 0.00002; do
        scale=$(awk "BEGIN { print 0.1 / $limit }")
        truth truth$limit cloud --set max_density=$limit \
            --set "density_scale=$scale"
        draw on$limit cloud --set max_density=$limit \
            --set "density_scale=$scale"
        row max_density "cloud; unlit" "max_density $limit" mean \
            "$(error mean truth$limit on$limit)" 1/255 \
            "reference; float clamp" "max_density 0.1" \
            "$(error mean truth0.1 on0.1)"
    done
    "$brume" render "$work/cloud.brume" --scene "$work/scene" \
        --set max_density=0.00001 -o "$work/beyond.pfm" 2>"$work/refusal"
    row max_density "cloud; unlit" "max_density 0.00001" exit_status $? \
        status "$(grep -c 'at least 1/65280' "$work/refusal") line names the \
limit" "max_density 0.1" 0
    [ ! -f "$work/beyond.pfm" ] || die "a picture from beyond the limit"
    heat heat truth0.00002 on0.00002 64
    picture 1 on0.00002.pfm on0.1.pfm truth0.00002.pfm
}
claim_max_density()
{
    claim_within 1 value 0.05
    claim_better 4 100
    verdict "a clamp of nothing: exit status $(field 5 value)" \
        "$(field 5 value) == 2"
}

## Borders of the scene

# border KEY INSIDE OUTSIDE: the last value that is taken, and one that is not
border()
{
    quiet "$brume" render "$work/block.brume" --scene "$work/scene" \
        --set "$1=$2" -o "$work/inside.pfm"
    rm -f "$work/beyond.pfm"
    "$brume" render "$work/block.brume" --scene "$work/scene" \
        --set "$1=$3" -o "$work/beyond.pfm" 2>"$work/refusal"
    border_status=$?
    [ ! -f "$work/beyond.pfm" ] || die "a picture beyond $1"
    [ "$(wc -l <"$work/refusal")" -eq 1 ] || die "$1: not one line"
    grep -q "$1" "$work/refusal" || die "$1 is not named"
    row "limit of $1" block "$1 $(echo "$3" | tr , ' ')" exit_status \
        $border_status status "refused in one line; no picture" \
        "$1 $(echo "$2" | tr , ' ')" 0
}

unit_borders()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
step = 0.5"
    border step 0.0625 0.06
    border step 256 257
    border light_step 0.0625 0.06
    border light_step 256 257
    border fov 1 0.99
    border fov 160 160.1
    border eye 32766,32,32 32767,32,32
    border density_scale 4294967295 4294967296
    border light_samples 4096 4097
    border size 16384x1 16385x1
    border alpha 0.015625 0.0156
    border min_transmittance 1 1.01
    draw left block --set step=0.0625
    draw middle block --set step=256
    truth truth block --set step=0.0625
    picture 1 middle.pfm left.pfm truth.pfm
}
claim_borders()
{
    for r in 1 2 3 4 5 6 7 8 9 10 11 12; do
        verdict "$(field $r setting): exit status $(field $r value)" \
            "$(field $r value) == 2"
    done
}

## Few bits

unit_four_bits()
{
    volume slope
    scene "eye = 32,32,150
target = 32,32,32
fov = 30
density_scale = 0.06
filter = trilinear
step = 0.5"
    truth truth slope
    for format in u4r u8 u8r; do
        volume slope $format
        draw $format slope
    done
    row "u4r" "smooth slope" "4 bits" rmse "$(error rmse truth u4r)" 1/255 \
        "reference; float voxels" "u8r" "$(error rmse truth u8r)"
    row "u4r" "smooth slope" "4 bits" max "$(error max truth u4r)" 1/255 \
        "reference; float voxels" "u8" "$(error max truth u8)"
    heat heat truth u4r 2
    picture 1 u4r.pfm heat.png truth.pfm
}
claim_four_bits() { claim_better 1 3; }

## Seams between bricks of different scale

unit_brick_seams()
{
    volume spikes
    scene "eye = 32,32,150
target = 32,32,32
fov = 30
density_scale = 0.15
filter = trilinear
step = 0.5"
    truth truth spikes
    for format in u4r u8r u8; do
        volume spikes $format
        draw $format spikes
    done
    for metric in rmse worst_tile; do
        row "u4r" "smooth fog with a dense voxel in every other brick" \
            "4 bits; a range per brick" $metric "$(error $metric truth u4r)" \
            1/255 "reference; float voxels" "u8r" "$(error $metric truth u8r)"
    done
    row "u8" "smooth fog with a dense voxel in every other brick" \
        "8 bits; one range" rmse "$(error rmse truth u8)" 1/255 \
        "reference; float voxels" "u8r" "$(error rmse truth u8r)"
    heat heat truth u4r 10
    picture 1 u4r.pfm heat.png truth.pfm
}
claim_brick_seams() { claim_better 1 3; claim_better 2 3; }

## Few grey levels

# FLIP, since the eye judges: dithering trades bands for noise, which RMSE
# counts against it.
unit_few_levels()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 26
sun = 40 30
density_scale = 0.3
light_density_scale = 0.05
light = uniform
light_samples = 64
light_step = 1
filter = trilinear
output = srgb
background = 0.1"
    for bits in 1 2 4; do
        for dither in off on; do
            quiet "$brume" render "$work/cloud.brume" --scene "$work/scene" \
                --pixels l$bits --set dither=$dither --set noise=blue \
                -o "$work/l$bits$dither.png"
        done
    done
    quiet "$brume" render "$work/cloud.brume" --scene "$work/scene" \
        --pixels l8 -o "$work/l8.png"
    for bits in 1 2 4; do
        row "l$bits; no dithering" "lit cloud" "$bits bits; sRGB" flip \
            "$(flip l8 l${bits}off)" "FLIP; 0 to 1" "8 bits" "dither; blue" \
            "$(flip l8 l${bits}on)"
    done
    picture 1 l2off.png l2on.png l8.png
}
flip()
{
    "$brume" compare "$work/$1.png" "$work/$2.png" --metrics flip |
        sed 's/^.*=//'
}
claim_few_levels()
{
    for r in 1 2 3; do claim_better $r 2; done
}

## A stochastic lookup in one frame

unit_stochastic_lookup()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 26
density_scale = 0.3
step = 1"
    truth truth cloud --set filter=trilinear
    draw one cloud --set filter=stochastic --set noise=fast
    draw_frames many cloud 31 --set filter=stochastic --set noise=fast \
        --set temporal=ema
    mv "$work/many_31.pfm" "$work/many.pfm"
    row "filter = stochastic" "cloud; unlit" "one frame" rmse \
        "$(error rmse truth one)" 1/255 "reference; trilinear" \
        "ema 0.1; 32 frames" "$(error rmse truth many)"
    heat heat truth one 20
    picture 1 heat.png many.pfm truth.pfm
}
claim_stochastic_lookup() { claim_better 1 2; }
