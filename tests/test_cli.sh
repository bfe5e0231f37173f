#!/bin/sh
# SPDX-License-Identifier: MIT
#
# The programs as a user meets them: words, exit statuses, files and what is
# left of them. BUILD is the folder of brume, brume-bake and brume-cloud.
#
# Lists of options are split into words on purpose:
# shellcheck disable=SC2086
BUILD=${BUILD:-build}
. "$(dirname "$0")/lib.sh"
brume=$BUILD/brume bake=$BUILD/brume-bake cloud=$BUILD/brume-cloud
. "$(dirname "$0")/cli_lib.sh"
volume=$work/cloud.brume
small="--set size=80x60 --set light_samples=8"

## Tools

# renders OUT ARGUMENT...: a small picture in a moment
renders()
{
    file=$1
    shift
    runs "$brume" render "$volume" $small "$@" -o "$work/$file"
}

# no_picture STATUS PATTERN ARGUMENT...: of brume render
no_picture()
{
    want=$1 pattern=$2
    shift 2
    fails "$want" "$pattern" "$brume" render "$@" -o "$none/out.png"
}

# hash_of ARGUMENT...: the line that --hash prints
hash_of()
{
    "$brume" render "$volume" $small "$@" --hash 2>&1
}

same_hash()
{
    [ "$1" = "$2" ] && echo "$1" | grep -Eqx 'crc32=[0-9a-f]{8}' && return
    echo "# $1 and $2"
    return 1
}

# measure NAME A B: one figure of brume compare
measure()
{
    "$brume" compare "$work/$2" "$work/$3" | sed -n "s/^$1=//p"
}

# at_most A B, for numbers with a point
at_most() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a <= b) }'; }

## Help

helps()
{
    runs "$@" --help && head -n 1 "$out" | grep -q '^usage: brume'
}

test_help()
{
    check "brume --help" helps "$brume"
    for command in render info compare; do
        check "brume $command --help" helps "$brume" $command
    done
    check "brume-bake --help" helps "$bake"
    check "brume-cloud --help" helps "$cloud"
    runs "$brume" render --help
    for key in size eye fov sun density_scale filter light noise skip; do
        grep -q "^  $key " "$out" || echo "$key"
    done >"$work/missing"
    check "brume render --help lists the keys" [ ! -s "$work/missing" ]
    runs "$brume" --version
    check "brume --version" grep -Eqx 'brume [0-9]+\.[0-9]+\.[0-9]+' "$out"
}

## Usage

no_arguments()
{
    "$@" >"$out" 2>"$err"
    status=$?
    [ $status -eq 2 ] && [ ! -s "$out" ] && [ -s "$err" ]
}

test_usage()
{
    check "brume alone: usage on stderr" no_arguments "$brume"
    check "brume-bake alone" no_arguments "$bake"
    check "brume-cloud alone" no_arguments "$cloud"
    for command in render info compare; do
        check "brume $command alone" fails 2 "^brume $command: " \
            "$brume" $command
        check "brume $command --bogus" fails 2 '--bogus' \
            "$brume" $command --bogus
    done
    check "unknown command" fails 2 "no command 'paint'" "$brume" paint
    check "unknown option behind a volume" no_picture 2 'unknown.*--bogus' \
        "$volume" --bogus
    check "option without a value" fails 2 'no value after --set' \
        "$brume" render "$volume" --set
    check "no output" fails 2 'no -o' "$brume" render "$volume"
    check "two volumes" no_picture 2 'unexpected argument' "$volume" "$volume"
    for n in 0 257 -1 2x '' 1e1 99999999999999999999; do
        check "--threads '$n'" no_picture 2 '--threads is 1 to 256' \
            "$volume" --threads "$n"
    done
    check "info of two volumes" fails 2 'unexpected' \
        "$brume" info "$volume" "$volume"
}

## Volumes that are none

