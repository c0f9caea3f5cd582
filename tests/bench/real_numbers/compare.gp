# Measured against predicted, for docs/explanation/real_numbers.md. `compare` writes what it reads.
set terminal pngcairo size 800,760 font 'sans,11'
set output 'predictions.png'
set logscale xy
set xrange [1.5:400]
set yrange [1:400]
set grid
set key top left opaque
set xlabel 'measured: N, N mm, K; mm^2 above 50 °C per mm of groove'
set ylabel 'predicted'
set title 'Open: fitted. Filled: predicted, with interval, before it was looked up. Grey: within a factor of 1.5'
set label 'Zhang, area' at 21.5,2.4
set label 'Abouzgia, force of the peak' at 3.4,1.25
set label 'MacAvelia' at 120,36
set label 'MacAvelia' at 11,48
fitted = '#0060ad'
torque = '#d95319'
heat = '#77ac30'
plot [1.5:400] '+' using 1:($1/1.5):($1*1.5) with filledcurves fc rgb 'gray88' notitle, \
  x with lines lc rgb 'gray40' notitle, \
  'fitted_thrust.dat' using 1:4 with points pt 6 ps 1.4 lw 1.5 lc rgb fitted title 'thrust of drills', \
  'fitted_torque.dat' using 1:4 with points pt 4 ps 1.4 lw 1.5 lc rgb torque title 'torque of drills', \
  'predicted_thrust.dat' using 1:4:2:3:5:6 with xyerrorbars pt 7 ps 1.6 lw 1.5 lc rgb fitted title 'thrust, human femur', \
  'predicted_torque.dat' using 1:4:2:3:5:6 with xyerrorbars pt 5 ps 1.6 lw 1.5 lc rgb torque title 'torque, human femur', \
  'predicted_heat.dat' using 1:4:2:3:5:6 with xyerrorbars pt 9 ps 1.8 lw 1.5 lc rgb heat title 'heat of grinding and drilling', \
  'fitted_heat.dat' using 1:4 with points pt 8 ps 1.6 lw 1.5 lc rgb heat title 'heat, shares set after the predictions were opened'
