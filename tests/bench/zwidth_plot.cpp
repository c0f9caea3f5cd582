#include "tests/bench/zwidth_plot.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <set>

#include "common/base/user_error.h"
#include "common/process/gnuplot.h"

namespace bonemill::test {
namespace {

void writeCsv(std::ostream& out, const std::vector<ZwidthRow>& rows) {
    out << "quantity,place,hand,variant,rate_hz,rendered_n_per_m,drag_in_air_ns_per_m,coupling_n_per_m,"
           "contact,"
           "contact_to_default,is_scan_end,colgate_n_per_m\n";
    for (const ZwidthRow& r : rows)
        out << r.quantity << ',' << r.place << ',' << r.hand << ',' << r.variant << ',' << r.rate_hz << ','
            << r.rendered << ',' << r.drag_in_air << ',' << r.coupling << ',' << r.contact << ','
            << r.contact_to_default << ',' << r.is_scan_end << ',' << r.colgate_bound << '\n';
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

// Draws a row of panels with the rendered stiffness by rate: one panel per place and hand, one line
// per variant.
void writePanels(std::ostream& out, const std::vector<ZwidthRow>& all, const std::string& quantity,
                 const std::string& title) {
    std::vector<ZwidthRow> rows;
    for (ZwidthRow r : all) {
        if (r.quantity == "tuned" && quantity == "zwidth") {
            r.variant += "_tuned";
            r.quantity = quantity;
        }
        if (r.quantity == quantity) rows.push_back(r);
    }
    const auto panelOf = [](const ZwidthRow& r) { return r.quantity + "_" + r.place + "_" + r.hand; };
    const auto variants = valuesOf(rows, [](const ZwidthRow& r) { return r.variant; });
    for (const std::string& panel : valuesOf(rows, panelOf)) {
        std::string place_and_hand, plot;
        for (const std::string& variant : variants) {
            out << blockName(panel, variant) << " << EOD\n";
            for (const ZwidthRow& r : rows)
                if (panelOf(r) == panel && r.variant == variant && r.rendered > 0) {
                    out << r.rate_hz << ' ' << r.rendered << '\n';
                    place_and_hand = r.place + (r.hand == "none" ? ", no hand" : ", " + r.hand + " hand");
                }
            out << "EOD\n";
            const bool is_baseline = variant.starts_with("thesis_2012");
            plot += (plot.empty() ? "" : ", ") + blockName(panel, variant) + " with linespoints lw 2 dt " +
                    (is_baseline ? "2" : "1") + " title '" + variant + "' noenhanced";
        }
        out << "set title \"" << title << "\\n" << place_and_hand << "\"\nplot " << plot << '\n';
    }
}

void writeScript(std::ostream& out, const std::vector<ZwidthRow>& rows) {
    out << "set terminal pngcairo size 1700,900 font 'sans,10'\nset output 'zwidth.png'\n"
           "set linetype 4 lc rgb 'black'\nset linetype 5 lc rgb 'red'\n"  // in the order of the names
           "set multiplot layout 2,4\nset logscale xy\nset xlabel 'loop rate, Hz'\n"
           "set xtics (500, 1000, 2000, 4000)\nset ylabel 'rendered wall, N/m'\n"
           "set grid\nset key bottom right\nset xrange [400:5000]\nset yrange [300:300000]\n";
    writePanels(out, rows, "zwidth", "drag in free air at most 3 N s/m");
    writePanels(out, rows, "coupling", "largest k_t, drag as it comes");
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
    try {
        runGnuplot(folder / "zwidth.gp");
    } catch (const UserError& error) {
        std::printf("%s\n", error.what());
    }
    return true;
}

}  // namespace bonemill::test
