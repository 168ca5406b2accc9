# Draws paper-build.svg: gnuplot paper-build.gp
set encoding utf8
set terminal svg size 480,400 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'paper-build.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'build time over lbvh' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.77083
set tmargin at screen 0.91500
set bmargin at screen 0.12500
set xrange [0.93:65.983333]
set logscale x
set xlabel 'in the paper' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('1' 1, '10' 10)
set yrange [0.93:65.983333]
set logscale y
set ylabel 'here' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set ytics ('1' 1, '10' 10)
set label '●' at screen 0.7833,0.8900 left font 'sans-serif,12' textcolor rgb '#e69f00'
set label 'hlbvh' at screen 0.8125,0.8900 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.8450 left font 'sans-serif,12' textcolor rgb '#009e73'
set label 'atrbvh' at screen 0.8125,0.8450 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.8000 left font 'sans-serif,12' textcolor rgb '#9ccdee'
set label 'kmeans-q1' at screen 0.8125,0.8000 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.7550 left font 'sans-serif,12' textcolor rgb '#6fb3e0'
set label 'kmeans-q2' at screen 0.8125,0.7550 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.7100 left font 'sans-serif,12' textcolor rgb '#3d8fc9'
set label 'kmeans-q3' at screen 0.8125,0.7100 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.6650 left font 'sans-serif,12' textcolor rgb '#0072b2'
set label 'kmeans-q4' at screen 0.8125,0.6650 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set label '●' at screen 0.7833,0.6200 left font 'sans-serif,12' textcolor rgb '#00476f'
set label 'kmeans-q5' at screen 0.8125,0.6200 left font 'sans-serif,12' textcolor rgb '#1b1f24'
$points << END_OF_DATA
6.5	1.6744613	15113984
3	1.8375924	40563
1.5	1.8156016	10276334
2.3333333	2.0904668	7320544
5	2.2286033	4034505
16.722222	2.8023717	29362
61.666667	3.810528	18287
5.8571429	1.4977164	15113984
2.8571429	1.7410306	40563
1.4285714	1.6547122	10276334
2.1428571	2.180141	7320544
4.4285714	2.0319828	4034505
16.047619	2.5451239	29362
55.714286	3.4730448	18287
2.9375	1.4194721	15113984
3.4583333	2.4531541	40563
1.1875	2.5203585	10276334
2.125	3.0451638	7320544
3.7083333	3.2748569	4034505
12.541667	4.275382	29362
54.166667	6.0822032	18287
END_OF_DATA
plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
