# SPDX-License-Identifier: MIT
# Charts of run.sh's figures: gnuplot -e "dir='...'" charts.gp
set datafile separator ","
set terminal svg size 480,320 font "sans,11" background "white"
set key top left Left reverse noenhanced autotitle columnheader
set grid lc rgb "#dddddd"
set style data linespoints
set border 3
set tics nomirror
set ylabel "ms"
set yrange [0:*]

file(name) = dir . "/scale_" . name . ".csv"
# Columns between the first and the last are kernels.
columns(name) = int(system("head -1 " . file(name) . " | tr ',' '\\n' | wc -l"))

set linetype 1 lc rgb "#666666" pt 7 ps 0.6 lw 1.5
set linetype 2 lc rgb "#c0392b" pt 7 ps 0.6 lw 1.5

set output dir . "/covered.svg"
set xlabel "covered pixels, per cent"
plot for [i=2:columns("covered")-1] file("covered") using 1:i

set output dir . "/steps.svg"
set logscale xy 2
unset yrange
set xlabel "step, voxels"
set key top right
plot for [i=2:columns("steps")-1] file("steps") using 1:i

set output dir . "/pixels.svg"
set key top left
set logscale xy 10
set xlabel "pixels"
plot for [i=2:columns("pixels")-1] file("pixels") using 1:i
unset logscale

set yrange [0:*]
set output dir . "/volume.svg"
set logscale x 2
set xlabel "voxels a side, the same lookups in the world"
plot for [i=2:columns("volume")-1] file("volume") using 1:i

set output dir . "/light_uniform.svg"
set xlabel "uniform light samples"
plot for [i=2:columns("light_uniform")-1] file("light_uniform") using 1:i
unset logscale

set output dir . "/light_log.svg"
set xlabel "doubling light samples"
plot for [i=2:columns("light_log")-1] file("light_log") using 1:i

set output dir . "/threads.svg"
set xlabel "threads"
plot for [i=2:columns("threads_ms")-1] file("threads_ms") using 1:i
