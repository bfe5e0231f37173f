# SPDX-License-Identifier: MIT
# Charts of the front: gnuplot -e "dir='...'" front.gp
set datafile separator ","
set datafile missing NaN
set grid lc rgb "#dddddd"
set border 3
set tics nomirror
set logscale xy
set format x "%g"
set format y "%g"
volumes = "disney smoke cumulus block"
all = dir . "/front_all.csv"
fronts = dir . "/front_fronts.csv"

# Columns of front_all: 11 rmse3, 12 flip3, 13 rmse31, 14 flip31, 15 m4, 16
# time; of front_fronts: volume number setting error cost x y knee.
row(volume, error, cost) = strcol(1) eq volume && strcol(4) eq error && \
    strcol(5) eq cost
columns = "m4 time"
labels(cost) = cost eq "m4" ? "Cortex-M4, instructions per pixel" : \
    "host, frames of tuned NanoVDB"

do for [volume in volumes] {
    set terminal svg size 1100,860 font "sans,11" background "white"
    set output dir . "/front_" . volume . ".svg"
    set multiplot layout 2,2
    do for [error in "rmse flip"] {
        do for [c=1:2] {
            cost = word(columns, c)
            set title volume . ": " . (error eq "rmse" ? "RMSE" : "FLIP") . \
                " against cost"
            set xlabel labels(cost)
            set key left bottom font ",9" samplen 1.5
            set yrange [*:error eq "rmse" ? 0.12 : 0.2] # none is beyond
            late = error . "31"
            early = error . "3"
            plot all using (strcol(1) eq volume ? column(14 + c) : NaN): \
                    (column(error eq "rmse" ? 13 : 14)) with points pt 7 \
                    ps 0.25 lc rgb "#aaaaaa" title "every setting, frame 31", \
                fronts using (row(volume, early, cost) ? $6 : NaN):7 \
                    with linespoints lw 1.2 pt 7 ps 0.35 lc rgb "#ff7f0e" \
                    title "front at frame 3", \
                fronts using (row(volume, late, cost) ? $6 : NaN):7 \
                    with linespoints lw 1.6 pt 7 ps 0.5 lc rgb "#1f77b4" \
                    title "front at frame 31", \
                fronts using (row(volume, late, cost) ? $6 : NaN):7:2 \
                    with labels font ",8" offset -0.7,-0.7 \
                    textcolor rgb "#1f77b4" notitle, \
                fronts using (row(volume, early, cost) ? $6 : NaN):7:2 \
                    with labels font ",7" offset 0.7,0.6 \
                    textcolor rgb "#ff7f0e" notitle, \
                fronts using (row(volume, early, cost) && $8 > 0 ? $6 : NaN):7 \
                    with points pt 6 ps 1.6 lw 1.5 lc rgb "#ff7f0e" notitle, \
                fronts using (row(volume, late, cost) && $8 > 0 ? $6 : NaN):7 \
                    with points pt 6 ps 1.8 lw 2 lc rgb "#d62728" \
                    title "knee"
        }
    }
    unset multiplot
}

# The four together.
set yrange [*:*]
set key right top font ",10"
set terminal svg size 900,420 font "sans,11" background "white"
set output dir . "/front.svg"
set multiplot layout 1,2
colours = "#1f77b4 #d62728 #2ca02c #9467bd"
do for [error in "rmse31 flip31"] {
    set title (error eq "rmse31" ? "RMSE" : "FLIP") . " at frame 31"
    set xlabel labels("m4")
    plot for [i=1:4] fronts using \
        (row(word(volumes, i), error, "m4") ? $6 : NaN):7 with linespoints \
        pt 7 ps 0.4 lw 1.6 lc rgb word(colours, i) title word(volumes, i), \
        for [i=1:4] fronts using \
        (row(word(volumes, i), error, "m4") && $8 > 0 ? $6 : NaN):7 \
        with points pt 6 ps 1.8 lw 2 lc rgb word(colours, i) notitle
}
unset multiplot
