#include "tests/bench/stability_plot.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "common/base/user_error.h"
#include "common/process/gnuplot.h"

namespace bonemill::test {
namespace {

constexpr double kShaking = 0.05;  // N RMS: what a hand calls a buzz

void writeCsv(std::ostream& out, const std::vector<GridRow>& rows) {
    out << "variant,way,says,place,hand,friction_n,mass_kg,damping_ns_per_m,delay_ticks,encoder_step_um,push_"
           "n,"
           "amplifier_hz,has_torque,force_rms_n,torque_rms_nmm,wall_n_per_m,share,is_lost,is_quiet\n";
    for (const GridRow& r : rows)
        out << r.variant << ',' << r.way << ',' << nameOf(r.says) << ',' << nameOf(r.point.place) << ','
            << loopHands()[size_t(r.point.hand)].name << ',' << r.point.friction << ',' << r.point.mass << ','
            << r.point.damping << ',' << r.point.delay_ticks + r.point.late_ticks << ','
            << r.point.encoder_step * 1e6 << ',' << r.point.push << ',' << r.point.amplifier_hz << ','
            << r.point.has_torque << ',' << r.verdict.force_rms << ',' << r.verdict.torque_rms * 1e3 << ','
            << r.verdict.wall << ',' << r.verdict.share << ',' << r.verdict.is_lost << ','
            << r.verdict.isQuiet() << '\n';
}

constexpr const char* kColours =
    "set palette defined (0 '#2e9e4f', 1 '#f0b429', 2 '#d1342f')\nset cbrange [0:2]\nunset colorbox\n";
constexpr const char* kWhatColoursMean =
    "come to rest (green: at most 5 mN and 0.05 N mm RMS; amber: 50 mN; red: more, or lost)";

// 0 green, 1 amber, 2 red.
int colourOf(const LoopVerdict& verdict) {
    if (verdict.isQuiet()) return 0;
    return !verdict.is_lost && verdict.force_rms <= kShaking ? 1 : 2;
}

template <class Value>
void include(std::vector<Value>& values, Value value) {
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
}
template <class Value>
double placeOf(const std::vector<Value>& values, Value value) {
    return double(std::find(values.begin(), values.end(), value) - values.begin());
}

// The columns are place, hand, delay and encoder, the rows friction, mass and damping.
struct Layout {
    std::vector<double> frictions, masses, dampings, steps;
    std::vector<int> hands, delays;

