# SPDX-License-Identifier: MIT
# Chart of experiment 2: gnuplot -e "dir='...'" rq2.gp
set datafile separator ","
set datafile missing NaN # rows of other curves do not break a line
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set xrange [0:31]
set xlabel "frame"
csv = dir . "/rq2.csv"
noises = "white blue ign stbn fast fast-separate"
colours = "#000000 #1f77b4 #d62728 #2ca02c #9467bd #e377c2"

# Columns: scene filter noise frame reference region rmse ...
row(scene, filter, noise, reference) = strcol(1) eq scene && \
    strcol(2) eq filter && strcol(3) eq noise && strcol(5) eq reference

set terminal svg size 1000,640 font "sans,11" background "white"
set output dir . "/rq2.svg"
set multiplot layout 2,3
do for [reference in "light limit"] {
    do for [filter in "none gauss1 box5"] {
        set title "disney, " . filter . (reference eq "light" ? ": RMSE" : \
            ": noise alone")
        set key at graph 1, graph 1 right top font ",9" samplen 1.5 maxrows 3
        if (reference eq "light") {
            unset logscale y
            set yrange [0:0.05]
        } else {
            set logscale y
            set yrange [0.0004:0.05]
        }
        plot for [i=1:words(noises)] csv using (row("disney", filter, \
            word(noises, i), reference) ? $4 : NaN):7 with lines lw 1.8 \
            lc rgb word(colours, i) title word(noises, i)
    }
}
unset multiplot
