# Draws tradeoff-crytek-sponza.svg: gnuplot tradeoff-crytek-sponza.gp
set encoding utf8
set terminal svg size 480,380 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'tradeoff-crytek-sponza.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'crytek-sponza' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.96667
set tmargin at screen 0.91053
set bmargin at screen 0.13158
set xrange [18.623783:339.27531]
set logscale x
set xlabel 'build time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('20' 20, '50' 50, '100' 100, '200' 200)
set yrange [3.11249:8.2133442]
set ylabel 'trace speed [MRays/s]' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set label 'lbvh' at screen 0.17972,0.24065 left front font 'sans-serif,12' textcolor rgb '#55585d'
set label 'hlbvh' at screen 0.27317,0.36483 left front font 'sans-serif,12' textcolor rgb '#8e6200'
set label 'atrbvh' at screen 0.42341,0.45346 left front font 'sans-serif,12' textcolor rgb '#006147'
set label 'kmeans-q1' at screen 0.49362,0.21240 left front font 'sans-serif,12' textcolor rgb '#607f93'
set label 'kmeans-q2' at screen 0.37762,0.26939 left front font 'sans-serif,12' textcolor rgb '#446e8a'
set label 'kmeans-q3' at screen 0.56919,0.29088 left front font 'sans-serif,12' textcolor rgb '#25587c'
set label 'kmeans-q4' at screen 0.56083,0.36759 left front font 'sans-serif,12' textcolor rgb '#00466e'
set label 'sah' at screen 0.69719,0.21497 left front font 'sans-serif,12' textcolor rgb '#000000'
set label 'kmeans-q5' at screen 0.74783,0.37425 left front font 'sans-serif,12' textcolor rgb '#002c44'
set label 'embree-high' at screen 0.80174,0.86883 left front font 'sans-serif,12' textcolor rgb '#843a00'
$points << END_OF_DATA
24.663248	3.6061211	9080726	"lbvh"
35.008791	4.4193405	15113984	"hlbvh"
60.502747	4.9996869	40563	"atrbvh"
62.160226	3.6417488	10276334	"kmeans-q1"
75.103628	4.0149356	7320544	"kmeans-q2"
80.768607	4.1556595	4034505	"kmeans-q3"
105.4448	4.8785314	29362	"kmeans-q4"
125.85972	3.6585648	0	"sah"
150.00688	4.70158	18287	"kmeans-q5"
256.19456	7.7197132	13983232	"embree-high"
END_OF_DATA
$front << END_OF_DATA
24.663248	3.6061211
35.008791	4.4193405
60.502747	4.9996869
256.19456	7.7197132
END_OF_DATA
plot $front using 1:2 with steps linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
