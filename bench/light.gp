# SPDX-License-Identifier: MIT
# Charts of light.sh's figures: gnuplot -e "dir='...'" light.gp
set datafile separator ","
set terminal svg size 900,340 font "sans,11" background "white"
set output dir . "/light.svg"
set multiplot layout 1,3
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set xlabel "sun, degrees"
set xtics (10, 35, 80)
set xrange [5:85]
set yrange [0.2:20]
set logscale y
set key below samplen 1 font ",9"
do for [volume in "disney cumulus smoke"] {
    set title volume . ", nearest"
    set ylabel volume eq "disney" ? "RMSE of 255" : ""
    plot for [kind in "log uniform16 cone cache8 cache4 cache2"] \
        sprintf("%s/light_%s_nearest_%s.dat", dir, volume, kind) \
        using 1:2 with linespoints pt 7 ps 0.6 lw 1.5 title kind
}
unset multiplot

set output dir . "/stochastic.svg"
set multiplot layout 1,3
set xlabel "frame"
set xtics auto
set xrange [0:31]
set yrange [0.1:10]
do for [volume in "disney cumulus smoke"] {
    set title volume
    set ylabel volume eq "disney" ? "RMSE of 255 to trilinear" : ""
    plot for [noise in "nearest white fast r2"] \
        dir . "/stochastic.csv" using \
        (strcol(1) eq volume && strcol(2) eq noise ? $3 : 1/0):4 \
        with linespoints pt 7 ps 0.4 lw 1.5 title noise
}
unset multiplot
