# Draws phases-kmeans.svg: gnuplot phases-kmeans.gp
set encoding utf8
set terminal svg size 480,262 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'phases-kmeans.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'k-means, crytek-sponza' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.87023
set bmargin at screen 0.41221
set xrange [0:150.15689]
set xlabel 'build time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics 20
set yrange [4.6:-0.6]
unset ytics
set border 1
set grid noytics
set object 1 rectangle from screen 0.04583,0.18702 to screen 0.06667,0.22519 fillstyle solid noborder fillcolor rgb '#0072b2'
set label 'boxes' at screen 0.07708,0.20611 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 2 rectangle from screen 0.36250,0.18702 to screen 0.38333,0.22519 fillstyle solid noborder fillcolor rgb '#e69f00'
set label 'representatives' at screen 0.39375,0.20611 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 3 rectangle from screen 0.67917,0.18702 to screen 0.70000,0.22519 fillstyle solid noborder fillcolor rgb '#009e73'
set label 'k-means loop' at screen 0.71042,0.20611 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 4 rectangle from screen 0.04583,0.11069 to screen 0.06667,0.14885 fillstyle solid noborder fillcolor rgb '#d55e00'
set label 'cluster sizes' at screen 0.07708,0.12977 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 5 rectangle from screen 0.36250,0.11069 to screen 0.38333,0.14885 fillstyle solid noborder fillcolor rgb '#cc79a7'
set label 'tasks, reorder' at screen 0.39375,0.12977 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 6 rectangle from screen 0.67917,0.11069 to screen 0.70000,0.14885 fillstyle solid noborder fillcolor rgb '#56b4e9'
set label 'agglomeration' at screen 0.71042,0.12977 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 7 rectangle from screen 0.04583,0.03435 to screen 0.06667,0.07252 fillstyle solid noborder fillcolor rgb '#666666'
set label 'collapse, layout' at screen 0.07708,0.05344 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 8 rectangle from screen 0.36250,0.03435 to screen 0.38333,0.07252 fillstyle solid noborder fillcolor rgb '#dfe3e7'
set label 'not in a phase' at screen 0.39375,0.05344 left font 'sans-serif,12' textcolor rgb '#1b1f24'
$bars << END_OF_DATA
0	0	11.903597	29362
0	11.903597	18.026546	15113984
0	18.026546	24.112206	13983232
0	24.112206	41.878691	13400487
0	41.878691	44.222514	5682409
0	44.222514	56.96698	6710886
0	56.96698	62.160226	14672871
1	0	10.981938	29362
1	10.981938	17.323619	15113984
1	17.323619	28.595847	40563
1	28.595847	33.406967	13983232
1	33.406967	53.528975	13400487
1	53.528975	55.738844	5682409
1	55.738844	68.00055	6710886
1	68.00055	75.103628	14672871
2	0	12.246489	29362
2	12.246489	18.868225	15113984
2	18.868225	38.65558	40563
2	38.65558	42.62182	13983232
2	42.62182	62.395283	13400487
2	62.395283	66.121391	5682409
2	66.121391	78.713392	6710886
2	78.713392	80.768607	14672871
3	0	10.125386	29362
3	10.125386	15.731815	15113984
3	15.731815	54.082318	40563
3	54.082318	57.670979	13983232
3	57.670979	82.229802	13400487
3	82.229802	87.009546	5682409
3	87.009546	100.03922	6710886
3	100.03922	105.4448	14672871
4	0	10.539241	29362
4	10.539241	16.489762	15113984
4	16.489762	90.270727	40563
4	90.270727	95.024656	13983232
4	95.024656	123.08176	13400487
4	123.08176	131.51574	5682409
4	131.51574	145.6662	6710886
4	145.6662	150.00688	14672871
END_OF_DATA
$names << END_OF_DATA
0	"kmeans-q1"	62.160226	"62.2"
1	"kmeans-q2"	75.103628	"75.1"
2	"kmeans-q3"	80.768607	"80.8"
3	"kmeans-q4"	105.4448	"105"
4	"kmeans-q5"	150.00688	"150"
END_OF_DATA
plot $bars using (0.5*($2+$3)):1:2:3:($1-0.38):($1+0.38):4 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $names using (0):1:2 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $names using 3:1:4 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d'
