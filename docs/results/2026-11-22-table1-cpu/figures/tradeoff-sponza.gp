# Draws tradeoff-sponza.svg: gnuplot tradeoff-sponza.gp
set encoding utf8
set terminal svg size 480,380 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'tradeoff-sponza.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'sponza' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.96667
set tmargin at screen 0.91053
set bmargin at screen 0.13158
set xrange [8.4773952:88.95321]
set logscale x
set xlabel 'build time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('10' 10, '20' 20, '50' 50)
set yrange [3.6749983:11.013529]
set ylabel 'trace speed [MRays/s]' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set label 'lbvh' at screen 0.17972,0.24734 left front font 'sans-serif,12' textcolor rgb '#55585d'
set label 'hlbvh' at screen 0.30096,0.28127 left front font 'sans-serif,12' textcolor rgb '#8e6200'
set label 'kmeans-q1' at screen 0.43937,0.20696 left front font 'sans-serif,12' textcolor rgb '#607f93'
set label 'atrbvh' at screen 0.38124,0.37722 left front font 'sans-serif,12' textcolor rgb '#006147'
set label 'kmeans-q2' at screen 0.40430,0.16019 left front font 'sans-serif,12' textcolor rgb '#446e8a'
set arrow from screen 0.47293,0.24124 to screen 0.47293,0.17598 nohead back linecolor rgb '#9aa3ad' linewidth 0.7
set label 'kmeans-q3' at screen 0.50867,0.31442 left front font 'sans-serif,12' textcolor rgb '#25587c'
set arrow from screen 0.49573,0.27063 to screen 0.50450,0.29863 nohead back linecolor rgb '#9aa3ad' linewidth 0.7
set label 'sah' at screen 0.51762,0.26617 left front font 'sans-serif,12' textcolor rgb '#000000'
set label 'kmeans-q4' at screen 0.59401,0.25418 left front font 'sans-serif,12' textcolor rgb '#00466e'
set label 'kmeans-q5' at screen 0.70350,0.22143 left front font 'sans-serif,12' textcolor rgb '#002c44'
set label 'embree-high' at screen 0.80174,0.86883 left front font 'sans-serif,12' textcolor rgb '#843a00'
$points << END_OF_DATA
10.642879	4.4482854	9080726	"lbvh"
17.821089	5.0852546	15113984	"hlbvh"
19.323228	4.3851787	10276334	"kmeans-q1"
19.557274	5.6719069	40563	"atrbvh"
22.248586	4.708166	7320544	"kmeans-q2"
23.718756	4.9850349	4034505	"kmeans-q3"
24.609926	5.1968911	0	"sah"
29.825303	4.8300116	29362	"kmeans-q4"
40.554989	4.5215006	18287	"kmeans-q5"
70.85409	10.303348	13983232	"embree-high"
END_OF_DATA
$front << END_OF_DATA
10.642879	4.4482854
17.821089	5.0852546
19.557274	5.6719069
70.85409	10.303348
END_OF_DATA
plot $front using 1:2 with steps linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
