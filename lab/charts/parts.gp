# SPDX-License-Identifier: MIT
# Chart of the error's parts: gnuplot -e "dir='...'" parts.gp
set datafile separator ","
set grid y lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale y
set yrange [1e-5:3]
set format y "10^{%T}"
set boxwidth 0.8
set style fill solid 0.9 noborder
unset xtics
unset key
set xrange [-0.5:*]
parts = "quantisation step light filter exit noise arithmetic all"
colours = "#8c564b #1f77b4 #ff7f0e #2ca02c #17becf #9467bd #444444 #d62728"
chart = dir . "/parts_chart.csv"

# Columns: volume at part label rmse. Bars begin at the axis's end; what is
# less, as the block's quantisation, has none.
set terminal svg size 1200,960 font "sans,11" background "white"
set output dir . "/parts.svg"
set multiplot layout 2,2
do for [volume in "disney smoke cumulus block"] {
    set title volume . ": RMSE of each part alone"
    plot for [i=1:words(parts)] chart using \
        (strcol(1) eq volume && strcol(3) eq word(parts, i) ? $2 : NaN): \
        ($5 > 1e-5 ? $5 : 1e-5) with boxes lc rgb word(colours, i), \
        chart using (strcol(1) eq volume ? $2 : NaN): \
        ($5 > 1e-5 ? $5 : 1e-5):4 with labels rotate by 90 left font ",8" \
        offset 0,0.4
}
unset multiplot
