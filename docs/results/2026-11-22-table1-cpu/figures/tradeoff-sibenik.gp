# Draws tradeoff-sibenik.svg: gnuplot tradeoff-sibenik.gp
set encoding utf8
set terminal svg size 480,380 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'tradeoff-sibenik.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'sibenik' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.96667
set tmargin at screen 0.91053
set bmargin at screen 0.13158
set xrange [10.686531:90.110853]
set logscale x
set xlabel 'build time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('20' 20, '50' 50)
set yrange [3.066097:9.490793]
set ylabel 'trace speed [MRays/s]' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set label 'lbvh' at screen 0.17972,0.29518 left front font 'sans-serif,12' textcolor rgb '#55585d'
set label 'hlbvh' at screen 0.33076,0.36019 left front font 'sans-serif,12' textcolor rgb '#8e6200'
set label 'kmeans-q1' at screen 0.42471,0.20696 left front font 'sans-serif,12' textcolor rgb '#607f93'
set label 'atrbvh' at screen 0.38227,0.29590 left front font 'sans-serif,12' textcolor rgb '#006147'
set label 'kmeans-q3' at screen 0.50539,0.28278 left front font 'sans-serif,12' textcolor rgb '#25587c'
set label 'sah' at screen 0.47754,0.39717 left front font 'sans-serif,12' textcolor rgb '#000000'
set label 'kmeans-q2' at screen 0.44774,0.16845 left front font 'sans-serif,12' textcolor rgb '#446e8a'
set arrow from screen 0.51637,0.24950 to screen 0.51637,0.18423 nohead back linecolor rgb '#9aa3ad' linewidth 0.7
set label 'kmeans-q4' at screen 0.57678,0.22225 left front font 'sans-serif,12' textcolor rgb '#00466e'
set label 'kmeans-q5' at screen 0.71595,0.26397 left front font 'sans-serif,12' textcolor rgb '#002c44'
set label 'embree-high' at screen 0.80174,0.86883 left front font 'sans-serif,12' textcolor rgb '#843a00'
$points << END_OF_DATA
13.135417	4.137613	9080726	"lbvh"
19.67313	4.6738341	15113984	"hlbvh"
21.735335	3.6878418	10276334	"kmeans-q1"
22.869163	4.699192	40563	"atrbvh"
26.690942	4.3131855	4034505	"kmeans-q3"
27.497556	4.9788436	0	"sah"
28.637061	4.038684	7320544	"kmeans-q2"
33.431264	4.0362013	29362	"kmeans-q4"
45.619892	4.1580098	18287	"kmeans-q5"
73.311139	8.8690483	13983232	"embree-high"
END_OF_DATA
$front << END_OF_DATA
13.135417	4.137613
19.67313	4.6738341
22.869163	4.699192
27.497556	4.9788436
73.311139	8.8690483
END_OF_DATA
plot $front using 1:2 with steps linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