make_bad_volumes()
{
    bytes=$(wc -c <"$volume")
    : >"$work/empty.brume"
    mkdir "$work/folder.brume"
    printf 'a text, and longer than the sixteen bytes\n' >"$work/text.brume"
    for n in 3 15 175 300 $((bytes / 2)) $((bytes - 1)); do
        head -c "$n" "$volume" >"$work/cut$n.brume"
    done
    cp "$volume" "$work/crc.brume"
    printf 'abcd' |
        dd of="$work/crc.brume" bs=1 seek=12 conv=notrunc 2>"$work/log"
    cp "$volume" "$work/major.brume"
    printf '\002' |
        dd of="$work/major.brume" bs=1 seek=4 conv=notrunc 2>"$work/log"
    cat "$volume" "$volume" >"$work/long.brume"
}

# Both commands that read volumes.
refuse_volume()
{
    check "render: $1" no_picture 2 "$2" "$work/$3"
    check "info: $1" fails 2 "$2" "$brume" info "$work/$3"
}

test_volumes()
{
    make_bad_volumes
    refuse_volume "a missing volume" 'none\.brume: No such file' none.brume
    refuse_volume "a folder" 'folder\.brume: not a regular file' folder.brume
    refuse_volume "an empty file" 'empty\.brume: the file is empty' empty.brume
    refuse_volume "a text" 'text\.brume: not a brume asset' text.brume
    refuse_volume "a wrong checksum" 'crc\.brume: .*checksum' crc.brume
    refuse_volume "another major version" 'major.brume: .*version' major.brume
    for n in 3 15 175 300 $((bytes / 2)) $((bytes - 1)); do
        refuse_volume "$n of $bytes bytes" "cut$n.brume: .*truncated" \
            "cut$n.brume"
    done
    check "bytes behind a volume do no harm" runs "$brume" info \
        "$work/long.brume"
}

## Scenes

test_scenes()
{
    printf '# a scene\n\nfoo = 1\n' >"$work/key.scene"
    printf 'fov = 40\r\nstep = 0x10\r\n' >"$work/value.scene"
    printf 'fov = 40\n\n\neye = 1e8,0,0\n' >"$work/far.scene"
    check "an unknown key, by file and line" no_picture 2 \
        "key\.scene:3: unknown key 'foo'" "$volume" --scene "$work/key.scene"
    check "a bad value, by file and line" no_picture 2 \
        'value\.scene:2: step is a number' \
        "$volume" --scene "$work/value.scene"
    check "an eye too far, by file and line" no_picture 2 \
        'far\.scene:4: eye is' "$volume" --scene "$work/far.scene"
    check "a missing scene" no_picture 2 'no\.scene: No such file' \
        "$volume" --scene "$work/no.scene"
    check "a folder as scene" no_picture 2 'directory' \
        "$volume" --scene "$work"
    check "--set of an unknown key" no_picture 2 "--set: unknown key 'foo'" \
        "$volume" --set foo=1
    check "--set without '='" no_picture 2 "--set: no '='" "$volume" --set fov
    check "--set out of range" no_picture 2 '--set: fov is 999, outside' \
        "$volume" --set fov=999
    check "--set of two lines" no_picture 2 '--set: ' "$volume" \
        --set "foo
bar"
    check "log with 17 samples" no_picture 2 'log takes up to 16' \
        "$volume" --set light=log --set light_samples=17
    check "cone without mips" no_picture 2 \
        '--set: light = cone needs a volume that was baked with --mips' \
        "$volume" --set light=cone
    check "a phase function that is none" no_picture 2 \
        '--set: phase is one of isotropic hg:G' "$volume" --set phase=mie
    printf 'octaves = 8\n\nphase = droplet:60\n' >"$work/phase.scene"
    check "a droplet too large, by file and line" no_picture 2 \
        'phase\.scene:3: phase: MICROMETRES of droplet is 60, outside' \
        "$volume" --scene "$work/phase.scene"
    wide=$(hash_of --set fov=60)
    echo 'fov = 60' >"$work/wide.scene"
    check "a scene and --set say the same" \
        same_hash "$wide" "$(hash_of --scene "$work/wide.scene")"
    check "--set after the scene wins" \
        same_hash "$(hash_of --set fov=30)" \
        "$(hash_of --scene "$work/wide.scene" --set fov=30)"
    check "a scene after --set wins" \
        same_hash "$wide" \
        "$(hash_of --set fov=30 --scene "$work/wide.scene")"
    check "and fov is seen at all" [ "$wide" != "$(hash_of)" ]
}

## Output that fails

