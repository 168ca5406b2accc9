# Draws paper-speed.svg: gnuplot paper-speed.gp
set encoding utf8
set terminal svg size 480,400 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'paper-speed.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'trace speed over lbvh' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.77083
set tmargin at screen 0.91500
set bmargin at screen 0.12500
set xrange [0.82890614:1.4834956]
set logscale x
set xlabel 'in the paper' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('0.9' 0.9, '1' 1, '1.1' 1.1, '1.2' 1.2, '1.3' 1.3, '1.4' 1.4)
set yrange [0.82890614:1.4834956]
set logscale y
set ylabel 'here' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set ytics ('0.9' 0.9, '1' 1, '1.1' 1.1, '1.2' 1.2, '1.3' 1.3, '1.4' 1.4)
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
1.0899471	1.1431943	15113984
1.1798942	1.2750771	40563
1.0582011	0.98581325	10276334
1.1216931	1.0584226	7320544
1.1216931	1.1206643	4034505
1.1851852	1.0858142	29362
1.1428571	1.0164592	18287
1.0971429	1.1295967	15113984
1.1942857	1.1357254	40563
1.0514286	0.89129693	10276334
1.0857143	0.97609032	7320544
1.0857143	1.0424333	4034505
1.1485714	0.97549029	29362
1.1371429	1.0049296	18287
1.1071429	1.2255109	15113984
1.25	1.3864445	40563
0.95	1.0098798	10276334
1.1	1.1133668	7320544
1.1	1.1523904	4034505
1.0714286	1.3528474	29362
1.2642857	1.3037776	18287
END_OF_DATA
plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
