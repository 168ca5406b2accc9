# Draws relative-speed.svg: gnuplot relative-speed.gp
set encoding utf8
set terminal svg size 480,616 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'relative-speed.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'trace speed' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94481
set bmargin at screen 0.07143
set xrange [0:2.1121487]
set xlabel 'over ideal sah, longer is better' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [32:-0.5]
unset ytics
set border 1
set grid noytics
set arrow 1 from 1, graph 0 to 1, graph 1 nohead back linecolor rgb '#59636e' linewidth 1 dashtype (4,3)
$bars << END_OF_DATA
1.3	0.85595124	9080726	"lbvh"	"0.86"
2.3	0.97851859	15113984	"hlbvh"	"0.98"
3.3	1.0914038	40563	"atrbvh"	"1.09"
4.3	0.84380808	10276334	"kmeans-q1"	"0.84"
5.3	0.90595818	7320544	"kmeans-q2"	"0.91"
6.3	0.95923404	4034505	"kmeans-q3"	"0.96"
7.3	0.92940403	29362	"kmeans-q4"	"0.93"
8.3	0.8700395	18287	"kmeans-q5"	"0.87"
9.3	1.9825985	13983232	"embree-high"	"1.98"
12.1	0.83103896	9080726	"lbvh"	"0.83"
13.1	0.93873888	15113984	"hlbvh"	"0.94"
14.1	0.94383202	40563	"atrbvh"	"0.94"
15.1	0.74070247	10276334	"kmeans-q1"	"0.74"
16.1	0.81116909	7320544	"kmeans-q2"	"0.81"
17.1	0.86630266	4034505	"kmeans-q3"	"0.87"
18.1	0.81067044	29362	"kmeans-q4"	"0.81"
19.1	0.83513566	18287	"kmeans-q5"	"0.84"
20.1	1.781347	13983232	"embree-high"	"1.78"
22.9	0.9856655	9080726	"lbvh"	"0.99"
23.9	1.2079438	15113984	"hlbvh"	"1.21"
24.9	1.3665705	40563	"atrbvh"	"1.37"
25.9	0.99540368	10276334	"kmeans-q1"	"1.00"
26.9	1.0974073	7320544	"kmeans-q2"	"1.10"
27.9	1.1358715	4034505	"kmeans-q3"	"1.14"
28.9	1.333455	29362	"kmeans-q4"	"1.33"
29.9	1.2850886	18287	"kmeans-q5"	"1.29"
30.9	2.1100387	13983232	"embree-high"	"2.11"
END_OF_DATA
$heads << END_OF_DATA
0.3	"sponza"
11.1	"sibenik"
21.9	"crytek-sponza"
END_OF_DATA
plot $bars using (0.5*$2):1:(0):2:($1-0.4):($1+0.4):3 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $bars using (0):1:4 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $bars using 2:1:5 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d', \
  $heads using (0):1:2 with labels left offset 0,0 font 'sans-serif,14' textcolor rgb '#1b1f24'
