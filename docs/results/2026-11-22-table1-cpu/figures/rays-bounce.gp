# Draws rays-bounce.svg: gnuplot rays-bounce.gp
set encoding utf8
set terminal svg size 480,667 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'rays-bounce.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'bounce rays' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94903
set bmargin at screen 0.06597
set xrange [0:6.7162483]
set xlabel 'MRays/s' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [35:-0.5]
unset ytics
set border 1
set grid noytics
$bars << END_OF_DATA
1.3	3.1555807	0	"sah"	"3.16"
2.3	2.5737335	9080726	"lbvh"	"2.57"
3.3	3.0528804	15113984	"hlbvh"	"3.05"
4.3	3.5515913	40563	"atrbvh"	"3.55"
5.3	2.6291424	10276334	"kmeans-q1"	"2.63"
6.3	2.8404806	7320544	"kmeans-q2"	"2.84"
7.3	2.9670521	4034505	"kmeans-q3"	"2.97"
8.3	2.9277729	29362	"kmeans-q4"	"2.93"
9.3	2.81928	18287	"kmeans-q5"	"2.82"
10.3	6.7095388	13983232	"embree-high"	"6.71"
13.1	3.799553	0	"sah"	"3.80"
14.1	3.1425305	9080726	"lbvh"	"3.14"
15.1	3.4909717	15113984	"hlbvh"	"3.49"
16.1	3.7328589	40563	"atrbvh"	"3.73"
17.1	2.7335592	10276334	"kmeans-q1"	"2.73"
18.1	2.9928165	7320544	"kmeans-q2"	"2.99"
19.1	3.2115313	4034505	"kmeans-q3"	"3.21"
20.1	3.0796812	29362	"kmeans-q4"	"3.08"
21.1	3.1649829	18287	"kmeans-q5"	"3.16"
22.1	6.6329029	13983232	"embree-high"	"6.63"
24.9	2.2132685	0	"sah"	"2.21"
25.9	1.8300598	9080726	"lbvh"	"1.83"
26.9	2.3710501	15113984	"hlbvh"	"2.37"
27.9	2.6639768	40563	"atrbvh"	"2.66"
28.9	1.8887213	10276334	"kmeans-q1"	"1.89"
29.9	2.1772059	7320544	"kmeans-q2"	"2.18"
30.9	2.2123989	4034505	"kmeans-q3"	"2.21"
31.9	2.4337544	29362	"kmeans-q4"	"2.43"
32.9	2.5536015	18287	"kmeans-q5"	"2.55"
33.9	4.2419736	13983232	"embree-high"	"4.24"
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
