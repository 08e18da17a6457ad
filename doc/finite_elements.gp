# Draws finite_elements.png: gnuplot finite_elements.gp, in this folder.
set terminal pngcairo size 1600,1180 font "DejaVu Sans,20" linewidth 1.6
set output "finite_elements.png"
set datafile missing "nan"
set multiplot layout 2,2 margins 0.085,0.985,0.105,0.90 spacing 0.06,0.10 \
    title "Force of each contact model over finite elements: one elastic sphere between rigid plates" font ",24"
set grid lc rgb "#dddddd"
set border 3
set tics nomirror out
set xrange [0:0.155]
set yrange [0.35:1.45]
set format y "%.1f"
unset key
models = "independent point_force_on_sphere sphere_to_sphere elastic_half_space mc_dem elastic_sphere"
titles = "'Independent' 'Point force on sphere' 'Sphere to sphere' 'Half space, gamma = 1' 'MC-DEM, gamma = 1.125' 'Elastic sphere'"
colours = "#0072b2 #56b4e9 #009e73 #e69f00 #d55e00 #000000"
do for [panel=1:4] {
    plates = panel <= 2 ? "two_plates" : "six_plates"
    nu = panel % 2 ? "0.3" : "0.49"
    set title (panel <= 2 ? "two plates" : "six plates").", Poisson ratio ".nu offset 0,-0.6
    set ylabel panel % 2 ? "force / finite elements" : ""
    set xlabel panel > 2 ? "overlap / radius" : ""
    if (panel == 2) { set key left bottom Left reverse maxrows 3 samplen 1.5 width -2 font ",16" } else { unset key }
    plot 1 with lines lc rgb "#999999" dt 2 notitle, \
        for [m=1:6] sprintf("< awk '$1 == \"%s\" && $2 == %s' finite_elements.txt", plates, nu) using 3:(column(3 + m)) \
        with linespoints pt 7 ps (m == 6 ? 1.3 : 0.8) lw (m == 6 ? 3 : 1.8) lc rgb word(colours, m) title word(titles, m)
}
unset multiplot
