# SPDX-License-Identifier: MIT
# Where accumulation, noise and filters fail: motion, time, tiles, outlines.

# even: $work/even.8x8x64.raw, a noise that in each of 64 frames is one value
# everywhere: their mean is what any good noise tends to
even()
{
    for k in 0 1 2 3 4 5 6 7; do
        for l in 0 1 2 3 4 5 6 7; do
            head -c 64 /dev/zero |
                tr '\0' "$(printf '\\%03o' $((32 * k + 4 * l + 2)))"
        done
    done >"$work/even.8x8x64.raw"
}

# still: a cloud in steps of 8 that jitter moves, and $work/converged.pfm
still()
{
    even
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 32
density_scale = 0.3
step = 8
jitter = primary"
    draw_frames even cloud 63 --set "noise=$work/even.8x8x64.raw"
    quiet "$atlas" average "$work/even_%d.pfm" 0 63 "$work/converged.pfm"
}

# still_ema NOISE: the last of 32 frames in $work/NOISE.pfm
still_ema()
{
    draw_frames "$1" cloud 31 --set temporal=ema --set "noise=$1"
    mv "$work/$1_31.pfm" "$work/$1.pfm"
}

## IGN under EMA

# How far a frame moves the pattern decides. By 5.588238 on both axes (Jimenez
# 2014) a pixel's jitters are spread well over time, and there is no failure;
# by the thesis's offsets they are not.
unit_ign_ema()
{
    still
    for noise in ign ign-thesis fast golden; do
        still_ema $noise
    done
    for remedy in ign golden; do
        row ign-thesis "cloud at rest; steps of 8" "ema 0.1; 32 frames" rmse \
            "$(error rmse converged ign-thesis)" 1/255 \
            "mean of 64 even jitters" $remedy "$(error rmse converged $remedy)"
    done
    row ign "cloud at rest; steps of 8" "ema 0.1; 32 frames" rmse \
        "$(error rmse converged ign)" 1/255 "mean of 64 even jitters" fast \
        "$(error rmse converged fast)"
    heat heat converged ign-thesis 5
    heat heat_better converged golden 5
    picture 1 heat.png heat_better.png converged.pfm
}
claim_ign_ema()
{
    claim_better 1 1.2
    claim_better 2 1.4
    verdict "ign with its own offsets is as good as fast: $(field 3 value), \
$(field 3 remedy_value)" "$(field 3 value) <= 1.1 * $(field 3 remedy_value)"
}

## Independent blue noise over time

unit_blue_over_time()
{
    still
    for noise in blue-slices white stbn fast; do
        still_ema $noise
    done
    row blue-slices "cloud at rest; steps of 8" "ema 0.1; 32 frames" rmse \
        "$(error rmse converged blue-slices)" 1/255 \
        "mean of 64 even jitters" fast "$(error rmse converged fast)"
    row blue-slices "cloud at rest; steps of 8" "ema 0.1; 32 frames" rmse \
        "$(error rmse converged blue-slices)" 1/255 \
        "mean of 64 even jitters" stbn "$(error rmse converged stbn)"
    row white "cloud at rest; steps of 8" "ema 0.1; 32 frames" rmse \
        "$(error rmse converged white)" 1/255 \
        "mean of 64 even jitters" fast "$(error rmse converged fast)"
    heat heat converged blue-slices 10
    heat heat_fast converged fast 10
    picture 1 heat.png heat_fast.png converged.pfm
}
claim_blue_over_time() { claim_better 1 1.2; claim_better 2 1.1; }

## Tiles of noise

# A face at one distance from the eye: all that a ray can be wrong by is its
# jitter, so a table shows as itself.
# tiles NOISE SIDE REMEDY: a row
tiles()
{
    row "$1" "flat face; steps of 32" "one frame; $2 pixels aside" repeats \
        "$("$atlas" repeats "$work/converged.pfm" "$work/$1.pfm" "$2")" \
        correlation "0 for noise that does not repeat" "$3" \
        "$("$atlas" repeats "$work/converged.pfm" "$work/$3.pfm" "$2")"
}

unit_noise_tiling()
{
    even
    volume block
    scene "eye = 32,32,1000
target = 32,32,32
fov = 2
density_scale = 0.05
step = 32
jitter = primary"
    draw_frames even block 63 --set "noise=$work/even.8x8x64.raw"
    quiet "$atlas" average "$work/even_%d.pfm" 0 63 "$work/converged.pfm"
    for noise in white8 fast-small fast white; do
        draw $noise block --set noise=$noise
    done
    tiles white8 8 fast
    tiles fast-small 32 fast
    tiles fast 64 white
    picture 1 white8.pfm white.pfm converged.pfm
}
claim_noise_tiling()
{
    for r in 1 2 3; do
        claim_breaks $r 0.7
        claim_within $r remedy_value 0.1
    done
}

