# data_house
# Run in this folder: gnuplot data_house.gp
if (!exists('out')) out = 'data_house.svg'
set encoding utf8
set minussign
set terminal svg size 900,650 enhanced font 'sans-serif,13' background '#ffffff'
set output out
set datafile separator ','
set datafile columnheaders
v(c) = valid(c) ? column(c) : NaN
set style line 11 lc rgb '#e2e2e2' lw 1
set grid xtics ytics back ls 11, ls 11
set border 3 lw 1 lc rgb '#555555'
set tics nomirror out scale 0.6 tc rgb '#222222'
set multiplot
set label 2 'house: the recording' at screen 0.09556, screen 0.97231 left font ',15' tc rgb '#111111'

set lmargin at screen 0.09556
set rmargin at screen 0.97333
set tmargin at screen 0.93538
set bmargin at screen 0.67385
set key at screen 0.08222, screen 0.94308 left bottom vertical maxrows 1 Left reverse samplen 2.2 width 1 spacing 1.15 tc rgb '#222222'
unset object 1
set ylabel 'Q (input)  [W]' offset 0.5,0
set ytics autofreq
set format y '% h'
unset xlabel
set format x ''
set xtics ('' -0, '' 86400, '' 172800, '' 259200, '' 345600, '' 432000)
set xrange [0:514500]
set yrange [*:*]
unset label 1
plot 'data_house.csv' using (v(1)):(v(2)) with lines lw 1.2 dt 1 lc rgb '#0072B2' notitle
unset label 2

set lmargin at screen 0.09556
set rmargin at screen 0.97333
set tmargin at screen 0.64923
set bmargin at screen 0.38769
set key at screen 0.08222, screen 0.65692 left bottom vertical maxrows 1 Left reverse samplen 2.2 width 1 spacing 1.15 tc rgb '#222222'
unset object 1
set ylabel 'T\_out (input)  [K]' offset 0.5,0
set ytics autofreq
set format y '% h'
unset xlabel
set format x ''
set xtics ('' -0, '' 86400, '' 172800, '' 259200, '' 345600, '' 432000)
set xrange [0:514500]
set yrange [*:*]
unset label 1
plot 'data_house.csv' using (v(3)):(v(4)) with lines lw 1.2 dt 1 lc rgb '#D55E00' notitle

set lmargin at screen 0.09556
set rmargin at screen 0.97333
set tmargin at screen 0.36308
set bmargin at screen 0.10154
set key at screen 0.08222, screen 0.37077 left bottom vertical maxrows 1 Left reverse samplen 2.2 width 1 spacing 1.15 tc rgb '#222222'
unset object 1
set ylabel 'T (output)  [K]' offset 0.5,0
set ytics autofreq
set format y '% h'
set xlabel 'time  [d]' offset 0,0.2
set format x '%g'
set xtics norotate center ('−0' -0, '1' 86400, '2' 172800, '3' 259200, '4' 345600, '5' 432000)
set xrange [0:514500]
set yrange [*:*]
unset label 1
plot 'data_house.csv' using (v(5)):(v(6)) with lines lw 1.2 dt 1 lc rgb '#009E73' notitle
unset multiplot
set output
drawn = 1
