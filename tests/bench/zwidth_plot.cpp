#include "tests/bench/zwidth_plot.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>

namespace bonemill::test {
namespace {

void writeCsv(std::ostream& out, const std::vector<ZwidthRow>& rows) {
    out << "variant,place,hand,quantity,rate_hz,largest_stable,is_scan_end,over_default,colgate_n_per_m,drag_"
           "in_air_ns_per_m\n";
    for (const ZwidthRow& r : rows)
        out << r.variant << ',' << r.place << ',' << r.hand << ',' << r.quantity << ',' << r.rate_hz << ','
            << r.largest << ',' << r.is_scan_end << ',' << r.relative << ',' << r.colgate_bound << ','
            << r.drag_in_air << '\n';
}

std::set<std::string> valuesOf(const std::vector<ZwidthRow>& rows,
                               const std::function<std::string(const ZwidthRow&)>& column) {
    std::set<std::string> values;
    for (const ZwidthRow& r : rows) values.insert(column(r));
    return values;
}

std::string blockName(const std::string& panel, const std::string& variant) {
    return "$" + panel + "_" + variant;
}

// One panel per quantity, place and hand; one line per variant.
void writeScript(std::ostream& out, const std::vector<ZwidthRow>& rows) {
    const auto panelOf = [](const ZwidthRow& r) { return r.quantity + "_" + r.place + "_" + r.hand; };
    const auto panels = valuesOf(rows, panelOf);
    const auto variants = valuesOf(rows, [](const ZwidthRow& r) { return r.variant; });
    for (const std::string& panel : panels)
        for (const std::string& variant : variants) {
            out << blockName(panel, variant) << " << EOD\n";
            for (const ZwidthRow& r : rows)
                if (panelOf(r) == panel && r.variant == variant)
                    out << r.rate_hz << ' ' << std::max(r.relative, 0.01) << '\n';
            out << "EOD\n";
        }
    out << "set terminal pngcairo size 1600,800 font 'sans,10'\nset output 'zwidth.png'\n"
           "set multiplot layout 2,4 title 'Largest stable stiffness over its default'\n"
           "set logscale xy\nset xlabel 'loop rate, Hz'\nset xtics (500, 1000, 2000, 4000)\n"
           "set grid\nset key bottom right\nset xrange [400:5000]\nset yrange [0.01:300]\n";
    for (const std::string& panel : panels) {
        out << "set title '" << panel << "' noenhanced\nplot ";
        bool is_first = true;
        for (const std::string& variant : variants) {
            out << (is_first ? "" : ", ") << blockName(panel, variant) << " with linespoints title '"
                << variant << "' noenhanced";
            is_first = false;
        }
        out << '\n';
    }
    out << "unset multiplot\n";
}

}  // namespace

bool writeZwidth(const std::filesystem::path& folder, const std::vector<ZwidthRow>& rows) {
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "zwidth.csv"), script(folder / "zwidth.gp");
    writeCsv(csv, rows);
    writeScript(script, rows);
    csv.close();
    script.close();
    if (!csv || !script) return false;
    const std::string command = "cd '" + folder.string() + "' && gnuplot zwidth.gp";
    if (std::system(command.c_str()) != 0) std::printf("no picture: gnuplot did not run\n");
    return true;
}

}  // namespace bonemill::test
