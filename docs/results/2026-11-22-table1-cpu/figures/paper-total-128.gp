# Draws paper-total-128.svg: gnuplot paper-total-128.gp
set encoding utf8
set terminal svg size 480,400 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'paper-total-128.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'time to image, 128 spp over lbvh' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.77083
set tmargin at screen 0.91500
set bmargin at screen 0.12500
set xrange [0.7012915:1.1835222]
set logscale x
set xlabel 'in the paper' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('0.8' 0.8, '0.9' 0.9, '1' 1, '1.1' 1.1)
set yrange [0.7012915:1.1835222]
set logscale y
set ylabel 'here' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set ytics ('0.8' 0.8, '0.9' 0.9, '1' 1, '1.1' 1.1)
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
0.94359819	0.85107358	15113984
0.87690408	0.77273167	40563
0.9637711	0.96396477	10276334
0.90407575	0.91008719	7320544
0.90201729	0.86929065	4034505
0.87319885	0.90170042	29362
0.92136682	0.95942361	18287
0.91054113	0.90324053	15113984
0.83296841	0.90339875	40563
0.92492962	1.1060955	10276334
0.90334689	1.0233335	7320544
0.90553644	0.968993	4034505
0.86205818	1.0802334	29362
0.90678761	1.0195454	18287
0.9388587	0.84043879	15113984
0.82133152	0.75407688	40563
1.1032609	1.0090875	10276334
0.94293478	0.92775798	7320544
0.95278533	0.89272342	4034505
0.99184783	0.78242787	29362
0.88451087	0.80473519	18287
END_OF_DATA
plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
