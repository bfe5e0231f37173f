# SPDX-License-Identifier: MIT
# Charts of experiment 3: gnuplot -e "dir='...'" toft.gp
set datafile separator ","
set datafile missing NaN
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
methods = "steps128 steps8 steps8_jitter steps8_taa"
colours = "#000000 #888888 #1f77b4 #d62728"
resolutions = "full half quarter"

set terminal svg size 1100,400 font "sans,11" background "white"
set output dir . "/toft.svg"
set multiplot layout 1,3
set logscale xy
set xlabel "speed: tuned NanoVDB's time at 128 steps over this one's"
do for [scene in "disney thin cube"] {
    set title scene . ": RMSE at frame 31; full, half, quarter" noenhanced
    set key top left font ",9" samplen 1.5 noenhanced
    # Columns: scene resolution method frame0 frame31 mean speed
    plot for [i=1:words(methods)] dir . "/toft_table.csv" using \
        (strcol(1) eq scene && strcol(3) eq word(methods, i) ? $7 : NaN):5 \
        with linespoints lw 1.8 pt 7 ps 0.6 lc rgb word(colours, i) \
        title word(methods, i)
}
unset multiplot

set output dir . "/toft_brightness.svg"
set multiplot layout 1,3
unset logscale
set logscale x 2
set xlabel "step, voxels"
set xzeroaxis lw 1.5
kinds = "analytic euler brume jitter"
shades = "#2ca02c #d62728 #000000 #1f77b4"
do for [scene in "disney thin cube"] {
    set title scene . ": mean error"
    set key bottom left font ",9" samplen 1.5
    # Columns: scene step method frame reference region rmse mean
    plot for [i=1:words(kinds)] dir . "/toft_brightness.csv" using \
        (strcol(1) eq scene && strcol(3) eq word(kinds, i) ? $2 : NaN):8 \
        with linespoints lw (i == 3 ? 4 : 1.5) pt 7 ps 0.4 \
        lc rgb word(shades, i) title word(kinds, i)
}
unset multiplot
