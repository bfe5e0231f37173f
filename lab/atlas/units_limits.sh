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