## Ghosts of a moving camera

# pan FRAME: where the target is
pan() { calc "12 + 2.5 * $1"; }

unit_ema_ghosting()
{
    volume cloud
    scene "eye = 32,32,150
fov = 30
density_scale = 0.3
step = 4"
    printf '[0]\ntarget = 12,32,32\n[15]\ntarget = %s,32,32\n' "$(pan 15)" \
        >"$work/path"
    for temporal in none ema taa; do
        draw_frames $temporal cloud 15 --path "$work/path" \
            --set jitter=primary --set noise=fast --set subpixel=off \
            --set temporal=$temporal
    done
    for k in 12 13 14 15; do
        truth truth_$k cloud --set step=0.25 \
            --set "target=$(pan $k),32,32"
    done
    for metric in ghosting lag; do
        case $metric in lag) of=frames ;; *) of=1/255 ;; esac
        row "ema 0.1" "camera pans 3 pixels a frame" "frames 12 to 15" \
            $metric "$(error_over $metric truth_%d ema_%d 12:15)" $of \
            "reference; step 0.25" taa \
            "$(error_over $metric truth_%d taa_%d 12:15)"
    done
    row "ema 0.1" "camera pans 3 pixels a frame" "frames 12 to 15" ghosting \
        "$(error_over ghosting truth_%d ema_%d 12:15)" 1/255 \
        "reference; step 0.25" "no history" \
        "$(error_over ghosting truth_%d none_%d 12:15)"
    picture 1 ema_15.pfm taa_15.pfm truth_15.pfm
}
claim_ema_ghosting() { claim_better 1 3; claim_better 2 3; claim_better 3 3; }

## Lag behind a moving sun

unit_ema_lag()
{
    volume cloud
    scene "eye = 32,60,150
target = 32,32,32
fov = 32
density_scale = 0.5
light_density_scale = 0.2
light = uniform
light_samples = 32
light_step = 1
step = 2"
    printf '[0]\nsun = 0 20\n[31]\nsun = 155 20\n' >"$work/path"
    draw_frames slow cloud 31 --path "$work/path" --set temporal=ema \
        --set jitter=primary --set noise=fast
    draw_frames fast cloud 31 --path "$work/path" --set temporal=ema \
        --set jitter=primary --set noise=fast --set alpha=0.5
    for k in 28 29 30 31; do
        truth truth_$k cloud --set step=0.5 --set "sun=$((5 * k)) 20"
    done
    for metric in lag ghosting; do
        case $metric in lag) of=frames ;; *) of=1/255 ;; esac
        row "ema 0.1" "the sun moves 5 degrees a frame" "frames 28 to 31" \
            $metric "$(error_over $metric truth_%d slow_%d 28:31)" $of \
            "reference; step 0.5" "ema 0.5" \
            "$(error_over $metric truth_%d fast_%d 28:31)"
    done
    picture 1.5 slow_31.pfm fast_31.pfm truth_31.pfm
}
claim_ema_lag() { claim_better 1 3; claim_better 2 2; }

## Small things in motion under TAA

unit_taa_small()
{
    volume dots
    scene "eye = 32,32,150
fov = 40
density_scale = 8
step = 0.5
jitter = primary
noise = fast
subpixel = on"
    printf '[0]\ntarget = 22,30,32\n[15]\ntarget = 37,32.5,32\n' >"$work/path"
    for temporal in none taa; do
        draw_frames $temporal dots 15 --path "$work/path" \
            --set temporal=$temporal
    done
    for k in 12 13 14 15; do
        scene "eye = 32,32,150
size = 416x312
fov = 40
density_scale = 8
step = 0.25
target = $((22 + k)),$(calc "30 + $k / 6"),32"
        truth big_$k dots
    done
    for temporal in none taa; do
        for k in 12 13 14 15; do mean_of ${temporal}_$k; done >"$work/means"
        calc "($(tr '\n' '+' <"$work/means")0) / 4" >"$work/$temporal.mean"
    done
    for k in 12 13 14 15; do mean_of big_$k; done >"$work/means"
    whole=$(calc "($(tr '\n' '+' <"$work/means")0) / 4")
    row taa "single voxels; half a pixel wide" \
        "camera pans a pixel a frame" light_lost \
        "$(calc "100 * (1 - $(cat "$work/taa.mean") / $whole)")" "%" \
        "reference; 16 rays a pixel" "no history" \
        "$(calc "100 * (1 - $(cat "$work/none.mean") / $whole)")"
    scene "eye = 32,32,150
fov = 40
density_scale = 8
step = 0.25
target = 37,32.5,32"
    truth shown dots
    picture 2 taa_15.pfm none_15.pfm shown.pfm
}
claim_taa_small() { claim_breaks 1 20; claim_better 1 2; }

