# Draws paper-total-8.svg: gnuplot paper-total-8.gp
set encoding utf8
set terminal svg size 480,400 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'paper-total-8.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'time to image, 8 spp over lbvh' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.77083
set tmargin at screen 0.91500
set bmargin at screen 0.12500
set xrange [0.77038086:2.3098413]
set logscale x
set xlabel 'in the paper' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('0.8' 0.8, '1' 1, '1.2' 1.2, '1.4' 1.4, '1.6' 1.6, '1.8' 1.8, '2' 2, '2.2' 2.2)
set yrange [0.77038086:2.3098413]
set logscale y
set ylabel 'here' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set ytics ('0.8' 0.8, '1' 1, '1.2' 1.2, '1.4' 1.4, '1.6' 1.6, '1.8' 1.8, '2' 2, '2.2' 2.2)
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
1	0.91694673	15113984
0.9025974	0.86620082	40563
0.96103896	1.0510561	10276334
0.9025974	1.0128324	7320544
0.92857143	0.9557538	4034505
1.0519481	0.95802866	29362
1.5844156	1.0349308	18287
0.95544554	0.89368701	15113984
0.84653465	0.90791407	40563
0.92574257	1.1197012	10276334
0.90594059	1.0331943	7320544
0.93564356	0.98737812	4034505
1.0148515	1.0144566	29362
1.4405941	1.0479634	18287
0.98412698	0.88525641	15113984
0.88359788	0.82836651	40563
1.0634921	1.0653395	10276334
0.95238095	0.99016428	7320544
1.005291	0.96682416	4034505
1.2539683	0.95530335	29362
2.1587302	1.022711	18287
END_OF_DATA
plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
