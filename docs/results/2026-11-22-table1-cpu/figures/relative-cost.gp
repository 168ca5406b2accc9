# Draws relative-cost.svg: gnuplot relative-cost.gp
set encoding utf8
set terminal svg size 480,565 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'relative-cost.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'SAH cost' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.93982
set bmargin at screen 0.07788
set xrange [0:1.3144016]
set xlabel 'over ideal sah, shorter is better' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [29:-0.5]
unset ytics
set border 1
set grid noytics
set arrow 1 from 1, graph 0 to 1, graph 1 nohead back linecolor rgb '#59636e' linewidth 1 dashtype (4,3)
$bars << END_OF_DATA
1.3	1.3130885	9080726	"lbvh"	"1.31"
2.3	1.0958969	15113984	"hlbvh"	"1.10"
3.3	0.8912371	40563	"atrbvh"	"0.89"
4.3	1.238062	10276334	"kmeans-q1"	"1.24"
5.3	1.1222122	7320544	"kmeans-q2"	"1.12"
6.3	1.0423377	4034505	"kmeans-q3"	"1.04"
7.3	1.0024548	29362	"kmeans-q4"	"1.00"
8.3	0.99851068	18287	"kmeans-q5"	"1.00"
11.1	1.2470071	9080726	"lbvh"	"1.25"
12.1	1.087026	15113984	"hlbvh"	"1.09"
13.1	0.95877389	40563	"atrbvh"	"0.96"
14.1	1.3106168	10276334	"kmeans-q1"	"1.31"
15.1	1.2133724	7320544	"kmeans-q2"	"1.21"
16.1	1.1344526	4034505	"kmeans-q3"	"1.13"
17.1	1.1044935	29362	"kmeans-q4"	"1.10"
18.1	1.089829	18287	"kmeans-q5"	"1.09"
20.9	1.2932512	9080726	"lbvh"	"1.29"
21.9	0.98321792	15113984	"hlbvh"	"0.98"
22.9	0.82859155	40563	"atrbvh"	"0.83"
23.9	1.1624662	10276334	"kmeans-q1"	"1.16"
24.9	1.0848329	7320544	"kmeans-q2"	"1.08"
25.9	1.0056611	4034505	"kmeans-q3"	"1.01"
26.9	0.89610292	29362	"kmeans-q4"	"0.90"
27.9	0.88495144	18287	"kmeans-q5"	"0.88"
END_OF_DATA
$heads << END_OF_DATA
0.3	"sponza"
10.1	"sibenik"
19.9	"crytek-sponza"
END_OF_DATA
plot $bars using (0.5*$2):1:(0):2:($1-0.4):($1+0.4):3 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $bars using (0):1:4 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $bars using 2:1:5 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d', \
  $heads using (0):1:2 with labels left offset 0,0 font 'sans-serif,14' textcolor rgb '#1b1f24'
