# Draws phases-render.svg: gnuplot phases-render.gp
set encoding utf8
set terminal svg size 480,362 dynamic noenhanced font 'sans-serif,13' background '#ffffff'
set output 'phases-render.svg'
set datafile separator "\t"
set datafile missing 'NaN'
set datafile commentschars ''
set border 3 linecolor rgb '#9aa3ad' linewidth 1
set tics nomirror scale 0.4 textcolor rgb '#3c444d' font 'sans-serif,12'
set grid linecolor rgb '#e3e7eb' linewidth 1 linetype 1
set key off
set title 'rendering, crytek-sponza, 128 spp' offset 0,-0.55 textcolor rgb '#1b1f24' font 'sans-serif,14'
set xtics offset 0,0.35
set lmargin at screen 0.23333
set rmargin at screen 0.90417
set tmargin at screen 0.90608
set bmargin at screen 0.24309
set xrange [0:9748.7759]
set xlabel 'render time [ms]' offset 0,0.7 textcolor rgb '#3c444d' font 'sans-serif,12'
set xtics 2000
set yrange [9.6:-0.6]
unset ytics
set border 1
set grid noytics
set object 1 rectangle from screen 0.04583,0.08011 to screen 0.06667,0.10773 fillstyle solid noborder fillcolor rgb '#0072b2'
set label 'generate' at screen 0.07708,0.09392 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 2 rectangle from screen 0.36250,0.08011 to screen 0.38333,0.10773 fillstyle solid noborder fillcolor rgb '#e69f00'
set label 'trace primary' at screen 0.39375,0.09392 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 3 rectangle from screen 0.67917,0.08011 to screen 0.70000,0.10773 fillstyle solid noborder fillcolor rgb '#009e73'
set label 'shade' at screen 0.71042,0.09392 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 4 rectangle from screen 0.04583,0.02486 to screen 0.06667,0.05249 fillstyle solid noborder fillcolor rgb '#d55e00'
set label 'trace shadow' at screen 0.07708,0.03867 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 5 rectangle from screen 0.36250,0.02486 to screen 0.38333,0.05249 fillstyle solid noborder fillcolor rgb '#cc79a7'
set label 'accumulate' at screen 0.39375,0.03867 left font 'sans-serif,12' textcolor rgb '#1b1f24'
set object 6 rectangle from screen 0.67917,0.02486 to screen 0.70000,0.05249 fillstyle solid noborder fillcolor rgb '#56b4e9'
set label 'trace bounce' at screen 0.71042,0.03867 left font 'sans-serif,12' textcolor rgb '#1b1f24'
$bars << END_OF_DATA
0	0	42.964576	29362
0	42.964576	927.58466	15113984
0	927.58466	2232.4509	40563
0	2232.4509	6213.1859	13983232
0	6213.1859	6375.292	13400487
0	6375.292	9615.3053	5682409
1	0	43.310364	29362
1	43.310364	964.43958	15113984
1	964.43958	2279.2042	40563
1	2279.2042	5632.7809	13983232
1	5632.7809	5788.7472	13400487
1	5788.7472	9688.1809	5682409
2	0	36.586045	29362
2	36.586045	921.81015	15113984
2	921.81015	2154.3955	40563
2	2154.3955	4969.1838	13983232
2	4969.1838	5103.0005	13400487
2	5103.0005	8115.6914	5682409
3	0	32.68527	29362
3	32.68527	749.64622	15113984
3	749.64622	1937.1453	40563
3	1937.1453	4446.9674	13983232
3	4446.9674	4576.7526	13400487
3	4576.7526	7256.637	5682409
4	0	41.66469	29362
4	41.66469	1136.3449	15113984
4	1136.3449	2459.6654	40563
4	2459.6654	5799.199	13983232
4	5799.199	5959.7257	13400487
4	5959.7257	9739.0369	5682409
5	0	40.961265	29362
5	40.961265	1014.3682	15113984
5	1014.3682	2298.8786	40563
5	2298.8786	5496.1288	13983232
5	5496.1288	5638.3474	13400487
5	5638.3474	8924.0695	5682409
6	0	34.137986	29362
6	34.137986	947.60227	15113984
6	947.60227	2189.2268	40563
6	2189.2268	5203.3352	13983232
6	5203.3352	5344.4484	13400487
6	5344.4484	8575.8155	5682409
7	0	33.306559	29362
7	33.306559	814.97152	15113984
7	814.97152	2041.9708	40563
7	2041.9708	4408.3847	13983232
7	4408.3847	4534.154	13400487
7	4534.154	7484.7014	5682409
8	0	34.694683	29362
8	34.694683	881.70959	15113984
8	881.70959	2076.9311	40563
8	2076.9311	4740.3445	13983232
8	4740.3445	4858.0605	13400487
8	4858.0605	7654.5688	5682409
9	0	31.829588	29362
9	31.829588	464.13576	15113984
9	464.13576	1564.3177	40563
9	1564.3177	3328.7542	13983232
9	3328.7542	3427.9284	13400487
9	3427.9284	5135.5883	5682409
END_OF_DATA
$names << END_OF_DATA
0	"sah"	9615.3053	"9,626"
1	"lbvh"	9688.1809	"9,703"
2	"hlbvh"	8115.6914	"8,127"
3	"atrbvh"	7256.637	"7,267"
4	"kmeans-q1"	9739.0369	"9,753"
5	"kmeans-q2"	8924.0695	"8,936"
6	"kmeans-q3"	8575.8155	"8,587"
7	"kmeans-q4"	7484.7014	"7,497"
8	"kmeans-q5"	7654.5688	"7,667"
9	"embree-high"	5135.5883	"5,143"
END_OF_DATA
plot $bars using (0.5*($2+$3)):1:2:3:($1-0.38):($1+0.38):4 with boxxyerror fillstyle solid noborder linecolor rgb variable, \
  $names using (0):1:2 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \
  $names using 3:1:4 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d'
