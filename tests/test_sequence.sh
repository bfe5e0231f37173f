#!/bin/sh
# SPDX-License-Identifier: MIT
#
# Sequences as a user meets them: frames, paths, films, volumes that change,
# and the same bytes for any number of threads and any kernel. BUILD is the
# folder of brume, brume-bake and brume-cloud.
#
# Lists of options are split into words on purpose:
# shellcheck disable=SC2086
BUILD=${BUILD:-build}
. "$(dirname "$0")/lib.sh"
brume=$BUILD/brume bake=$BUILD/brume-bake cloud=$BUILD/brume-cloud
. "$(dirname "$0")/cli_lib.sh"
volume=$work/fire_02.brume
small="--set size=70x50 --set light_samples=8 --set noise=stbn"

## Tools

# draws OUT ARGUMENT...: small frames of the volume, into $work/OUT
draws()
{
    draws_out=$work/$1
    shift
    runs "$brume" render "$volume" $small "$@" -o "$draws_out"
}

# hashes ARGUMENT...: their lines of --hash
hashes()
{
    "$brume" render "$volume" $small "$@" --hash 2>&1
}

# hash_of ARGUMENT...: of a single frame, the bare number
hash_of()
{
    hashes "$@" | sed 's/.*crc32=//'
}

# frame N: the bare hash of frame N in the lines on stdin
frame()
{
    sed -n "s/^frame=$1 crc32=//p"
}

same()
{
    [ -n "$1" ] && [ "$1" = "$2" ] && return
    echo "# '$1' and '$2'" | tr '\n' ' '
    echo
    return 1
}

differs()
{
    [ -n "$1" ] && [ -n "$2" ] && [ "$1" != "$2" ]
}

## Frames

test_frames()
{
    all=$(hashes --frames 8:11)
    check "a line for each frame" \
        same "$(echo "$all" | sed 's/ .*//' | tr '\n' ' ')" \
        "frame=8 frame=9 frame=10 frame=11 "
    check "each as it is by itself" same "$(echo "$all" | frame 10)" \
        "$(hash_of --set frame=10)"
    check "pictures: --frames 8:11" draws 'pic_%03d.png' --frames 8:11
    check "four of them" same "$(cd "$work" && echo pic_*)" \
        "pic_008.png pic_009.png pic_010.png pic_011.png"
    draws one.png --set frame=9
    check "and as one by itself, byte for byte" \
        cmp "$work/one.png" "$work/pic_009.png"
    for format in ppm pfm; do
        check "pictures: .$format" draws "pic_%d.$format" --frames 3:3
        draws one.$format --set frame=3
        check ".$format as by itself" \
            cmp "$work/one.$format" "$work/pic_3.$format"
    done
    grey="--set background=0.2"
    check "pictures: .pgm" draws 'grey_%d.pgm' --frames 3:3 $grey
    check "the last frame that there is" \
        same "$(hash_of --frames 4294967295:4294967295)" \
        "$(hash_of --set frame=4294967295)"
}

## State

keeps="--set temporal=ema --set alpha=0.25"

test_state()
{
    late=$(hashes --frames 3:6 $keeps)
    early=$(hashes --frames 0:6 $keeps)
    check "ema: the first frame is as by itself" \
        same "$(echo "$late" | frame 3)" "$(hash_of --set frame=3)"
    check "ema: later ones are not" \
        differs "$(echo "$late" | frame 6)" "$(hash_of --set frame=6)"
    check "ema: what came before is seen" \
        differs "$(echo "$late" | frame 6)" "$(echo "$early" | frame 6)"
    printf '[3]\ncut = on\n' >"$work/cut.path"
    cut=$(hashes --frames 0:6 $keeps --path "$work/cut.path")
    for n in 3 4 5 6; do
        check "after a cut at 3, frame $n as in a run from 3" \
            same "$(echo "$cut" | frame $n)" "$(echo "$late" | frame $n)"
    done
    check "and frame 2 as without it" same "$(echo "$cut" | frame 2)" \
        "$(echo "$early" | frame 2)"
    check "without temporal, runs from 0 and from 3 agree" \
        same "$(hashes --frames 0:6 --set spatial=gauss1 | tail -n 4)" \
        "$(hashes --frames 3:6 --set spatial=gauss1)"
}

