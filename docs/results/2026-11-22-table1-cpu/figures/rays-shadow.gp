# Draws rays-shadow.svg: gnuplot rays-shadow.gp
set encoding utf8
set terminal svg size 480,667 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'rays-shadow.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'shadow rays' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.94903
set bmargin at screen 0.06597
set xrange [0:13.232202]
set xlabel 'MRays/s' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set yrange [35:-0.5]
unset ytics
set border 1
set grid noytics
$bars << END_OF_DATA
1.3	7.4696335	0	"sah"	"7.47"
2.3	6.7799165	9080726	"lbvh"	"6.78"
3.3	7.4699583	15113984	"hlbvh"	"7.47"
4.3	7.7846421	40563	"atrbvh"	"7.78"
5.3	6.4377285	10276334	"kmeans-q1"	"6.44"
6.3	6.8681969	7320544	"kmeans-q2"	"6.87"
7.3	7.4382213	4034505	"kmeans-q3"	"7.44"
8.3	6.948081	29362	"kmeans-q4"	"6.95"
9.3	6.2146279	18287	"kmeans-q5"	"6.21"
10.3	13.218983	13983232	"embree-high"	"13.2"
13.1	5.6027035	0	"sah"	"5.60"
14.1	4.6920704	9080726	"lbvh"	"4.69"
15.1	5.3495964	15113984	"hlbvh"	"5.35"
16.1	5.117522	40563	"atrbvh"	"5.12"
17.1	4.3037486	10276334	"kmeans-q1"	"4.30"
18.1	4.6858202	7320544	"kmeans-q2"	"4.69"
19.1	4.9864633	4034505	"kmeans-q3"	"4.99"
20.1	4.5426222	29362	"kmeans-q4"	"4.54"
21.1	4.6824763	18287	"kmeans-q5"	"4.68"
22.1	10.038775	13983232	"embree-high"	"10.0"
24.9	4.743612	0	"sah"	"4.74"
25.9	5.6135875	9080726	"lbvh"	"5.61"
26.9	6.7144162	15113984	"hlbvh"	"6.71"
27.9	7.4878732	40563	"atrbvh"	"7.49"
28.9	5.7768817	10276334	"kmeans-q1"	"5.78"
29.9	5.9755648	7320544	"kmeans-q2"	"5.98"
30.9	6.2967382	4034505	"kmeans-q3"	"6.30"
31.9	7.9691121	29362	"kmeans-q4"	"7.97"
32.9	7.0770027	18287	"kmeans-q5"	"7.08"
33.9	10.88309	13983232	"embree-high"	"10.9"
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
