# SPDX-License-Identifier: MIT
# Charts of experiment 1: gnuplot -e "dir='...'" rq1.gp
set datafile separator ","
set datafile missing NaN # rows of other curves do not break a line
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale y
set xrange [0:31]
set xlabel "frame"
csv = dir . "/rq1.csv"
noises = "none white blue ign ign-jimenez stbn fast fast-64 fast-product " . \
    "fast-separate"
colours = "#888888 #000000 #1f77b4 #d62728 #ff9896 #2ca02c #9467bd #17becf " . \
    "#8c564b #e377c2"

# Columns: scene noise frame reference region rmse mean spread ...
row(scene, noise, reference, region) = strcol(1) eq scene && \
    strcol(2) eq noise && strcol(4) eq reference && strcol(5) eq region

set terminal svg size 900,640 font "sans,11" background "white"
set output dir . "/rq1.svg"
set multiplot layout 2,2
set key at graph 1, graph 1 right top font ",9" samplen 1.5 maxrows 5
do for [scene in "disney cube"] {
    set title scene . ": RMSE, white is 1"
    plot for [i=1:words(noises)] csv using \
        (row(scene, word(noises, i), "light", "all") ? $3 : NaN):6 \
        with lines lw 1.8 lc rgb word(colours, i) title word(noises, i)
    set title scene . ": noise alone, RMSE to the method's own limit"
    plot for [i=2:words(noises)] csv using \
        (row(scene, word(noises, i), "limit", "all") ? $3 : NaN):6 \
        with lines lw 1.8 lc rgb word(colours, i) title word(noises, i)
}
unset multiplot

set terminal svg size 1100,560 font "sans,10" background "white"
set output dir . "/rq1_regions.svg"
set multiplot layout 2,4
do for [scene in "disney cube"] {
    do for [region in "lit shaded border fringe"] {
        set title scene . ", " . region
        if (region eq "fringe") {
            set key at graph 1, graph 1 right top font ",7" samplen 1 maxrows 5
        } else {
            unset key
        }
        plot for [i=1:words(noises)] csv using \
            (row(scene, word(noises, i), "light", region) ? $3 : NaN):6 \
            with lines lw 1.5 lc rgb word(colours, i) title word(noises, i)
    }
}
unset multiplot
