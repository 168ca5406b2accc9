# Draws phases-builders.svg: gnuplot phases-builders.gp
set encoding utf8
set terminal svg size 480,402 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'phases-builders.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'all builders, crytek-sponza' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.91542
set bmargin at screen 0.31841
set xrange [0:256.37898]
set xlabel 'build time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics 50
set yrange [9.6:-0.6]
unset ytics
set border 1
set grid noytics
set object 1 rectangle from screen 0.04583,0.17164 to screen 0.06667,0.19652 fillstyle solid noborder fillcolor rgb '#0072b2'
set label 'boxes' at screen 0.07708,0.18408 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 2 rectangle from screen 0.36250,0.17164 to screen 0.38333,0.19652 fillstyle solid noborder fillcolor rgb '#e69f00'
set label 'sorting' at screen 0.39375,0.18408 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 3 rectangle from screen 0.67917,0.17164 to screen 0.70000,0.19652 fillstyle solid noborder fillcolor rgb '#009e73'
set label 'hierarchy' at screen 0.71042,0.18408 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 4 rectangle from screen 0.04583,0.12189 to screen 0.06667,0.14677 fillstyle solid noborder fillcolor rgb '#d55e00'
set label 'sweep' at screen 0.07708,0.13433 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 5 rectangle from screen 0.36250,0.12189 to screen 0.38333,0.14677 fillstyle solid noborder fillcolor rgb '#cc79a7'
set label 'treelets' at screen 0.39375,0.13433 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 6 rectangle from screen 0.67917,0.12189 to screen 0.70000,0.14677 fillstyle solid noborder fillcolor rgb '#56b4e9'
set label 'k-means' at screen 0.71042,0.13433 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 7 rectangle from screen 0.04583,0.07214 to screen 0.06667,0.09701 fillstyle solid noborder fillcolor rgb '#666666'
set label 'agglomeration' at screen 0.07708,0.08458 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 8 rectangle from screen 0.36250,0.07214 to screen 0.38333,0.09701 fillstyle solid noborder fillcolor rgb '#bfae00'
set label 'collapse, layout' at screen 0.39375,0.08458 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 9 rectangle from screen 0.67917,0.07214 to screen 0.70000,0.09701 fillstyle solid noborder fillcolor rgb '#7a5195'
set label 'embree' at screen 0.71042,0.08458 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 10 rectangle from screen 0.04583,0.02239 to screen 0.06667,0.04726 fillstyle solid noborder fillcolor rgb '#dfe3e7'
set label 'not in a phase' at screen 0.07708,0.03483 left font 'sans-serif,12' textcolor rgb '#1b1f24'
$bars << END_OF_DATA
0	0	2.2078565	29362
0	2.2078565	12.545886	15113984
0	12.545886	102.65077	13983232
0	102.65077	114.68891	12561920
0	114.68891	125.85972	14672871
1	0	4.0357785	29362
1	4.0357785	9.280628	15113984
1	9.280628	12.767669	40563
1	12.767669	23.965537	12561920
1	23.965537	24.663247	14672871
2	0	4.0664285	29362
2	4.0664285	9.95739	15113984
2	9.95739	15.96816	40563
2	15.96816	20.974538	13400487
2	20.974538	34.212604	12561920
2	34.212604	35.008791	14672871
3	0	3.681879	29362
3	3.681879	9.0335415	15113984
3	9.0335415	15.941308	40563
3	15.941308	42.011592	13400487
3	42.011592	56.438611	12561920
3	56.438611	60.502747	14672871
4	0	11.903597	29362
4	11.903597	41.878691	5682409
4	41.878691	44.222513	6710886
4	44.222513	56.96698	12561920
4	56.96698	62.160226	14672871
5	0	10.981938	29362
5	10.981938	53.528975	5682409
5	53.528975	55.738844	6710886
5	55.738844	68.00055	12561920
5	68.00055	75.103628	14672871
6	0	12.246489	29362
6	12.246489	62.395283	5682409
6	62.395283	66.121391	6710886
6	66.121391	78.713392	12561920
6	78.713392	80.768607	14672871
7	0	10.125386	29362
7	10.125386	82.229802	5682409
7	82.229802	87.009546	6710886
7	87.009546	100.03922	12561920
7	100.03922	105.4448	14672871
8	0	10.539241	29362
8	10.539241	123.08176	5682409
8	123.08176	131.51574	6710886
8	131.51574	145.6662	12561920
8	145.6662	150.00688	14672871
9	0	256.12286	8016277
END_OF_DATA
$names << END_OF_DATA
0	"sah"	125.85972	"126"
1	"lbvh"	24.663247	"24.7"
2	"hlbvh"	35.008791	"35.0"
3	"atrbvh"	60.502747	"60.5"
4	"kmeans-q1"	62.160226	"62.2"
5	"kmeans-q2"	75.103628	"75.1"
6	"kmeans-q3"	80.768607	"80.8"
7	"kmeans-q4"	105.4448	"105"
8	"kmeans-q5"	150.00688	"150"
9	"embree-high"	256.12286	"256"
END_OF_DATA
plot $bars using (0.5*($2+$3)):1:2:3:($1-0.38):($1+0.38):4 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $names using (0):1:2 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $names using 3:1:4 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d'