# Combinations of passes; a name, then keys.
passes()
{
    cat <<EOF
plain
ema temporal=ema
ema8 temporal=ema history_bits=8 alpha=0.02
window temporal=window window=5
taa temporal=taa
taa_rom temporal=taa fetch=catmull-rom clamp=minmax history_bits=8
gauss spatial=gauss1
bilateral spatial=bilateral15
half resolution=half upsample=aware
quarter resolution=quarter
checker temporal=ema update=checker
bayer temporal=taa update=bayer4 resolution=half spatial=binomial5
EOF
}

make_path()
{
    cat >"$work/move.path" <<EOF
[0]
ease = spline
eye = 0,20,90
target = 24,24,24
sun = -60 30
[2]
eye = 40,20,90
[5]
eye = 60,40,60
sun = 40 10
EOF
}

# of_pass COMMAND-OPTIONS...: hashes of frames on the path with keys $keys
of_pass()
{
    set_keys=
    for key in $keys; do
        set_keys="$set_keys --set $key"
    done
    hashes --frames 0:5 --path "$work/move.path" $set_keys "$@"
}

test_threads_and_kernels()
{
    make_path
    kernels=
    for kernel in scalar avx2 avx512 generic; do
        if hash_of --kernel $kernel | grep -Eqx '[0-9a-f]{8}'; then
            kernels="$kernels $kernel"
        else
            skip "kernel $kernel: not in this machine or build"
        fi
    done
    passes >"$work/passes"
    while read -r name keys; do
        one=$(of_pass --threads 1 --kernel scalar)
        check "$name: six frames" \
            [ "$(echo "$one" | grep -Ecx 'frame=[0-5] crc32=[0-9a-f]{8}')" = 6 ]
        for n in 2 7; do
            check "$name: $n threads, the same" \
                same "$one" "$(of_pass --threads $n --kernel scalar)"
        done
        for kernel in $kernels auto; do
            [ "$kernel" = scalar ] || check "$name: kernel $kernel, the same" \
                same "$one" "$(of_pass --kernel $kernel)"
        done
    done <"$work/passes"
}

## Paths

test_paths()
{
    printf '[10]\nfov = 30\n[20]\nfov = 60\nlight = none\n' >"$work/fov.path"
    moved=$(hashes --frames 5:25 --path "$work/fov.path")
    for pair in 5:30 10:30 14:42 19:57; do
        n=${pair%:*}
        check "frame $n has fov ${pair#*:}" \
            same "$(echo "$moved" | frame $n)" \
            "$(hash_of --set frame=$n --set light=none --set fov=${pair#*:})"
    done
    check "a path is stronger than --set" \
        same "$moved" \
        "$(hashes --frames 5:25 --path "$work/fov.path" --set fov=99)"
    printf '[0]\nfov = 30\n\nfoo = 1\n' >"$work/key.path"
    printf '[0]\neye = 1,1,1\n[4]\neye = 1e8,0,0\n' >"$work/far.path"
    printf '[0]\neye = 0,0,0\ntarget = 2,2,2\n[2]\neye = 4,4,4\n' \
        >"$work/meet.path"
    check "a bad key, by file and line" fails 2 'key\.path:4: unknown key' \
        "$brume" render "$volume" --frames 0:3 --path "$work/key.path" \
        -o "$none/%d.png"
    check "no such path" fails 2 'no\.path: No such file' "$brume" render \
        "$volume" --frames 0:3 --path "$work/no.path" -o "$none/%d.png"
    check "a position out of reach on the way, before anything is drawn" \
        fails 2 'far\.path:2: eye is' "$brume" render "$volume" --frames 0:3 \
        --path "$work/far.path" -o "$none/%d.png"
    check "eye and target that meet on the way" \
        fails 2 'meet\.path:2: eye and target' "$brume" render "$volume" \
        --frames 0:2 --path "$work/meet.path" -o "$none/%d.png"
    check "a path without frames" fails 2 '--path needs --frames' \
        "$brume" render "$volume" --path "$work/fov.path" -o "$none/a.png"
}

## Films

