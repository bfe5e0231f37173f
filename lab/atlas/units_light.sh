# SPDX-License-Identifier: MIT
# Where light fails: what doubling steps leave out, and low or aligned suns.

## Far shadows

unit_far_shadows()
{
    volume roof
    scene "eye = 120,80,140
target = 32,14,32
fov = 32
sun = 0 90
density_scale = 0.5
light_density_scale = 0.4
step = 0.5
light_step = 1"
    truth truth roof --set light=uniform --set light_samples=256 \
        --set light_step=0.25
    draw log5 roof --set light=log --set light_samples=5
    draw log6 roof --set light=log --set light_samples=6
    draw cache roof --set light=cache --set cache_spacing=2
    draw uniform roof --set light=uniform --set light_samples=64
    for n in 5 6; do
        row "light = log" "roof 23 voxels above its shadow" \
            "$n samples; light_step 1" rmse "$(error rmse truth log$n)" 1/255 \
            "reference; 256 of 0.25" "uniform; 64 of 1 voxel" \
            "$(error rmse truth uniform)"
        row "light = log" "roof 23 voxels above its shadow" \
            "$n samples; light_step 1" mean "$(error mean truth log$n)" 1/255 \
            "reference; 256 of 0.25" "light = cache; spacing 2" \
            "$(error mean truth cache)"
    done
    picture 1 log6.pfm uniform.pfm truth.pfm
}
claim_far_shadows()
{
    for r in 1 2 3 4; do claim_better $r 2; done
}

# On a real cloud near shadows are left out, and far ones are counted by one
# sample for half of the way: some places too bright, others too dark.
unit_real_cloud_log()
{
    if ! real_volume wdas_cloud_sixteenth.vdb; then
        skip wdas_cloud_sixteenth.vdb
        return
    fi
    scene "eye = 572.6,280.5,967.4
target = -10,75,-41.67
fov = 16
sun = -60 30
density_scale = 0.2
light_density_scale = 0.07
filter = trilinear
step = 1
light_step = 1"
    truth truth real --set light=uniform --set light_samples=256 \
        --set light_step=1
    draw log real --set light=log --set light_samples=8
    draw cone real --set light=cone --set light_samples=10
    draw cache real --set light=cache --set cache_spacing=2
    for metric in mean rmse; do
        row "light = log" "Disney cloud at 1/16" "8 samples; light_step 1" \
            $metric "$(error $metric truth log)" 1/255 \
            "reference; 256 of 1 voxel" "light = cone; 10 samples" \
            "$(error $metric truth cone)"
    done
    row "light = log" "Disney cloud at 1/16" "8 samples; light_step 1" rmse \
        "$(error rmse truth log)" 1/255 "reference; 256 of 1 voxel" \
        "light = cache; spacing 2" "$(error rmse truth cache)"
    picture 1 log.pfm cone.pfm truth.pfm
}
claim_real_cloud_log() { claim_better 2 3; claim_better 3 3; }

## The missing first segment

# What log leaves out at any depth is [0, light_step): the lit face of a block
# is exp(light_step * extinction) too bright.
unit_first_segment()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
sun = 40 35
density_scale = 0.2
light_density_scale = 0.1
step = 0.5"
    truth truth block --set light=uniform --set light_samples=400 \
        --set light_step=0.25
    draw uniform block --set light=uniform --set light_samples=100 \
        --set light_step=1
    for s in 1 4 8; do
        draw log$s block --set light=log --set light_samples=8 \
            --set light_step=$s
        row "light = log" "block" "8 samples; light_step $s" mean \
            "$(error mean truth log$s)" 1/255 "reference; 400 of 0.25" \
            "uniform; 100 of 1 voxel" "$(error mean truth uniform)"
    done
    picture 1 log8.pfm uniform.pfm truth.pfm
}
claim_first_segment() { claim_breaks 2 5; claim_better 2 4; claim_better 3 4; }

