# Draws relative-total-8.svg: gnuplot relative-total-8.gp
set encoding utf8
set terminal svg size 480,667 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'relative-total-8.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'time to image, 8 spp' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94903
set bmargin at screen 0.06597
set xrange [0:1.3185819]
set xlabel 'over ideal sah, shorter is better' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [35:-0.5]
unset ytics
set border 1
set grid noytics
set arrow 1 from 1, graph 0 to 1, graph 1 nohead back linecolor rgb '#59636e' linewidth 1 dashtype (4,3)
$bars << END_OF_DATA
1.3	1.0599843	0	"sah"	"1.06"
2.3	1.1579617	9080726	"lbvh"	"1.16"
3.3	1.0617892	15113984	"hlbvh"	"1.06"
4.3	1.0030274	40563	"atrbvh"	"1.00"
5.3	1.2170827	10276334	"kmeans-q1"	"1.22"
6.3	1.1728211	7320544	"kmeans-q2"	"1.17"
7.3	1.1067263	4034505	"kmeans-q3"	"1.11"
8.3	1.1093605	29362	"kmeans-q4"	"1.11"
9.3	1.1984103	18287	"kmeans-q5"	"1.20"
10.3	0.71446972	13983232	"embree-high"	"0.71"
13.1	1.0453522	0	"sah"	"1.05"
14.1	1.1764429	9080726	"lbvh"	"1.18"
15.1	1.0513718	15113984	"hlbvh"	"1.05"
16.1	1.0681091	40563	"atrbvh"	"1.07"
17.1	1.3172646	10276334	"kmeans-q1"	"1.32"
18.1	1.2154942	7320544	"kmeans-q2"	"1.22"
19.1	1.161594	4034505	"kmeans-q3"	"1.16"
20.1	1.1934503	29362	"kmeans-q4"	"1.19"
21.1	1.2328691	18287	"kmeans-q5"	"1.23"
22.1	0.78757342	13983232	"embree-high"	"0.79"
24.9	1.219	0	"sah"	"1.22"
25.9	1.0592064	9080726	"lbvh"	"1.06"
26.9	0.93766926	15113984	"hlbvh"	"0.94"
27.9	0.87741112	40563	"atrbvh"	"0.88"
28.9	1.1284144	10276334	"kmeans-q1"	"1.13"
29.9	1.0487884	7320544	"kmeans-q2"	"1.05"
30.9	1.0240664	4034505	"kmeans-q3"	"1.02"
31.9	1.0118634	29362	"kmeans-q4"	"1.01"
32.9	1.0832621	18287	"kmeans-q5"	"1.08"
33.9	0.98569617	13983232	"embree-high"	"0.99"
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
