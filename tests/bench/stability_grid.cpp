// Closes the loop at every point of a grid of devices, ways and hands, and says where it never comes to rest.
//
// The grid: dry friction 0 to 0.5 N, mass 0.03 to 1 kg, damping 0.05 to 5 N·s/m, delay 0 to 3 ticks, encoders
// of 0 to 50 µm, hands from none to stiff, on a plane and in a hole; and, in slices at one friction, jitter
// of a tick, one period in twenty lost, and motors that give 3 N. The device says what it is like; with
// --undeclared only what it gives.
//
// With --random it is 200 random devices instead, each of which says the truth, what is wrong by 30 %, and
// only what it gives.
//
//   stability_grid [--out DIR] [--variant NAME] [--undeclared] [--coarse] [--random]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <thread>

#include "common/process/run_program.h"
#include "tests/bench/stability_plot.h"

namespace bonemill::test {
namespace {

struct Axes {
    std::vector<double> frictions, masses, dampings, steps;
    std::vector<int> delays, hands;
};
const Axes kWhole{{0, 0.02, 0.1, 0.5}, {0.03, 0.1, 0.3, 1}, {0.05, 0.5, 5},
                  {0, 5e-6, 50e-6},    {0, 1, 2, 3},        {0, 1, 2, 3}};
const Axes kCoarse{{0, 0.02, 0.5}, {0.03, 0.1, 1}, {0.05, 0.5, 5}, {5e-6, 50e-6}, {0, 1, 3}, {0, 2}};

struct Way {
    const char* name;
    double jitter_ticks, lost_share, most_force;
};
constexpr Way kWays[] = {{"even", 0, 0, 0}, {"jitter", 1, 0, 0}, {"lost", 0, 0.05, 0}, {"weak", 0, 0, 3}};
constexpr double kFrictionOfSlices = 0.02;

std::vector<GridRow> pointsOf(const Axes& whole, const std::string& variant, Says says) {
    std::vector<GridRow> rows;
    for (const Way& way : kWays) {
        const Axes& axes = &way == kWays ? whole : kCoarse;
        for (const LoopPlace place : {LoopPlace::kPlane, LoopPlace::kHole})
            for (const int hand : axes.hands)
                for (const int delay : axes.delays)
                    for (const double step : axes.steps)
                        for (const double friction : axes.frictions)
                            for (const double mass : axes.masses)
                                for (const double damping : axes.dampings) {
                                    const bool is_slice = &way != kWays;
                                    if (is_slice && friction != kFrictionOfSlices) continue;
                                    rows.push_back({variant,
                                                    way.name,
                                                    LoopPoint{.place = place,
                                                              .hand = hand,
                                                              .friction = friction,
                                                              .mass = mass,
                                                              .damping = damping,
                                                              .delay_ticks = delay,
                                                              .jitter_ticks = way.jitter_ticks,
                                                              .lost_share = way.lost_share,
                                                              .encoder_step = step,
                                                              .most_force = way.most_force},
                                                    says,
                                                    {}});
                                }
    }
    return rows;
}

std::vector<GridRow> randomDevices(const std::string& variant) {
    std::vector<GridRow> rows;
    for (const Says says : {Says::kTruth, Says::kWrong, Says::kLittle})
        for (int n = 0; n < kRandomDevices; ++n)
            rows.push_back({variant, "random", randomDevice(n), says, {}});
    return rows;
}

void printRandom(const std::vector<GridRow>& rows) {
    for (const std::string& variant : variantsOf(rows))
        for (const Says says : {Says::kTruth, Says::kWrong, Says::kLittle}) {
            int quiet = 0, all = 0, kept = 0;
            for (const GridRow& row : rows) {
                if (row.variant != variant || row.says != says) continue;
                ++all;
                quiet += row.verdict.isQuiet();
                kept += row.verdict.share >= 0.9;
            }
            std::printf("%-12s says %-7s %3d of %3d quiet, %3d with 0.9 of the stiffness or more\n",
                        variant.c_str(), nameOf(says), quiet, all, kept);
        }
}

const Variant& variantOf(const std::string& name) {
    for (const Variant& variant : allVariants())
        if (variant.name == name) return variant;
    std::fprintf(stderr, "error: no variant '%s'\n", name.c_str());
    std::exit(2);
}

// It uses every core; the figures do not depend on time.
void tryAll(std::vector<GridRow>& rows) {
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t n = next++; n < rows.size(); n = next++)
            rows[n].verdict = tryLoop(rows[n].point, variantOf(rows[n].variant), rows[n].says);
    };
    std::vector<std::jthread> workers;
    for (unsigned n = 0; n < std::max(1u, std::thread::hardware_concurrency()); ++n)
        workers.emplace_back(work);
}

void printSummary(const std::vector<GridRow>& rows) {
    for (const std::string& variant : variantsOf(rows))
        for (const Way& way : kWays)
            for (const auto& [what, has_friction] :
                 {std::pair{"with dry friction", true}, std::pair{"without", false}}) {
                int all = 0, quiet = 0, lost = 0;
                double worst = 0, worst_torque = 0;
                for (const GridRow& row : rows) {
                    if (row.variant != variant || row.way != way.name ||
                        (row.point.friction > 0) != has_friction)
                        continue;
                    ++all;
                    quiet += row.verdict.isQuiet();
                    lost += row.verdict.is_lost;
                    if (row.verdict.is_lost) continue;
                    worst = std::max(worst, row.verdict.force_rms);
                    worst_torque = std::max(worst_torque, row.verdict.torque_rms);
                }
                if (all > 0)
                    std::printf("%-12s %-6s %-17s %5d of %5d quiet, %4d lost, worst %.4f N, %.4f N mm RMS\n",
                                variant.c_str(), way.name, what, quiet, all, lost, worst, worst_torque * 1e3);
            }
}

}  // namespace
}  // namespace bonemill::test

int main(int argc, char** argv) {
    using namespace bonemill::test;
    std::vector<std::string> names;
    for (const Variant& variant : allVariants()) names.push_back(variant.name);
    std::vector<std::string> variants{"thesis_2012", "balanced"};
    std::string out;
    bool is_coarse = false, is_undeclared = false, is_random = false;
    CLI::App app("where the closed loop never comes to rest: devices, ways and hands (9 minutes)");
    app.add_option("--out", out, "Folder for stability_grid.csv, .gp and .png");
    app.add_option("--variant", variants, "These only")->check(CLI::IsMember(names));
    app.add_flag("--undeclared", is_undeclared, "The device says only what it gives");
    app.add_flag("--coarse", is_coarse, "Fewer points");
    app.add_flag("--random", is_random, "Random devices instead of the grid (2 minutes)");
    CLI11_PARSE(app, argc, argv);
    return bonemill::runProgram([&] {
        std::vector<GridRow> rows;
        const Says says = is_undeclared ? Says::kLittle : Says::kTruth;
        for (const std::string& variant : variants)
            for (const GridRow& row :
                 is_random ? randomDevices(variant) : pointsOf(is_coarse ? kCoarse : kWhole, variant, says))
                rows.push_back(row);
        tryAll(rows);
        is_random ? printRandom(rows) : printSummary(rows);
        if (out.empty()) return 0;
        return (is_random ? writeRandom(out, rows) : writeGrid(out, rows)) ? 0 : 1;
    });
}
