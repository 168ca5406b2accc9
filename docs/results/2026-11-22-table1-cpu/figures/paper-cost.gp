# Draws paper-cost.svg: gnuplot paper-cost.gp
set encoding utf8
set terminal svg size 480,400 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'paper-cost.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'SAH cost over lbvh' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.12917
set rmargin at screen 0.77083
set tmargin at screen 0.91500
set bmargin at screen 0.12500
set xrange [0.59585494:1.1245807]
set logscale x
set xlabel 'in the paper' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics ('0.6' 0.6, '0.7' 0.7, '0.8' 0.8, '0.9' 0.9, '1' 1, '1.1' 1.1)
set yrange [0.59585494:1.1245807]
set logscale y
set ylabel 'here' offset 0.8,0 textcolor rgb '#3c444d' font 'sans-serif,12'
set ytics ('0.6' 0.6, '0.7' 0.7, '0.8' 0.8, '0.9' 0.9, '1' 1, '1.1' 1.1)
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
0.82954545	0.83459484	15113984
0.68181818	0.67873344	40563
0.86742424	0.94286258	10276334
0.79924242	0.85463561	7320544
0.76893939	0.79380608	4034505
0.75	0.76343272	29362
0.73863636	0.76042905	18287
0.8125	0.87170799	15113984
0.71875	0.76886003	40563
0.921875	1.05101	10276334
0.859375	0.97302769	7320544
0.82291667	0.9097403	4034505
0.78125	0.88571552	29362
0.765625	0.87395573	18287
0.80645161	0.7602683	15113984
0.64516129	0.64070423	40563
0.89964158	0.89887109	10276334
0.79569892	0.83884154	7320544
0.7562724	0.77762236	4034505
0.72759857	0.69290706	29362
0.68817204	0.68428423	18287
END_OF_DATA
plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \
  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable
