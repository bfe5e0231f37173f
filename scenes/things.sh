#!/bin/sh
# SPDX-License-Identifier: MIT
# things.sh bars|posts: geometry of the composed scenes as Wavefront OBJ on
# stdout, in a world of +Y up.
#   bars   a wall from x -100 to 100 and y 0 to 100 at z = 0, 4 thick, with a
#          window behind a lattice of bars: 5 x 4 openings
#   posts  lamp posts along a street in z, at x = -36 and 36: mast, arm and hood
set -eu

case ${1-} in
bars | posts) ;;
*)
    sed -n 's/^# //p' "$0" | sed 1d
    [ "${1-}" = --help ] && exit 0
    exit 2
    ;;
esac

LC_ALL=C awk -v what="$1" '
# A box from (a,b,c) to (d,e,f): its corners, then its sides.
function box(a, b, c, d, e, f,    i) {
    for (i = 0; i < 8; i++)
        printf "v %g %g %g\n", i % 2 ? d : a, int(i / 2) % 2 ? e : b,
            (i > 3 ? f : c)
    print "f -8 -6 -5 -7\nf -4 -3 -1 -2\nf -8 -7 -3 -4"
    print "f -6 -2 -1 -5\nf -8 -4 -2 -6\nf -7 -5 -1 -3"
}
BEGIN {
    if (what == "bars") {
        # the wall around an opening of x -45..45, y 20..80
        box(-100, 0, -2, -45, 100, 2)
        box(45, 0, -2, 100, 100, 2)
        box(-45, 0, -2, 45, 20, 2)
        box(-45, 80, -2, 45, 100, 2)
        for (i = 1; i < 5; i++) box(-45 + 18 * i - 2, 20, -2, -45 + 18 * i + 2, 80, 2)
        for (i = 1; i < 4; i++) box(-45, 20 + 15 * i - 2, -2, 45, 20 + 15 * i + 2, 2)
    }
    if (what == "posts")
        for (z = 0; z <= 320; z += 80) for (s = -1; s <= 1; s += 2) {
            box(s * 36 - 1, 0, z - 1, s * 36 + 1, 46, z + 1)
            if (s < 0) box(-35, 44.6, z - 0.7, -24, 46, z + 0.7)
            else box(24, 44.6, z - 0.7, 35, 46, z + 0.7)
            box(s * 24 - 3, 44, z - 3, s * 24 + 3, 46.5, z + 3)
        }
}'