# A file-size limit of one block, whose signal is ignored: write() fails.
under_limit()
(
    trap '' XFSZ
    ulimit -f 1
    "$@"
)

keeps_old_picture()
{
    cp "$work/default.png" "$none/out.png"
    "$brume" render "$volume" --set light=log --set light_samples=17 \
        -o "$none/out.png" 2>"$err"
    [ "$(ls -A "$none")" = out.png ] &&
        cmp "$work/default.png" "$none/out.png"
}

test_output_errors()
{
    for name in out.jpg out out.png.txt png; do
        check "-o $name" fails 2 'png' "$brume" render "$volume" \
            -o "$none/$name"
    done
    mkdir "$work/taken.png"
    check "a folder that is not there" fails 1 'no/such/out\.png' \
        "$brume" render "$volume" $small -o "$none/no/such/out.png"
    check "a file as folder" fails 1 'cloud\.brume/out\.png' \
        "$brume" render "$volume" $small -o "$volume/out.png"
    check "a folder of the picture's name" fails 1 'taken\.png' \
        "$brume" render "$volume" $small -o "$work/taken.png"
    check "a colour .pgm" fails 1 'out\.pgm' "$brume" render "$volume" $small \
        -o "$none/out.pgm"
    check "a full disk" fails 1 'out\.ppm' under_limit "$brume" render \
        "$volume" $small -o "$none/out.ppm"
    check "--hash of a .pfm" fails 2 '--hash' "$brume" render "$volume" \
        --hash -o "$none/out.pfm"
    mkdir -p "$none"
    check "a failure leaves an older picture alone" keeps_old_picture
    mkdir "$work/locked"
    chmod 500 "$work/locked"
    if [ -w "$work/locked" ]; then
        skip "a folder without permission: this user may write anywhere"
    else
        check "a folder without permission" fails 1 'locked/out\.png' \
            "$brume" render "$volume" $small -o "$work/locked/out.png"
    fi
}

# full STATUS COMMAND...: one line on stderr when stdout is full
full()
{
    want=$1
    shift
    "$@" 2>"$err" >/dev/full
    status=$?
    [ $status -eq "$want" ] && [ "$(wc -l <"$err")" -eq 1 ]
}

test_full_stdout()
{
    if [ ! -c /dev/full ]; then
        skip "a full stdout: no /dev/full"
        return
    fi
    check "info to a full stdout" full 1 "$brume" info "$volume"
    check "--hash to a full stdout" full 1 "$brume" render "$volume" $small \
        --hash
    check "compare to a full stdout" full 2 "$brume" compare \
        "$work/default.png" "$work/default.png"
}

## Pictures