# The pictures of $work/pic_%03d.png, 8 to 11, as films.
test_films()
{
    check "apng" draws film.apng --frames 8:11
    cp "$work/film.apng" "$work/film.png"
    check "a reader of PNG shows its first frame" at_most_0 film.png \
        pic_008.png
    if command -v pngcheck >/dev/null; then
        check "pngcheck finds no fault" pngcheck -q "$work/film.png"
    else
        skip "apng: no pngcheck"
    fi
    check "y4m" draws film.y4m --frames 8:11 --fps 30000/1001
    check "its header" same "$(head -n 1 "$work/film.y4m")" \
        "YUV4MPEG2 W70 H50 F30000:1001 Ip A1:1 C444 XCOLORRANGE=LIMITED"
    header=$(head -n 1 "$work/film.y4m" | wc -c)
    check "four frames of three planes" \
        same "$(wc -c <"$work/film.y4m" | tr -d ' ')" \
        "$((header + 4 * (6 + 3 * 70 * 50)))"
    "$brume" render "$volume" $small --frames 8:11 --fps 30000/1001 -o - \
        >"$work/pipe.y4m" 2>"$err"
    check "- is the same on stdout" cmp "$work/film.y4m" "$work/pipe.y4m"
    for film in apng y4m; do
        draws one.$film --frames 0:5 --set temporal=taa --threads 1
        draws seven.$film --frames 0:5 --set temporal=taa --threads 7
        check "$film: one thread and seven, the same file" \
            cmp "$work/one.$film" "$work/seven.$film"
    done
    check "names of films in capitals" draws FILM.Y4M --frames 0:1
    check "a grey film" draws grey.apng --frames 0:2 --set background=0
    check "a film on a path of backgrounds" draws colours.apng --frames 0:3 \
        --set background=0 --path "$work/sky.path"
}

at_most_0()
{
    "$brume" compare "$work/$1" "$work/$2" --metrics rmse --max-rmse 0 \
        >/dev/null
}

