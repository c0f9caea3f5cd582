// Shows the sixth degree of freedom in one picture: a burr of 1 mm radius, spindle at 40,000 rpm, is pressed
// sidewards into a block that is not milled, without and with cutting_force. Writes axis_torque.csv,
// axis_torque.gp and axis_torque.png; nothing in them depends on time.
//
//   axis_torque_plot --out DIR
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "common/process/gnuplot.h"
#include "common/process/run_program.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {
namespace {

constexpr double kSpin = 40'000 * 2 * M_PI / 60;  // rad/s
constexpr int kTicks = 3000;

struct Row {
    double force, torque, spin, motor_power, friction_power;
};

// Returns how far the hand presses, m, at this time, s: in two steps, and out again.
double pressAt(double t) {
    const auto ramp = [&](double from, double seconds) { return std::clamp((t - from) / seconds, 0.0, 1.0); };
    return 1e-3 * ramp(0.5, 0.3) + 1e-3 * ramp(1.3, 0.3) - 2.2e-3 * ramp(2.2, 0.4);
}

std::vector<Row> run(bool has_cutting_force) {
    Scene scene(planeBone(), burr(), {"balanced", Preset::kBalanced}, kMilli, [=](FixedTickConfig& config) {
        config.tool.burr.speed = kSpin;
        config.effects = {};
        config.effects.spindle = test::kSpindle;
        if (has_cutting_force) config.effects.cutting_force = test::kCuttingForce;
    });
    Stepper stepper(scene);
    std::vector<Row> rows;
    for (int n = 0; n < kTicks; ++n) {
        const double t = n * kMilli;
        const TickRecord& record =
            stepper.step(abovePlane(0.05e-3 - pressAt(t)), t < 0.1 ? 0 : uint32_t(kButtonRemove));
        const EffectRecord& effects = record.effects;
        const Wrench& felt = stepper.wrenchOnHand();
        rows.push_back({felt.force.z(), -felt.torque.y(), double(effects.spin_speed),
                        double(effects.axis_torque) * double(effects.spin_speed),
                        double(effects.cutting_power)});
    }
    return rows;
}

void writeCsv(const std::filesystem::path& file, const std::vector<Row>& off, const std::vector<Row>& on) {
    std::ofstream out(file);
    out << "t_s,normal_force_n,torque_off_nmm,torque_on_nmm,mu_f_r_nmm,spin_krpm,m_omega_w,friction_w\n";
    for (size_t n = 0; n < on.size(); ++n)
        out << double(n) * kMilli << ',' << on[n].force << ',' << off[n].torque / kMilli << ','
            << on[n].torque / kMilli << ',' << Burr{}.friction * on[n].force * kBurrRadius / kMilli << ','
            << on[n].spin / kRpm * kMilli << ',' << on[n].motor_power << ',' << on[n].friction_power << '\n';
}

constexpr const char* kScript = R"(set terminal pngcairo size 900,800 font 'sans,11'
set output 'axis_torque.png'
set datafile separator ','
set multiplot layout 2,1
set grid
set xrange [0:3]
set xlabel 'time, s'
set ylabel 'torque about the axis, N mm'
set y2label 'normal force, N'
set y2tics
set ytics nomirror
set yrange [-0.5:4.5]
set y2range [-1.5:13.5]
set key top right
set title "Torque on the hand about the burr's own axis"
plot 'axis_torque.csv' skip 1 using 1:2 axes x1y2 with lines lc rgb 'gray60' title 'normal force', \
  '' skip 1 using 1:3 with lines lw 3 lc rgb '#0060ad' title 'cutting\_force off', \
  '' skip 1 using 1:4 with lines lw 3 lc rgb '#d95319' title 'cutting\_force on', \
  '' skip 1 using 1:5 with lines lw 1.5 dt 2 lc rgb 'black' title '{/Symbol m}_c F R'
set title 'Power: of the torque, and of friction'
set ylabel 'power, W'
set y2label 'spin, 1000/min'
set yrange [-2:18]
set y2range [-5:45]
set key at graph 0.99, 0.75
plot 'axis_torque.csv' skip 1 using 1:6 axes x1y2 with lines lc rgb 'gray60' title 'spin', \
  '' skip 1 using 1:7 with lines lw 4 lc rgb '#d95319' title 'M {/Symbol W}', \
  '' skip 1 using 1:8 with lines lw 1.5 dt 2 lc rgb 'black' title '{/Symbol m}_c {/Symbol S} F v_c'
unset multiplot
)";

int writeAll(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    writeCsv(folder / "axis_torque.csv", run(false), run(true));
    std::ofstream(folder / "axis_torque.gp") << kScript;
    runGnuplot(folder / "axis_torque.gp");
    return 0;
}

}  // namespace
}  // namespace bonemill::test

int main(int argc, char** argv) {
    if (argc != 3 || std::strcmp(argv[1], "--out") != 0) {
        std::fprintf(stderr, "usage: axis_torque_plot --out DIR\n");
        return 2;
    }
    return bonemill::runProgram([&] { return bonemill::test::writeAll(argv[2]); });
}
