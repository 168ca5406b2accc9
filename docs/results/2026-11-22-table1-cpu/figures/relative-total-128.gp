# Draws relative-total-128.svg: gnuplot relative-total-128.gp
set encoding utf8
set terminal svg size 480,667 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'relative-total-128.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'time to image, 128 spp' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94903
set bmargin at screen 0.06597
set xrange [0:1.2851121]
set xlabel 'over ideal sah, shorter is better' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [35:-0.5]
unset ytics
set border 1
set grid noytics
set arrow 1 from 1, graph 0 to 1, graph 1 nohead back linecolor rgb '#59636e' linewidth 1 dashtype (4,3)
$bars << END_OF_DATA
1.3	1.003005	0	"sah"	"1.00"
2.3	1.1911341	9080726	"lbvh"	"1.19"
3.3	1.0137428	15113984	"hlbvh"	"1.01"
4.3	0.92042704	40563	"atrbvh"	"0.92"
5.3	1.1482113	10276334	"kmeans-q1"	"1.15"
6.3	1.0840359	7320544	"kmeans-q2"	"1.08"
7.3	1.0354417	4034505	"kmeans-q3"	"1.04"
8.3	1.0740461	29362	"kmeans-q4"	"1.07"
9.3	1.1428022	18287	"kmeans-q5"	"1.14"
10.3	0.58450347	13983232	"embree-high"	"0.58"
13.1	1.0029578	0	"sah"	"1.00"
14.1	1.1606849	9080726	"lbvh"	"1.16"
15.1	1.0483776	15113984	"hlbvh"	"1.05"
16.1	1.0485613	40563	"atrbvh"	"1.05"
17.1	1.2838283	10276334	"kmeans-q1"	"1.28"
18.1	1.1877677	7320544	"kmeans-q2"	"1.19"
19.1	1.1246955	4034505	"kmeans-q3"	"1.12"
20.1	1.2538106	29362	"kmeans-q4"	"1.25"
21.1	1.183371	18287	"kmeans-q5"	"1.18"
22.1	0.62161848	13983232	"embree-high"	"0.62"
24.9	1.013101	0	"sah"	"1.01"
25.9	1.0118355	9080726	"lbvh"	"1.01"
26.9	0.85038576	15113984	"hlbvh"	"0.85"
27.9	0.76300172	40563	"atrbvh"	"0.76"
28.9	1.0210305	10276334	"kmeans-q1"	"1.02"
29.9	0.93873842	7320544	"kmeans-q2"	"0.94"
30.9	0.90328921	4034505	"kmeans-q3"	"0.90"
31.9	0.79168826	29362	"kmeans-q4"	"0.79"
32.9	0.8142596	18287	"kmeans-q5"	"0.81"
33.9	0.56247976	13983232	"embree-high"	"0.56"
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