# The film's temporary file is removed by a signal.
interrupted()
{
    rm -rf "$none" && mkdir "$none"
    "$brume" render "$volume" --frames 0:100000 --set light_samples=8 \
        -o "$none/film.$1" 2>"$err" &
    tries=0
    while [ -z "$(ls -A "$none")" ] && [ $tries -lt 100 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    started=$(ls -A "$none")
    kill -TERM $!
    wait $! 2>/dev/null
    [ -n "$started" ] && [ -z "$(ls -A "$none")" ]
}

keeps_old_film()
{
    rm -rf "$none" && mkdir "$none"
    cp "$work/film.apng" "$none/film.apng"
    "$brume" render "$work/gap_%02d.brume" $small --frames 1:3 \
        -o "$none/film.apng" >"$out" 2>"$err"
    status=$?
    [ $status -eq 2 ] && [ "$(ls -A "$none")" = film.apng ] &&
        cmp "$none/film.apng" "$work/film.apng"
}

## Volumes that change

test_volumes()
{
    # The scene in full, so that it does not depend on the volume.
    "$brume" info "$work/fire_01.brume" --scene |
        grep -v -e '^size' -e '^frame' -e '^light_samples' -e '^noise' \
            >"$work/fire.scene"
    fire="--scene $work/fire.scene"
    all=$("$brume" render "$work/fire_%02d.brume" $small --frames 1:3 --hash)
    for n in 1 2 3; do
        volume=$work/fire_0$n.brume
        check "frame $n shows volume $n, as the first one's scene has it" \
            same "$(echo "$all" | frame $n)" \
            "$(hash_of $fire --set frame=$n)"
    done
    volume=$work/fire_02.brume
    check "with a film and a state" runs "$brume" render \
        "$work/fire_%02d.brume" $small --frames 1:3 --set temporal=taa \
        -o "$work/fire.apng"
    cp "$work/fire_01.brume" "$work/gap_01.brume"
    cp "$work/fire_03.brume" "$work/gap_03.brume"
    check "a volume that is missing, before anything is drawn" \
        fails 2 'gap_02\.brume: No such file' "$brume" render \
        "$work/gap_%02d.brume" --frames 1:3 -o "$none/%d.png"
    head -c 1000 "$work/fire_02.brume" >"$work/gap_02.brume"
    check "a volume that is broken leaves no film" fails 2 \
        'gap_02\.brume: .*truncated' "$brume" render "$work/gap_%02d.brume" \
        $small --frames 1:3 -o "$none/film.y4m"
    check "and an older film alone" keeps_old_film
    check "two numbers in its name" fails 2 'one %d or %04d' "$brume" render \
        "$work/fire_%02d_%d.brume" --frames 1:3 -o "$none/%d.png"
    check "a name with a number, for one picture, is a name" \
        fails 2 'fire_%02d\.brume: No such file' "$brume" render \
        "$work/fire_%02d.brume" -o "$none/a.png"
}

## Usage

# refused PATTERN ARGUMENT...: a sequence that is not drawn
refused()
{
    refused_pattern=$1
    shift
    fails 2 "$refused_pattern" "$brume" render "$volume" $small "$@"
}

test_help()
{
    runs "$brume" render --help
    for word in --frames --path --fps --kernel --profile OUT.apng OUT.y4m \
        'ease = ' 'cut = ' temporal history_bits window alpha fetch clamp \
        gamma spatial edge_falloff resolution update upsample subpixel; do
        grep -q -e "$word" "$out" || echo "$word"
    done >"$work/missing"
    check "--help has the options and keys of sequences" [ ! -s "$work/missing" ]
}

test_usage()
{
    for frames in '' 3 3: :3 -1:3 3:2 a:b 1:2:3 0:4294967296 1.5:2 ' 1:2' \
        0:4294967295; do
        check "--frames '$frames'" refused '--frames ' --frames "$frames" \
            -o "$none/%d.png"
    done
    for name in out.png %.png %x.png %d_%d.png %%d.png %4d.png; do
        check "-o $name" refused 'one %d or %04d' --frames 0:1 \
            -o "$none/$name"
    done
    check "-o of no known kind" refused 'unknown extension' --frames 0:1 \
        -o "$none/%d.gif"
    for fps in 0 -1 x 25/0 65536 1/2/3 25/ ''; do
        check "--fps '$fps'" refused '--fps is N or N/M' --frames 0:1 \
            --fps "$fps" -o "$none/a.apng"
    done
    for kernel in '' fast AVX2; do
        check "--kernel '$kernel'" refused '--kernel is one of' \
            --kernel "$kernel" -o "$none/a.png"
    done
    check "a film without --frames" refused 'needs --frames' -o "$none/a.apng"
    check "stdout without --frames" refused 'needs --frames' -o -
    check "a film and hashes on stdout" refused '--hash' --frames 0:1 --hash \
        -o -
    mkdir "$work/taken.apng" "$work/taken_0.png"
    check "a folder of the film's name" fails 1 'taken\.apng: ' "$brume" \
        render "$volume" $small --frames 0:1 -o "$work/taken.apng"
    check "a folder of the picture's name" fails 1 'taken_0\.png: ' "$brume" \
        render "$volume" $small --frames 0:1 -o "$work/taken_%d.png"
    check "a folder that is not there" fails 1 'no/film\.y4m: ' "$brume" \
        render "$volume" $small --frames 0:1 -o "$none/no/film.y4m"
    check "a grey picture of colours" fails 1 '0\.pgm: ' "$brume" \
        render "$volume" $small --frames 0:1 -o "$none/%d.pgm"
    if [ -c /dev/full ]; then
        check "a full stdout" fails 1 'cannot write' sh -c \
            "$brume render $volume $small --frames 0:1 -o - >/dev/full"
    else
        skip "a full stdout: no /dev/full"
    fi
    for film in apng y4m; do
        check "$film: nothing is left after a signal" interrupted $film
    done
}

## Profile

test_profile()
{
    "$brume" render "$volume" $small --frames 0:2 --set temporal=taa \
        --profile -o "$work/profile.y4m" >"$out" 2>"$err"
    check "--profile: heads, a row for each frame, and the sum" \
        same "$(sed 's/ \{2,\}.*//' "$err" | tr '\n' ' ')" \
        "ms frame 0 frame 1 frame 2 all "
    check "the passes" grep -Eqx "ms +open +begin +cache +copy +march +store +resolve \
+show +pack +encode +write +busy +clock +march" "$err"
    # shellcheck disable=SC2016
    check "the march's share is of the sum" awk '
        /^all/ { sum = 0
            for (i = 2; i <= 12; i++) sum += $i
            share = 100 * $6 / sum
            bad = sum - $13 > 0.1 || $13 - sum > 0.1 ||
                share - $15 > 1 || $15 - share > 1 || $6 <= 0 || $8 <= 0 }
        END { exit bad }' "$err"
}

## Data

mkdir "$none"
make()
{
    "$cloud" -o "$work/fire_0$1.vdb" --size 40 --type plume --seed "$1" \
        >"$work/log" 2>&1 &&
        "$bake" "$work/fire_0$1.vdb" -o "$work/fire_0$1.brume" \
            --format u8r >>"$work/log" 2>&1 && return
    sed 's/^/# /' "$work/log"
    return 1
}
for seed in 1 2 3; do
    check "volume $seed is modelled and baked" make $seed
done
printf '[0]\nbackground = 0\n[3]\nbackground = 0,0,1\n' >"$work/sky.path"

test_frames
test_state
test_threads_and_kernels
test_paths
test_films
test_volumes
test_help
test_usage
test_profile
finish
