# SPDX-License-Identifier: MIT
# Where marching fails: steps, thin things, early ends, leaps.

## Banding

unit_banding()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
density_scale = 0.04"
    truth truth block --set step=0.25
    draw bare block --set step=8
    draw_ema ema block --set step=8
    row "no jitter" "block; unlit" "step 8" rmse "$(error rmse truth bare)" \
        1/255 "reference; step 0.25" "jitter; fast; ema 32 frames" \
        "$(error rmse truth ema)"
    row "no jitter" "block; unlit" "step 8" worst_tile \
        "$(error worst_tile truth bare)" 1/255 "reference; step 0.25" \
        "jitter; fast; ema 32 frames" "$(error worst_tile truth ema)"
    picture 1 bare.pfm ema.pfm truth.pfm
}
claim_banding() { claim_better 1 3; claim_better 2 3; }

## Steps from 1/16 to 64

unit_steps()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 32
density_scale = 0.3"
    truth truth cloud --set step=0.0625
    for step in 0.0625 0.25 1 4 16 64; do
        draw "step$step" cloud --set step=$step
        draw_ema "ema$step" cloud --set step=$step
        row "no jitter" "cloud; unlit" "step $step" rmse \
            "$(error rmse truth "step$step")" 1/255 \
            "reference; step 1/16" "jitter; fast; ema 32 frames" \
            "$(error rmse truth "ema$step")"
    done
    row "jitter; fast; ema 32 frames" "cloud; unlit" "step 64" rmse \
        "$(error rmse truth ema64)" 1/255 "reference; step 1/16" \
        "step 4; jitter; fast; ema 32 frames" "$(error rmse truth ema4)"
    picture 1 step16.pfm ema16.pfm truth.pfm
}
# Jitter is no remedy for a step as long as the volume: opacity is no linear
# function of what a sample finds.
claim_steps()
{
    claim_within 1 value 0.35
    claim_better 4 3
    claim_better 5 2
    claim_breaks 6 10
    claim_better 7 10
}

## Thin things

unit_thin_sheet()
{
    volume sheet
    scene "eye = 32,32,100
target = 32,32,17
fov = 44
density_scale = 0.8"
    truth truth sheet --set step=0.0625
    draw bare sheet --set step=4
    draw_ema ema sheet --set step=4
    draw fine sheet --set step=0.25
    row "no jitter" "sheet 1 voxel thick" "step 4" rmse \
        "$(error rmse truth bare)" 1/255 "reference; step 1/16" "step 0.25" \
        "$(error rmse truth fine)"
    row "no jitter" "sheet 1 voxel thick" "step 4" rmse \
        "$(error rmse truth bare)" 1/255 "reference; step 1/16" \
        "jitter; fast; ema 32 frames" "$(error rmse truth ema)"
    row "jitter; fast; ema 32 frames" "sheet 1 voxel thick" "step 4" mean \
        "$(error mean truth ema)" 1/255 "reference; step 1/16" "step 0.25" \
        "$(error mean truth fine)"
    picture 1 bare.pfm ema.pfm truth.pfm
}
claim_thin_sheet() { claim_better 1 3; claim_better 2 1.5; claim_breaks 3 5; }

unit_single_voxels()
{
    volume dots
    scene "eye = 32,32,150
target = 32,32,32
fov = 30
density_scale = 8"
    truth truth dots --set step=0.0625
    draw bare dots --set step=4
    draw fine dots --set step=0.25
    row "no jitter" "single voxels" "step 4" light_lost \
        "$(calc "100 * (1 - $(mean_of bare) / $(mean_of truth))")" "%" \
        "reference; step 1/16" "step 0.25" \
        "$(calc "100 * (1 - $(mean_of fine) / $(mean_of truth))")"
    row "no jitter" "single voxels" "step 4" rmse "$(error rmse truth bare)" \
        1/255 "reference; step 1/16" "step 0.25" "$(error rmse truth fine)"
    picture 1 bare.pfm fine.pfm truth.pfm
}
claim_single_voxels() { claim_better 1 3; claim_better 2 3; }

## Early exit

unit_early_exit()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
density_scale = 0.1
albedo = 0
background = 1
step = 0.5"
    truth truth block
    for t in 0.05 0.01 0.001; do
        draw "exit$t" block --set min_transmittance=$t
    done
    for t in 0.05 0.01; do
        row "early exit" "dark block; white sky" "min_transmittance $t" max \
            "$(error max truth "exit$t")" 1/255 "reference; no exit" \
            "min_transmittance 0.001" "$(error max truth exit0.001)"
    done
    picture 6 exit0.05.pfm exit0.001.pfm truth.pfm
}
claim_early_exit() { claim_better 1 3; }

## Density threshold

unit_min_density()
{
    scene "eye = 32,32,400
target = 32,32,128
fov = 20
density_scale = 0.5
step = 4"
    for k in 1 2 3 4; do
        volume veil$k
        truth truth_$k veil$k --set step=1
        draw pops_$k veil$k --set min_density=0.01
        draw all_$k veil$k --set min_density=0
    done
    for metric in flicker ghosting; do
        row "min_density 0.01" "thickening veil 248 deep" \
            "density 1/255 to 4/255" $metric \
            "$(error_over $metric truth_%d pops_%d 1:4)" 1/255 \
            "reference; step 1" "min_density 0" \
            "$(error_over $metric truth_%d all_%d 1:4)"
    done
    picture 1 pops_2.pfm all_2.pfm truth_2.pfm
}
claim_min_density() { claim_better 1 20; claim_better 2 20; }

## Leaps

# The same view as the straight one of brume-atlas leap, from far away.
unit_leaps()
{
    volume strands
    scene "size = 104x104
eye = 31.5,31.5,-1000
target = 31.5,31.5,21
up = 0,-1,0
fov = 3.59
density_scale = 1
step = 1"
    quiet "$atlas" leap strands "$work/exact.pfm" 104 1 1 1 64
    for large in 2 8 16; do
        quiet "$atlas" leap strands "$work/leap$large.pfm" 104 $large 1 1 64
    done
    draw on strands --set skip=on
    draw off strands --set skip=off
    for large in 2 8 16; do
        row "large steps; one back" "strands 2 voxels thick" \
            "large $large; small 1" light_lost \
            "$(calc "100 * (1 - $(mean_of leap$large) / $(mean_of exact))")" \
            "%" "small steps all the way" "leaps on brume's lattice" \
            "$(calc "100 * (1 - $(mean_of on) / $(mean_of off))")"
    done
    row "leaps on brume's lattice" "strands 2 voxels thick" "skip on" max \
        "$(error max off on)" 1/255 "skip off" "none needed" 0
    picture 1 leap16.pfm on.pfm exact.pfm
}
claim_leaps()
{
    claim_breaks 3 25
    claim_within 3 remedy_value 0
    claim_within 4 value 0
}