## A coarse cache

# Optical depth is a straight line between the points of a cache: an edge of
# the volume is as soft as they are far apart.
unit_coarse_cache()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
sun = 75 20
density_scale = 1
light_density_scale = 0.3
step = 0.5"
    truth truth block --set light=uniform --set light_samples=400 \
        --set light_step=0.25
    draw uniform block --set light=uniform --set light_samples=64 \
        --set light_step=1
    for s in 2 4 8; do
        draw cache$s block --set light=cache --set cache_spacing=$s
        row "light = cache" "hard-edged block" "spacing $s" rmse \
            "$(error rmse truth cache$s)" 1/255 "reference; 400 of 0.25" \
            "uniform; 64 of 1 voxel" "$(error rmse truth uniform)"
    done
    picture 1 cache8.pfm uniform.pfm truth.pfm
}
claim_coarse_cache() { claim_better 1 2; claim_better 3 4; }

## Low sun

unit_grazing_sun()
{
    volume plain
    scene "eye = 150,70,40
target = 24,10,128
fov = 50
sun = 0 1
density_scale = 0.1
light_density_scale = 0.02
step = 1"
    truth truth plain --set light=uniform --set light_samples=1024 \
        --set light_step=0.25
    draw near plain --set light=uniform --set light_samples=16 \
        --set light_step=1
    draw far plain --set light=uniform --set light_samples=64 \
        --set light_step=4
    draw log plain --set light=log --set light_samples=9 --set light_step=1
    row "light = uniform" "240 voxels along the sun" "16 samples of 1 voxel" \
        mean "$(error mean truth near)" 1/255 "reference; 1024 of 0.25" \
        "uniform; 64 of 4 voxels" "$(error mean truth far)"
    row "light = log" "240 voxels along the sun" "9 samples; light_step 1" \
        rmse "$(error rmse truth log)" 1/255 "reference; 1024 of 0.25" \
        "uniform; 64 of 4 voxels" "$(error rmse truth far)"
    picture 1.5 near.pfm far.pfm truth.pfm
}
claim_grazing_sun() { claim_better 1 3; claim_better 2 3; }

## Sun on the camera's axis

# The sun straight ahead and straight behind, and 15 degrees aside: light
# rays that lie on view rays meet the same lattice, and divide by no component.
unit_sun_axis()
{
    volume cloud
    for azimuth in 0 15 180; do
        scene "eye = 31.5,31.5,170
target = 31.5,31.5,31.5
fov = 30
sun = $azimuth 0
density_scale = 0.3
light_density_scale = 0.1
step = 1
light = uniform
light_samples = 64
light_step = 1"
        truth truth$azimuth cloud
        draw on$azimuth cloud
        case $azimuth in 0) where=behind ;; 15) where=aside ;; *) where=ahead ;;
        esac
        row "brume's integers" "cloud; the sun $where" "azimuth $azimuth" \
            rmse "$(error rmse truth$azimuth on$azimuth)" 1/255 \
            "reference; same lattice" "none needed" 0
    done
    # Against the light a phase function's peak is beyond what a picture holds.
    for exposure in 1 0.00390625; do
        truth peak_truth$exposure cloud --set sun="180 0" --set phase=hg:0.9 \
            --set exposure=$exposure
        draw peak$exposure cloud --set sun="180 0" --set phase=hg:0.9 \
            --set exposure=$exposure
    done
    row "phase = hg:0.9" "cloud; the sun ahead" "exposure 1" rmse \
        "$(error rmse peak_truth1 peak1)" 1/255 \
        "reference; which holds light up to 8" "exposure 1/256" \
        "$(error rmse peak_truth0.00390625 peak0.00390625)"
    picture 1 peak1.pfm peak0.00390625.pfm peak_truth0.00390625.pfm
}
claim_sun_axis()
{
    for r in 1 2 3; do claim_within $r value 0.35; done
    claim_better 4 100
}