    explicit Layout(const std::vector<GridRow>& rows) {
        for (const GridRow& r : rows) {
            include(frictions, r.point.friction);
            include(masses, r.point.mass);
            include(dampings, r.point.damping);
            include(steps, r.point.encoder_step);
            include(hands, r.point.hand);
            include(delays, r.point.delay_ticks);
        }
    }
    double column(const LoopPoint& p) const {
        double n = p.place == LoopPlace::kHole ? 1 : 0;
        n = n * double(hands.size()) + placeOf(hands, p.hand);
        n = n * double(delays.size()) + placeOf(delays, p.delay_ticks);
        return n * double(steps.size()) + placeOf(steps, p.encoder_step);
    }
    double row(const LoopPoint& p) const {
        double n = placeOf(frictions, p.friction);
        n = n * double(masses.size()) + placeOf(masses, p.mass);
        return n * double(dampings.size()) + placeOf(dampings, p.damping);
    }
};

void writeLabels(std::ostream& out, const Layout& layout) {
    const double per_hand = double(layout.delays.size() * layout.steps.size());
    out << "set xtics (";
    for (int place = 0; place < 2; ++place)
        for (size_t hand = 0; hand < layout.hands.size(); ++hand)
            out << (place + hand > 0 ? ", " : "") << "'" << (place ? "hole, " : "plane, ")
                << loopHands()[size_t(layout.hands[hand])].name << "' "
                << (double(place) * double(layout.hands.size()) + double(hand) + 0.5) * per_hand - 0.5;
    out << ")\nset ytics (";
    const double per_friction = double(layout.masses.size() * layout.dampings.size());
    for (size_t n = 0; n < layout.frictions.size(); ++n)
        out << (n ? ", " : "") << "'" << layout.frictions[n] << " N' "
            << (double(n) + 0.5) * per_friction - 0.5;
    out << ")\n";
}

void writeScript(std::ostream& out, const std::vector<GridRow>& all) {
    std::vector<GridRow> rows;
    std::copy_if(all.begin(), all.end(), std::back_inserter(rows),
                 [](const GridRow& r) { return r.way == "even"; });
    const Layout layout(rows);
    const auto variants = variantsOf(rows);
    out << "set terminal pngcairo size 1700," << 60 + 620 * variants.size()
        << " font 'sans,11'\nset output 'stability_grid.png'\nset multiplot layout " << variants.size()
        << ",1\n"
        << kColours
        << "set tics out nomirror\nset ylabel 'dry friction; in each band mass, then damping upwards'\n"
           "set xlabel 'place and hand; in each band delay, then encoder step to the right'\n";
    writeLabels(out, layout);
    for (const std::string& variant : variants) {
        int quiet = 0, count = 0;
        out << "$" << variant << " << EOD\n";
        for (const GridRow& r : rows) {
            if (r.variant != variant) continue;
            ++count;
            quiet += r.verdict.isQuiet();
            out << layout.column(r.point) << ' ' << layout.row(r.point) << ' ' << colourOf(r.verdict) << '\n';
        }
        out << "EOD\nset title \"" << variant << ": " << quiet << " of " << count << ' ' << kWhatColoursMean
            << "\" noenhanced\nplot $" << variant << " using 1:2:3 with image notitle\n";
    }
    out << "unset multiplot\n";
}

// Each device is a square, forty in a line, and each word of it a band: the truth below.
void writeRandomScript(std::ostream& out, const std::vector<GridRow>& rows) {
    constexpr int kInALine = 40;
    const int lines = (kRandomDevices + kInALine - 1) / kInALine;
    const auto variants = variantsOf(rows);
    out << "set terminal pngcairo size 1300," << 40 + 420 * variants.size()
        << " font 'sans,11'\nset output 'random_devices.png'\nset multiplot layout " << variants.size()
        << ",1\n"
        << kColours << "set tics out nomirror\nunset xtics\nset ylabel 'what the device says of itself'\n";
    const std::vector<Says> words{Says::kTruth, Says::kWrong, Says::kLittle};
    out << "set ytics (";
    for (size_t n = 0; n < words.size(); ++n)
        out << (n ? ", " : "") << "'" << nameOf(words[n]) << "' " << (lines + 1) * int(n) + (lines - 1) / 2.0;
    out << ")\n";
    for (const std::string& variant : variants) {
        int quiet = 0, count = 0;
        out << "$" << variant << " << EOD\n";
        std::vector<int> next(words.size());
        for (const GridRow& r : rows) {
            if (r.variant != variant) continue;
            const size_t word = size_t(placeOf(words, r.says));
            const int n = next[word]++;
            ++count;
            quiet += r.verdict.isQuiet();
            out << n % kInALine << ' ' << (lines + 1) * int(word) + n / kInALine << ' ' << colourOf(r.verdict)
                << '\n';
        }
        out << "EOD\nset title \"" << variant << ", random devices: " << quiet << " of " << count << ' '
            << kWhatColoursMean << "\" noenhanced\nplot [-1:" << kInALine
            << "] [-1:" << (lines + 1) * int(words.size()) - 1 << "] $" << variant
            << " using 1:2:3 with points pt 5 ps 2 palette notitle\n";
    }
    out << "unset multiplot\n";
}

bool write(const std::filesystem::path& folder, const std::string& name, const std::vector<GridRow>& rows,
           void (*script_of)(std::ostream&, const std::vector<GridRow>&)) {
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / (name + ".csv")), script(folder / (name + ".gp"));
    writeCsv(csv, rows);
    script_of(script, rows);
    csv.close();
    script.close();
    if (!csv || !script) return false;
    try {
        runGnuplot(folder / (name + ".gp"));
    } catch (const UserError& error) {
        std::printf("%s\n", error.what());
    }
    return true;
}

}  // namespace

std::vector<std::string> variantsOf(const std::vector<GridRow>& rows) {
    std::vector<std::string> variants;
    for (const GridRow& row : rows) include(variants, row.variant);
    return variants;
}

bool writeGrid(const std::filesystem::path& folder, const std::vector<GridRow>& rows) {
    return write(folder, "stability_grid", rows, writeScript);
}

bool writeRandom(const std::filesystem::path& folder, const std::vector<GridRow>& rows) {
    return write(folder, "random_devices", rows, writeRandomScript);
}

}  // namespace bonemill::test