# starts FILE HEX: its first bytes
starts()
{
    [ "$(head -c "${#2}" "$work/$1" | od -An -tx1 | tr -d ' \n' |
        cut -c "1-${#2}")" = "$2" ]
}

# is_pnm FILE MAGIC BYTES: header of 80x60, and pixels of so many bytes
is_pnm()
{
    header=$(printf '%s\n80 60\n255\n' "$2" | wc -c)
    [ "$(head -n 1 "$work/$1")" = "$2" ] &&
        [ "$(wc -c <"$work/$1")" -eq $((header + $3)) ]
}

test_pictures()
{
    grey="--set background=0.2 --set output=linear"
    for format in png ppm pgm pfm; do
            check "a grey .$format" renders grey.$format $grey
    done
    check "a colour .png" renders colour.png
    check "a colour .ppm" renders colour.ppm
    check "a colour .pfm" renders colour.pfm --set output=linear
    check "a colour .pfm is linear whatever is set" renders srgb.pfm \
        --set output=srgb
    check "an extension in capitals" renders CAPITAL.PNG

    check ".png is a PNG" starts colour.png 89504e470d0a1a0a
    check ".ppm is a P6 of its size" is_pnm colour.ppm P6 14400
    check ".pgm is a P5 of its size" is_pnm grey.pgm P5 4800
    check "grey .pfm is a Pf" starts grey.pfm 50660a
    check "colour .pfm is a PF" starts colour.pfm 50460a

    check "png == ppm" at_most "$(measure max colour.png colour.ppm)" 0
    check "grey png == ppm" at_most "$(measure max grey.png grey.ppm)" 0
    check "grey png == pgm" at_most "$(measure max grey.png grey.pgm)" 0
    check "the two .pfm are the same" cmp "$work/colour.pfm" "$work/srgb.pfm"
    # Half a code of rounding; white is 65535/65535 in one, 65536 in the other.
    check "grey pfm == png to half a code" \
        at_most "$(measure max grey.pfm grey.png)" 0.505
    renders linear.png --set output=linear
    check "colour pfm == linear png to half a code" \
        at_most "$(measure max colour.pfm linear.png)" 0.505
    renders clear.png --set density_scale=0
    check "the default scene shows the cloud" \
        at_most 10 "$(measure rmse clear.png colour.png)"
}

## Panels

# codes FILE: how many different bytes the samples of an 80x60 .pgm or .ppm have
codes()
{
    tail -c "$((80 * 60 * $2))" "$work/$1" | od -An -v -tu1 |
        tr -s " " "\n" | sort -u | grep -c .
}

# narrow FORMAT EXTENSION CHANNELS CODES...: a picture of so many codes, at
# most, and not the one of another
narrow()
{
    renders "$1.$2" --pixels "$1" --set dither=on &&
        [ "$(codes "$1.$2" "$3")" -le "$4" ] &&
        [ "$(codes "$1.$2" "$3")" -gt "$5" ]
}

# The mean difference without its sign
mean_of()
{
    measure mean "$1" "$2" | sed 's/-//'
}

test_panels()
{
    check "--pixels rgb332 has 8 codes a channel" narrow rgb332 ppm 3 12 4
    check "--pixels rgb565 has up to 64" narrow rgb565 ppm 3 96 8
    check "--pixels l4 has 16 greys" narrow l4 pgm 1 16 4
    check "--pixels l2 has 4" narrow l2 pgm 1 4 2
    check "--pixels l1 has 2" narrow l1 pgm 1 2 1
    # Dithering keeps the mean of light, so of linear codes.
    renders l8.pgm --pixels l8 --set output=linear
    for format in l4 l2 l1; do
        renders $format.pgm --pixels $format --set dither=on \
            --set output=linear
        check "$format keeps the mean of l8" \
            at_most "$(mean_of $format.pgm l8.pgm)" 1
    done
    check "--pixels rgb888 is what there is without" \
        same_hash "$(hash_of)" "$(hash_of --pixels rgb888)"
    check "1 thread or 7, the same dither" same_hash \
        "$(hash_of --pixels l1 --set dither=on --threads 1)" \
        "$(hash_of --pixels l1 --set dither=on --threads 7)"
    check "--pixels rgba8888" renders rgba.png --pixels rgba8888
    check "is a PNG with alpha" [ \
        "$(od -An -tu1 -j25 -N1 "$work/rgba.png" | tr -d ' ')" = 6 ]
    check "no other file has alpha" fails 2 'rgba8888 goes into .png' \
        "$brume" render "$volume" $small --pixels rgba8888 -o "$none/a.ppm"
    check "no panel shows floats" fails 2 'not of a .pfm' \
        "$brume" render "$volume" $small --pixels l1 -o "$none/a.pfm"
    check "--pixels of another name" no_picture 2 \
        '--pixels is one of rgb888 .*, not grey' "$volume" --pixels grey
}

## Light

# brighter A B: the mean of picture A is above B's
brighter() { at_most 0.5 "$(measure mean "$2" "$1")"; }

test_light()
{
    sky="--set sky=on --set output=filmic"
    check "a sky" renders sky.png $sky
    check "octaves and droplets" renders octaves.png $sky \
        --set octaves=8 --set phase=droplet:10
    renders first.png $sky --set phase=droplet:10
    check "octaves add light" brighter octaves.png first.png
    check "ambient light" renders ambient.png $sky --set ambient=gradient
    check "adds more" brighter ambient.png sky.png
    check "what sees little of the sky gets less" renders sampled.png $sky \
        --set ambient=gradient --set visibility=sampled
    check "than all of it" brighter ambient.png sampled.png
    check "haze" renders haze.png $sky --set haze=40
    renders clear_sky.png $sky --set density_scale=0
    check "fades the cloud into the sky" at_most \
        "$(measure rmse haze.png clear_sky.png)" \
        "$(measure rmse sky.png clear_sky.png)"
    check "filter = stochastic" renders stochastic.png --set filter=stochastic
    renders trilinear.png --set filter=trilinear
    check "is trilinear on average" at_most \
        "$(mean_of stochastic.png trilinear.png)" 2
    check "light = cache" renders cache.png --set light=cache
    check "is the light it was made of" at_most \
        "$(measure rmse cache.png trilinear.png)" 8
    check "with spacing 2 too" renders cache2.png --set light=cache \
        --set cache_spacing=2
    for word in phase=isotropic octaves=1 ambient=none haze=0 sky=off \
        exposure=1; do
        check "$word changes nothing" same_hash "$(hash_of)" \
            "$(hash_of --set $word)"
    done
    check "every kernel gives it alike" same_hash \
        "$(hash_of $sky --kernel scalar)" "$(hash_of $sky --kernel auto)"
    check "light is the same on 1 thread and 7" same_hash \
        "$(hash_of $sky --set light=cache --set haze=40 --threads 1)" \
        "$(hash_of $sky --set light=cache --set haze=40 --threads 7)"
}

## What is baked for light

# on_lit COMMAND...: with the volume that has it
on_lit()
{
    plain_volume=$volume
    volume=$work/lit.brume
    "$@"
    result=$?
    volume=$plain_volume
    return $result
}

test_baked_light()
{
    sky="--set sky=on --set output=filmic --set ambient=gradient"
    sun="--set sun=20,50 --set light=cache"
    fine="--set light=cache --set light_samples=64"
    check "what was baked for light changes nothing else" \
        same_hash "$(hash_of)" "$(on_lit hash_of)"
    check "light = cone" on_lit renders cone.png --set light=cone
    check "is near the uniform one" at_most \
        "$(measure rmse cone.png trilinear.png)" 12
    check "visibility = baked" on_lit renders baked.png $sky \
        --set visibility=baked
    check "is near the sampled one" at_most \
        "$(measure rmse baked.png sampled.png)" 12
    check "a baked cache" on_lit renders baked_cache.png --set light=cache
    renders cache2.png $fine --set cache_spacing=2
    renders cache4.png $fine --set cache_spacing=4
    check "is near one that is computed" at_most \
        "$(measure rmse baked_cache.png cache2.png)" 1
    check "nearer than that of every fourth voxel" at_most \
        "$(measure rmse baked_cache.png cache2.png)" \
        "$(measure rmse baked_cache.png cache4.png)"
    check "for another sun it is not used" \
        same_hash "$(hash_of $sun)" "$(on_lit hash_of $sun)"
    check "nor for another spacing" \
        same_hash "$(hash_of $fine --set cache_spacing=4)" \
        "$(on_lit hash_of $fine --set cache_spacing=4)"
}


test_threads()
{
    one=$(hash_of --threads 1)
    check "--hash prints one line" same_hash "$one" "$(hash_of)"
    for n in 2 7 256; do
        check "$n threads, the same hash as one" \
            same_hash "$one" "$(hash_of --threads $n)"
    done
    renders one.png --threads 1
    renders seven.png --threads 7
    check "and the same file" cmp "$work/one.png" "$work/seven.png"
    check "skip off, the same hash" \
        same_hash "$one" "$(hash_of --set skip=off)"
    check "another frame, another hash" \
        [ "$one" != "$(hash_of --set frame=1)" ]
}

## info

info_names="name format apron bytes cells occupied_cells bricks pool_bytes \
voxels box_voxels box_world origin voxel_size density_max density_mean \
mips sun_cache sky_visibility emission"

has_line()
{
    grep -Eqx "$1" "$out" || { sed 's/^/# /' "$out"; return 1; }
}

test_info()
{
    check "info succeeds" runs "$brume" info "$volume"
    names=$(sed 's/=.*//' "$out" | tr '\n' ' ')
    check "one name=value a line" [ "$names" = "$info_names " ]
    check "the name" has_line 'name=density'
    check "the format" has_line 'format=u8r'
    check "the file's bytes" has_line "bytes=$(($(wc -c <"$volume")))"
    check "the cells" has_line 'cells=[0-9]+x[0-9]+x[0-9]+'
    check "the voxel size" has_line 'voxel_size=0\.5'
    check "the largest density" has_line 'density_max=(1|0\.[0-9]+)'
    runs "$brume" info "$work/apron.brume"
    check "an apron" has_line 'apron=yes'
    check "no mips, no cache" has_line 'mips=no|sun_cache=0'
    runs "$brume" info "$work/lit.brume"
    check "mips" has_line 'mips=yes'
    check "a cache of every second voxel" has_line 'sun_cache=2'
    check "visibility of the sky" has_line 'sky_visibility=yes'
}

# The scene that info prints is the one that render takes by itself.
feeds_back()
{
    runs "$brume" info --scene "$1" && cp "$out" "$work/own.scene" &&
        runs "$brume" render "$1" --scene "$work/own.scene" \
            --set size=80x60 -o "$work/own.png" &&
        runs "$brume" render "$1" --set size=80x60 -o "$work/none.png" &&
        cmp "$work/own.png" "$work/none.png"
}

test_info_scene()
{
    for name in cloud apron u8 u4r sphere voxel; do
        check "$name: info --scene gives the default picture" \
            feeds_back "$work/$name.brume"
    done
}

## compare

compares()
{
    want=$1
    shift
    "$brume" compare "$@" >"$out" 2>"$err"
    status=$?
    [ $status -eq "$want" ] && return
    show
    return 1
}

test_compare()
{
    a=$work/colour.png b=$work/clear.png
    check "compare: 0 for the same" runs "$brume" compare "$a" "$a" \
        --max-rmse 0
    names=$(sed 's/=.*//' "$out" | tr '\n' ' ')
    check "compare: one name=value a line" \
        [ "${names%%ssim*}" = "rmse mean psnr max worst_tile " ]
    check "compare: 0 for others without a limit" compares 0 "$a" "$b"
    check "compare: 0 within the limit" compares 0 "$a" "$b" --max-rmse 255
    check "compare: 1 above it" compares 1 "$a" "$b" --max-rmse 0.5
    check "compare: says so in one line" [ "$(wc -l <"$err")" -eq 1 ]
    check "compare: 2 for a missing file" fails 2 'no\.png' \
        "$brume" compare "$a" "$work/no.png"
    check "compare: 2 for what is no picture" fails 2 'text\.png' \
        "$brume" compare "$a" "$work/text.png"
    check "compare: 2 for another size" fails 2 'sizes differ' \
        "$brume" compare "$a" "$work/large.ppm"
    check "compare: 2 for three pictures" fails 2 'more than two' \
        "$brume" compare "$a" "$a" "$a"
    for limit in -1 nan inf x ''; do
        check "compare: 2 for --max-rmse '$limit'" fails 2 'max-rmse' \
            "$brume" compare "$a" "$a" --max-rmse "$limit"
    done
}

## Data

# make NAME CLOUD-OPTIONS BAKE-OPTIONS
make()
{
    "$cloud" -o "$work/$1.vdb" $2 >"$work/log" 2>&1 &&
        "$bake" "$work/$1.vdb" -o "$work/$1.brume" $3 >>"$work/log" 2>&1 &&
        return
    sed 's/^/# /' "$work/log"
    return 1
}

mkdir "$none"
check "a cloud is modelled and baked" \
    make cloud "--size 48 --voxel-size 0.5" "--format u8r"
check "with an apron" make apron "--size 40" "--apron"
check "in u8" make u8 "--size 40 --type plume" "--format u8"
check "in u4r" make u4r "--size 40 --seed 3" "--format u4r"
check "with all for light" make lit "--size 48 --voxel-size 0.5" \
    "--format u8r --mips --sun-cache 2 --sun -60,30 --sky-visibility \
--sky-extinction 0.3"
check "a sphere" make sphere "--size 24 --type sphere" ""
check "a single voxel" make voxel "--size 16 --type voxel" ""
check "a picture with no scene at all" \
    runs "$brume" render "$volume" -o "$work/default.png"
printf 'a text\n' >"$work/text.png"
renders large.ppm --set size=81x60

test_help
test_usage
test_volumes
test_scenes
test_output_errors
test_full_stdout
test_pictures
test_panels
test_light
test_baked_light
test_threads
test_info
test_info_scene
test_compare
finish
