# SPDX-License-Identifier: MIT
# Chart of experiment 6: gnuplot -e "dir='...'" ford.gp
set datafile separator ","
set datafile missing NaN
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale xy
set xlabel "speed: tuned NanoVDB's time at the first rung over this one's"

set terminal svg size 1000,400 font "sans,11" background "white"
set output dir . "/ford.svg"
set multiplot layout 1,2
do for [scene in "disney smoke"] {
    set title scene . ": RMSE"
    unset key
    set format "%g"
    set offsets graph 0.05, graph 0.25, graph 0.1, graph 0.1
    # Columns: scene rung renderer view light rmse mean speed. Rungs that are
    # close have their names on either side.
    plot dir . "/ford_table.csv" using (strcol(1) eq scene && \
        strcol(3) eq "core" ? $8 : NaN):6 with linespoints pt 7 ps 0.7 \
        lw 1.5 lc rgb "#1f77b4", "" using (strcol(1) eq scene && \
        strcol(3) eq "core" && strstrt("exit window", strcol(2)) ? \
        $8 : NaN):6:2 with labels font ",10" offset -0.8,0.6 right, \
        "" using (strcol(1) eq scene && strcol(3) eq "core" && \
        !strstrt("exit window", strcol(2)) ? $8 : NaN):6:2 with labels \
        font ",10" offset 0.8,-0.6 left
}
unset multiplot
