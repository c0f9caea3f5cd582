# The picture of docs/explanation/real_numbers.md: published figures are black, ours coloured. `curves` writes what it reads.
set terminal pngcairo size 1150,1400 font 'sans,11'
set output 'real_numbers.png'
set multiplot layout 3,2 margins 0.075,0.985,0.045,0.965 spacing 0.085,0.075
set grid
set key opaque
ours = '#0060ad'
second = '#d95319'
third = '#77ac30'
fourth = '#7e2f8e'

set title 'Thrust of a drill per mm of its radius'
set xlabel 'feed per turn, mm'
set ylabel 'N/mm'
set logscale xy
set xrange [0.003:0.3]
set yrange [2:500]
set key top left
plot 'published_thrust_hillery.dat' using 1:3:4 with filledcurves fc rgb 'gray80' title 'Hillery and Shuaib 1999, 3.2 mm', \
  'published_thrust_per_feed.dat' using 1:2 with points pt 7 ps 1.4 lc rgb 'black' title 'porcine 5 mm (2014), 2 mm (2020)', \
  'our_thrust_per_feed.dat' using 1:2 with linespoints pt 6 lw 2 lc rgb ours title 'simulated, 2 to 5 mm'

set title 'Force against feed or depth, both relative to the least'
set xlabel 'times the feed or depth'
set ylabel 'times the force'
set xrange [0.9:10]
set yrange [0.8:40]
plot 'published_relative_drill.dat' using 1:2 with linespoints pt 7 dt 2 lc rgb 'black' title 'drill by feed, bovine (Arch. Bone Jt. Surg.)', \
  'published_relative_porcine.dat' using 1:2 with linespoints pt 5 dt 2 lc rgb 'black' title 'drill by feed, porcine (2014)', \
  'published_relative_saw.dat' using 1:2 with linespoints pt 9 dt 2 lc rgb 'black' title 'saw tooth by depth, James 2012', \
  'published_relative_burr.dat' using 1:2 with lines dt 3 lw 2 lc rgb 'black' title 'burr by feed: no change, Danda 2016', \
  'our_groove_by_feed.dat' using 1:2 with linespoints pt 6 lw 2 lc rgb ours title 'simulated, burr by feed', \
  'our_groove_by_depth.dat' using 1:2 with linespoints pt 4 lw 2 lc rgb second title 'simulated, burr by depth'
unset logscale

set title 'Wall of a hole through 5 mm of dry cortex'
set xlabel 'time since the drill went in, s'
set ylabel 'hottest bone, °C'
set xrange [0:12]
set yrange [35:90]
set key top right
plot 'published_wall_56.dat' using 1:2 with lines lw 2 lc rgb 'black' title 'highest of 4.5 mm drills, Augustin 2012', \
  'published_wall_46.dat' using 1:2 with lines lw 2 dt 2 lc rgb 'black' title 'highest of 3.4 mm drills, Augustin 2012', \
  'our_wall_4.5_0.03.dat' using 1:2 with lines lw 2 lc rgb ours title 'simulated, 4.5 mm, 0.03 mm per turn', \
  'our_wall_4.5_0.16.dat' using 1:2 with lines lw 2 lc rgb second title 'simulated, 4.5 mm, 0.16 mm per turn', \
  'our_wall_3.4_0.03.dat' using 1:2 with lines lw 2 lc rgb third title 'simulated, 3.4 mm, 0.03 mm per turn', \
  'our_wall_3.4_0.16.dat' using 1:2 with lines lw 2 lc rgb fourth title 'simulated, 3.4 mm, 0.16 mm per turn'

set title 'Round burr on dry cortex, 1 mm below the cut; 1 N thin, 1.7 N thick'
set xlabel 'time, s'
set ylabel '°C'
set xrange [0:11]
set yrange [35:60]
set key bottom right
plot 'published_burr_at_1_mm.dat' using 1:2 with points pt 7 ps 1.6 lc rgb 'black' title '45,000/min, Singh 2015 (force not stated)', \
  'our_burr_1.7_75000.dat' using 1:2 with lines lw 3 lc rgb second title 'simulated, 75,000/min', \
  'our_burr_1_75000.dat' using 1:2 with lines lw 1 lc rgb second notitle, \
  'our_burr_1.7_45000.dat' using 1:2 with lines lw 3 lc rgb ours title 'simulated, 45,000/min', \
  'our_burr_1_45000.dat' using 1:2 with lines lw 1 lc rgb ours notitle, \
  'our_burr_1.7_35000.dat' using 1:2 with lines lw 3 lc rgb third title 'simulated, 35,000/min', \
  'our_burr_1_35000.dat' using 1:2 with lines lw 1 lc rgb third notitle

set title 'Thrust of a drill of 2.5 mm at 50 mm/min'
set xlabel '1/min'
set ylabel 'N'
set xrange [300:2100]
set yrange [0:140]
set key top right
plot 'published_alam_thrust.dat' using 1:3:4 with filledcurves fc rgb 'gray90' title 'Alam 2011, 3 mm', \
  'published_hillery_thrust.dat' using 1:3:4 with filledcurves fc rgb 'gray75' title 'Hillery and Shuaib 1999, 3.2 mm', \
  'published_orelaja_thrust.dat' using 1:2 with linespoints pt 7 ps 1.4 dt 2 lc rgb 'black' title 'Orelaja 2020, feed not stated', \
  'our_drill.dat' using 1:2 with linespoints pt 6 lw 2 lc rgb ours title 'simulated'

set title 'Torque of the same drill'
set ylabel 'N mm'
set yrange [0:60]
plot 'published_alam_torque.dat' using 1:3:4 with filledcurves fc rgb 'gray90' title 'Alam 2011, 3 mm', \
  'published_hillery_torque.dat' using 1:3:4 with filledcurves fc rgb 'gray75' title 'Hillery and Shuaib 1999, 3.2 mm', \
  'published_orelaja_torque.dat' using 1:2 with linespoints pt 7 ps 1.4 dt 2 lc rgb 'black' title 'Orelaja 2020, feed not stated', \
  'our_drill.dat' using 1:3 with linespoints pt 6 lw 2 lc rgb ours title 'simulated'
unset multiplot
