# SPDX-License-Identifier: MIT
# Charts of experiment 5: gnuplot -e "dir='...'" fast.gp
set datafile separator ","
set datafile missing NaN
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale y
noises = "white stbn product separate gauss-time rank1 default"
colours = "#000000 #2ca02c #d62728 #e377c2 #ff7f0e #17becf #9467bd"

set terminal svg size 1000,640 font "sans,11" background "white"
set output dir . "/fast.svg"
set multiplot layout 2,2
set autoscale xfix
set xlabel "frame"
do for [filter in "box5 gauss1"] {
    do for [average in "ema mean"] {
        set title "disney, " . filter . ", " . (average eq "ema" ? "EMA" : \
            "cumulative mean") . ": noise alone"
        set key top right font ",9" samplen 1.5 maxrows 4
        # Columns: scene filter average noise frame reference region rmse
        plot for [i=1:words(noises)] dir . "/fast.csv" using \
            (strcol(1) eq "disney" && strcol(2) eq filter && \
            strcol(3) eq average && strcol(4) eq word(noises, i) && \
            strcol(6) eq "limit" ? $5 : NaN):8 with lines lw 1.8 \
            lc rgb word(colours, i) title word(noises, i)
    }
}
unset multiplot

set output dir . "/fast_spectra.svg"
set multiplot layout 2,2
set xrange [0:0.5]
set xlabel "cycles per pixel"
set yrange [0.01:10]
kinds = "white stbn product separate rank1"
shades = "#000000 #2ca02c #d62728 #e377c2 #17becf"
do for [scene in "disney cube"] {
    do for [average in "frame ema"] {
        set title scene . (average eq "frame" ? ": error of one frame" : \
            ": error under EMA") . ", power over that of white"
        set key bottom right font ",9" samplen 1.5 maxrows 3
        # Columns: scene average noise frequency relative
        plot for [i=1:words(kinds)] dir . "/fast_relative.csv" using \
            (strcol(1) eq scene && strcol(2) eq average && \
            strcol(3) eq word(kinds, i) ? $4 : NaN):5 with lines lw 1.8 \
            lc rgb word(shades, i) title word(kinds, i)
    }
}
unset multiplot
