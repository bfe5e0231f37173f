# SPDX-License-Identifier: MIT
# What units of the atlas share: `. lab/atlas/lib.sh` after setting $unit and
# $out. A unit draws into $work, adds rows and makes a picture; both take their
# places at the end, so a unit that fails leaves nothing.
brume=$BUILD/brume
atlas=$BUILD/brume-atlas

die()
{
    echo "lab/atlas: $unit: $1" >&2
    exit 1
}

# skip FILE: the unit needs that real volume, which is not there
skip()
{
    echo "SKIP $unit: $1 is not in $DATA"
    : >"$work/skipped"
}

# quiet COMMAND...: its output is shown when it fails
quiet()
{
    "$@" >"$work/log" 2>&1 && return
    cat "$work/log" >&2
    die "failed: $1 $2 $3"
}

## Pictures

# volume NAME [FORMAT]: $work/NAME.brume and NAME.float, of FORMAT u8
volume()
{
    quiet "$atlas" volume "$1" "${2:-u8}" "$work/$1.brume" "$work/$1.float"
}

# volume_alone NAME: without the float dump, which may be large
volume_alone() { quiet "$atlas" volume "$1" u8 "$work/$1.brume"; }

# real_volume FILE: of $DATA, as $work/real.brume and real.float
real_volume()
{
    [ -f "$DATA/$1" ] || return
    [ -x "$BUILD/brume-bake" ] || die "no $BUILD/brume-bake"
    quiet "$BUILD/brume-bake" "$DATA/$1" -o "$work/real.brume" --format u8 \
        --mips --dump-float "$work/real.float"
}

# scene LINES: of all pictures from here on; what it does not say is plain
scene()
{
    cat >"$work/scene" <<END
size = 104x78
background = 0
output = linear
filter = nearest
light = none
jitter = none
noise = none
min_transmittance = 0
density_scale = 1
light_density_scale = 1
sun = 0 45
$1
END
}

# draw OUT VOLUME [--set KEY=VALUE]...: $work/OUT.pfm by brume
draw()
{
    draw_out=$1 draw_volume=$2
    shift 2
    quiet "$brume" render "$work/$draw_volume.brume" --scene "$work/scene" \
        "$@" -o "$work/$draw_out.pfm"
}

# draw_frames OUT VOLUME LAST OPTIONS...: frames 0 to LAST as $work/OUT_%d.pfm
draw_frames()
{
    draw_out=$1 draw_volume=$2 draw_last=$3
    shift 3
    quiet "$brume" render "$work/$draw_volume.brume" --scene "$work/scene" \
        --frames "0:$draw_last" "$@" -o "$work/${draw_out}_%d.pfm"
}

# draw_ema OUT VOLUME OPTIONS...: the last of 32 jittered frames, OUT.pfm
draw_ema()
{
    ema_out=$1 ema_volume=$2
    shift 2
    draw_frames "$ema_out" "$ema_volume" 31 --set temporal=ema \
        --set jitter=primary --set noise=fast "$@"
    mv "$work/${ema_out}_31.pfm" "$work/$ema_out.pfm"
}

# truth OUT VOLUME [--set KEY=VALUE]...: by the reference, in double
truth()
{
    truth_out=$1 truth_volume=$2
    shift 2
    quiet "$BUILD/brume-reference" "$work/$truth_volume.float" \
        --scene "$work/scene" "$@" -o "$work/$truth_out.pfm"
}

## Figures

# error METRIC TRUTH PICTURE: one figure of brume compare
error()
{
    "$brume" compare "$work/$2.pfm" "$work/$3.pfm" --metrics "$1" |
        sed 's/^.*=//'
}

# error_over METRIC TRUTH_%d PICTURE_%d A:B: of a sequence
error_over()
{
    "$brume" compare "$work/$2.pfm" "$work/$3.pfm" --frames "$4" \
        --metrics "$1" | sed 's/^.*=//'
}

# mean_of PICTURE: of its samples, in 1/255
mean_of() { "$atlas" mean "$work/$1.pfm"; }

# calc EXPRESSION: by awk, with 6 digits behind the point
calc() { awk "BEGIN { printf \"%.6f\\n\", $1 }"; }

## Rows and the picture

# row METHOD SCENE SETTING METRIC VALUE UNIT TRUTH REMEDY REMEDY_VALUE
row()
{
    [ $# -eq 9 ] || die "a row of $# fields"
    for field; do
        case $field in
        '') die "an empty field in the row of $1, $4" ;;
        *,*) die "a comma in '$field'" ;;
        esac
    done
    IFS=,
    echo "$unit,$*" >>"$work/rows"
    unset IFS
}

# picture GAIN FAILURE REMEDY TRUTH: of $work, the light times GAIN
picture()
{
    for panel in "$2" "$3" "$4"; do
        [ -f "$work/$panel" ] || die "no picture $panel"
    done
    quiet "$atlas" panels "$1" "$work/$2" "$work/$3" "$work/$4" \
        "$work/panels.png"
}

# heat OUT TRUTH PICTURE MAX: $work/OUT.png, the error up to MAX of 255
heat()
{
    quiet "$brume" compare "$work/$2.pfm" "$work/$3.pfm" --metrics rmse \
        --heat "$work/$1.png" --heat-max "$4"
}

## Claims

# field ROW COLUMN: of the unit's table, rows from 1
field()
{
    awk -F, -v r="$1" -v c="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == c) k = i }
        NR == r + 1 { print $k }' "$table"
}

# verdict TEXT EXPRESSION: ok when awk finds it true
verdict()
{
    claims=$((claims + 1))
    if awk "BEGIN { exit !($2) }"; then
        echo "ok $claims - $unit: $1"
    else
        echo "not ok $claims - $unit: $1"
        broken=1
    fi
}

# claim_better ROW FACTOR: the remedy's figure is so many times smaller
claim_better()
{
    v=$(field "$1" value) w=$(field "$1" remedy_value)
    verdict "$(field "$1" method) $(field "$1" metric) $v; \
$(field "$1" remedy) $w: at least $2 times smaller" \
        "($v)^2 > 0 && ($v)^2 >= $2 * $2 * ($w)^2"
}

# claim_within ROW COLUMN BOUND: the figure is at most the bound, signs aside
claim_within()
{
    v=$(field "$1" "$2")
    verdict "$(field "$1" setting) $(field "$1" metric) $2 $v: at most $3" \
        "($v)^2 <= $3 * $3"
}

# claim_breaks ROW BOUND: the method does fail, by at least so much
claim_breaks()
{
    v=$(field "$1" value)
    verdict "$(field "$1" method) at $(field "$1" setting) \
$(field "$1" metric) $v: at least $2" "($v)^2 >= $2 * $2"
}
