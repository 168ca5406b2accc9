# Draws rays-primary.svg: gnuplot rays-primary.gp
set encoding utf8
set terminal svg size 480,667 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'rays-primary.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'primary rays' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94903
set bmargin at screen 0.06597
set xrange [0:13.00488]
set xlabel 'MRays/s' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [35:-0.5]
unset ytics
set border 1
set grid noytics
$bars << END_OF_DATA
1.3	5.3441588	0	"sah"	"5.34"
2.3	4.5238061	9080726	"lbvh"	"4.52"
3.3	5.0652584	15113984	"hlbvh"	"5.07"
4.3	6.1510952	40563	"atrbvh"	"6.15"
5.3	4.4282716	10276334	"kmeans-q1"	"4.43"
6.3	4.692029	7320544	"kmeans-q2"	"4.69"
7.3	4.8628166	4034505	"kmeans-q3"	"4.86"
8.3	5.0803682	29362	"kmeans-q4"	"5.08"
9.3	5.0092381	18287	"kmeans-q5"	"5.01"
10.3	12.924618	13983232	"embree-high"	"12.9"
13.1	6.7949559	0	"sah"	"6.79"
14.1	5.4905113	9080726	"lbvh"	"5.49"
15.1	6.3411387	15113984	"hlbvh"	"6.34"
16.1	6.6701094	40563	"atrbvh"	"6.67"
17.1	4.5393543	10276334	"kmeans-q1"	"4.54"
18.1	5.1894778	7320544	"kmeans-q2"	"5.19"
19.1	5.5391526	4034505	"kmeans-q3"	"5.54"
20.1	5.5062843	29362	"kmeans-q4"	"5.51"
21.1	5.7212111	18287	"kmeans-q5"	"5.72"
22.1	12.991888	13983232	"embree-high"	"13.0"
24.9	4.0894042	0	"sah"	"4.09"
25.9	3.9008756	9080726	"lbvh"	"3.90"
26.9	4.2202923	15113984	"hlbvh"	"4.22"
27.9	5.1380692	40563	"atrbvh"	"5.14"
28.9	3.6131885	10276334	"kmeans-q1"	"3.61"
29.9	4.1862032	7320544	"kmeans-q2"	"4.19"
30.9	4.2573714	4034505	"kmeans-q3"	"4.26"
31.9	4.9001756	29362	"kmeans-q4"	"4.90"
32.9	4.577739	18287	"kmeans-q5"	"4.58"
33.9	8.7578852	13983232	"embree-high"	"8.76"
END_OF_DATA
$heads << END_OF_DATA
0.3	"sponza"
12.1	"sibenik"
23.9	"crytek-sponza"
END_OF_DATA
plot $bars using (0.5*$2):1:(0):2:($1-0.4):($1+0.4):3 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $bars using (0):1:4 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $bars using 2:1:5 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d', \
  $heads using (0):1:2 with labels left offset 0,0 font 'sans-serif,14' textcolor rgb '#1b1f24'