## Outlines under a blur

# Light in the column of sky left of a block, which is opaque.
beside() { "$atlas" mean "$work/$1.pfm" 20 25 21 53; }

unit_blur_outline()
{
    volume block
    scene "eye = 32,32,150
target = 31.5,31.5,32
fov = 36
density_scale = 4
step = 0.5"
    truth truth block
    for spatial in box3 box5 bilateral15; do
        draw plain_$spatial block --set spatial=$spatial \
            --set edge_falloff=0
        draw aware_$spatial block --set spatial=$spatial \
            --set edge_falloff=16
        row "$spatial" "opaque block before a dark sky" "edge_falloff 0" \
            light_beside "$(beside plain_$spatial)" 1/255 \
            "$(beside truth) in the reference" "edge_falloff 16" \
            "$(beside aware_$spatial)"
    done
    heat heat truth plain_box5 128
    picture 1 plain_box5.pfm aware_box5.pfm truth.pfm
}
claim_blur_outline()
{
    for r in 1 2 3; do claim_better $r 10; done
}

## Few rays in motion

# bayer4 marches one ray of sixteen: what it holds history to spans 12 x 12.
unit_sparse_rays()
{
    volume cloud
    scene "eye = 32,32,150
fov = 30
density_scale = 0.3
step = 4"
    printf '[0]\ntarget = 12,32,32\n[15]\ntarget = %s,32,32\n' "$(pan 15)" \
        >"$work/path"
    for update in bayer4 checker; do
        draw_frames $update cloud 15 --path "$work/path" \
            --set jitter=primary --set noise=fast --set subpixel=off \
            --set temporal=taa --set update=$update
    done
    for k in 12 13 14 15; do
        truth truth_$k cloud --set step=0.25 \
            --set "target=$(pan $k),32,32"
    done
    row "taa; update = bayer4" "camera pans 3 pixels a frame" \
        "frames 12 to 15" ghosting \
        "$(error_over ghosting truth_%d bayer4_%d 12:15)" 1/255 \
        "reference; step 0.25" "update = checker" \
        "$(error_over ghosting truth_%d checker_%d 12:15)"
    row "taa; update = bayer4" "camera pans 3 pixels a frame" \
        "frames 12 to 15" flicker \
        "$(error_over flicker truth_%d bayer4_%d 12:15)" 1/255 \
        "reference; step 0.25" "update = checker" \
        "$(error_over flicker truth_%d checker_%d 12:15)"
    picture 1 bayer4_15.pfm checker_15.pfm truth_15.pfm
}
claim_sparse_rays() { claim_better 1 2; claim_better 2 2; }

## Low resolution at outlines

unit_low_resolution()
{
    volume block
    scene "eye = 100,70,130
target = 32,32,32
fov = 36
density_scale = 1
step = 0.5"
    truth truth block
    draw full block
    for resolution in half quarter; do
        for upsample in bilinear aware; do
            draw $resolution$upsample block --set resolution=$resolution \
                --set upsample=$upsample
            row "resolution = $resolution; $upsample" "opaque block" \
                "one frame" rmse \
                "$(error rmse truth $resolution$upsample)" 1/255 \
                "reference; full" "resolution = full" \
                "$(error rmse truth full)"
        done
    done
    picture 1 quarterbilinear.pfm quarteraware.pfm truth.pfm
}
claim_low_resolution()
{
    for r in 1 2 3 4; do claim_better $r 5; done
    verdict "aware ($(field 4 value)) does not help an opaque edge over \
bilinear ($(field 3 value))" "$(field 4 value) >= 0.98 * $(field 3 value)"
}

## A short history in few bits

unit_eight_bit_history()
{
    still
    for bits in 8 16; do
        draw_frames b$bits cloud 255 --set temporal=ema \
            --set alpha=0.015625 --set noise=fast --set history_bits=$bits
    done
    row "ema; 8 bits" "cloud at rest; steps of 8" "alpha 1/64; frames 224 on" \
        deviation "$(error_over deviation converged b8_%d 224:255)" 1/255 \
        "mean of 64 even jitters" "history_bits 16" \
        "$(error_over deviation converged b16_%d 224:255)"
    row "ema; 8 bits" "cloud at rest; steps of 8" "alpha 1/64; frame 255" \
        rmse "$(error rmse converged b8_255)" 1/255 \
        "mean of 64 even jitters" "history_bits 16" \
        "$(error rmse converged b16_255)"
    heat heat8 converged b8_255 5
    heat heat16 converged b16_255 5
    picture 1 heat8.png heat16.png converged.pfm
}
claim_eight_bit_history() { claim_better 1 3; claim_better 2 2; }
