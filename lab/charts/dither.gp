# SPDX-License-Identifier: MIT
# Chart of experiment 4: gnuplot -e "dir='...'" dither.gp
set datafile separator ","
set datafile missing NaN
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale xy
set xrange [4:800]
set xlabel "steps across the box"
curves = "none/none none/blur white/none bayer/none white/blur bayer/blur " . \
    "bayer/aware"
colours = "#000000 #888888 #ff9896 #aec7e8 #d62728 #1f77b4 #2ca02c"
part(text, i) = i == 1 ? text[1:strstrt(text, "/") - 1] : \
    text[strstrt(text, "/") + 1:*]

set terminal svg size 1100,400 font "sans,11" background "white"
set output dir . "/dither.svg"
set multiplot layout 1,3
do for [scene in "disney thin cube"] {
    set title scene . ": RMSE"
    set key bottom left font ",9" samplen 1.5
    # Columns: scene noise blur steps frame reference region rmse
    plot for [i=1:words(curves)] dir . "/dither.csv" using \
        (strcol(1) eq scene && strcol(2) eq part(word(curves, i), 1) && \
        strcol(3) eq part(word(curves, i), 2) ? $4 : NaN):8 \
        with linespoints lw 1.8 pt 7 ps 0.4 lc rgb word(colours, i) \
        title word(curves, i)
}
unset multiplot
