// The Z-width is how far apart free air and a wall may be, by loop rate, before the closed loop with the
// simulated device buzzes (Colgate and Brown 1994).
//
// The device has Plant's defaults (0.25 kg, 2 N·s/m, 0.2 N Coulomb, amplifiers 500 Hz, encoders 5 µm and
// 0.01°) and one tick of delay; the hand is the default hand, or none and a weight instead. The tool falls or
// is pressed with 2 N against a plane, or leans with 2.2 N and a little torque in a hole with half a voxel of
// clearance. It is stable if over 0.5 s after 0.5 s the force's RMS about its mean stays below 0.05 N and the
// handle's below 10 µm, and the motion does not grow.
//
// The wall is the rendered stiffness, the static change of force over a change of the device's place of ±20
// µm about where the run came to rest, along the push. Free air is the drag, force over speed at 50 mm/s.
// Both are measured. The quantities are:
//   zwidth    largest rendered stiffness with at most 3 N·s/m of drag, over k_t and the contact's stiffness
//             (default × 1, 4, 16, 64); the gradient presets take damping time 3 N·s/m / k_t, thesis_2012 is
//             as printed
//   tuned     the same for thesis_2012 with its static damping chosen for 3 N·s/m, which the thesis does
//             not do
//   coupling  at the largest stable k_t, all else at its default, drag as it comes
//   contact   at the largest stable contact stiffness, likewise
// A stiffness rises from its default by factors of two until the first unstable value (or falls until the
// first stable one); the limit is then bisected to 3 %.
//
//   zwidth_bench [--out DIR] [--variant NAME] [--rate HZ]
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <thread>

#include "common/process/run_program.h"
#include "tests/bench/zwidth_plot.h"
#include "tests/stability/hard_scenes.h"
#include "tests/stability/pressed.h"

namespace bonemill::test {
namespace {

constexpr double kResolution = 1.03;
constexpr double kRates_hz[] = {500, 1000, 2000, 4000};
constexpr double kMaxDrag = 3, kDragSlack = 1e-3;  // N·s/m; share, of rounding
constexpr double kContactFactors[] = {1, 4, 16, 64};
constexpr double kScanFrom = 1.0 / 64, kScanTo = 256;  // of the default stiffness

// Returns the largest factor on the default stiffness that is connected to a stable start: the default or, if
// that is unstable, the first stable one below it. 0 says that none was found, kScanTo that no end was found.
template <class StableAt>
double largestStable(StableAt&& stable_at) {
    double low = 1;
    while (low >= kScanFrom && !stable_at(low)) low /= 2;
    if (low < kScanFrom) return 0;
    double high = 2 * low;
    while (low >= 1 && high <= kScanTo && stable_at(high)) {
        low = high;
        high *= 2;
    }
    if (high > kScanTo) return low;
    while (high / low > kResolution) {
        const double middle = std::sqrt(low * high);
        (stable_at(middle) ? low : high) = middle;
    }
    return low;
}

// Returns what the hand must push with to move through the air, N·s/m: the other end of the Z-width.
double dragInAir(Scene& scene) {
    constexpr double kSpeed = 0.05;  // m/s
    Stepper stepper(scene);
    for (int n = 0; n < 200; ++n) stepper.step(upright({0, 0, 1 + kSpeed * scene.config.dt * n}));
    return stepper.wrenchOnHand().force.norm() / kSpeed;
}

struct Setup {
    const Variant& variant;
    const PressPlace& place;
    const PressHand& hand;
    double rate_hz;
    bool tunes_baseline = false;

    // Takes factors on the defaults; `drag` > 0 sets the damping, of thesis_2012 only if tunes_baseline.
    std::unique_ptr<Scene> scene(double coupling, double contact, double drag) const {
        return std::make_unique<Scene>(place.bone(), place.tool(), variant, 1 / rate_hz,
                                       [&](FixedTickConfig& config) {
                                           couplingStiffness(config) *= coupling;
                                           contactStiffness(config) *= contact;
                                           if (drag > 0 && (tunes_baseline || !variant.isBaseline()))
                                               setDragInAir(config, drag);
                                       });
    }
    bool isStable(double coupling, double contact, double drag) const {
        const auto tried = scene(coupling, contact, drag);
        if (drag > 0 && dragInAir(*tried) > drag * (1 + kDragSlack)) return false;
        return Pressed(*tried, place, hand.plant).isStable();
    }
    ZwidthRow row(const char* quantity, double coupling, double contact, double drag) const;
};

ZwidthRow Setup::row(const char* quantity, double coupling, double contact, double drag) const {
    const DevicePlant device;
    const double lag = 1.5 / rate_hz + 1 / (2 * M_PI * device.amplifier_hz);
    ZwidthRow row{variant.name, place.name, hand.name, quantity, rate_hz};
    row.colgate_bound = (device.damping + hand.plant.damping) / lag;
    row.is_scan_end = std::max(coupling, contact) >= kScanTo;
    if (coupling * contact == 0) return row;
    const auto best = scene(coupling, contact, drag);
    row.coupling = couplingStiffness(best->config);
    row.contact = contactStiffness(best->config);
    row.contact_to_default = contact;
    Pressed pressed(*best, place, hand.plant);
    if (!pressed.isStable()) return row;
    row.rendered = pressed.rendered();
    row.drag_in_air = dragInAir(*best);
    return row;
}

ZwidthRow zwidth(const Setup& setup) {
    ZwidthRow best;
    for (const double contact : kContactFactors) {
        const double coupling = largestStable([&](double f) { return setup.isStable(f, contact, kMaxDrag); });
        const ZwidthRow row = setup.row(setup.tunes_baseline ? "tuned" : "zwidth", coupling,
                                        contact * (coupling > 0), kMaxDrag);
        if (best.variant.empty() || row.rendered > best.rendered) best = row;
    }
    return best;
}

ZwidthRow largestCoupling(const Setup& setup) {
    return setup.row("coupling", largestStable([&](double f) { return setup.isStable(f, 1, 0); }), 1, 0);
}

ZwidthRow largestContact(const Setup& setup) {
    return setup.row("contact", 1, largestStable([&](double f) { return setup.isStable(1, f, 0); }), 0);
}

void print(const ZwidthRow& r) {
    std::printf(
        "%-8s %-5s %-7s %-11s %4.0f Hz  rendered %8.0f N/m  drag %7.2f N s/m  k_t %9.0f N/m  contact %s%9.3f "
        "x default  "
        "(Colgate %6.0f N/m)\n",
        r.quantity.c_str(), r.place.c_str(), r.hand.c_str(), r.variant.c_str(), r.rate_hz, r.rendered,
        r.drag_in_air, r.coupling, r.is_scan_end ? "scan end " : "", r.contact_to_default, r.colgate_bound);
    std::fflush(stdout);
}

struct Job {
    ZwidthRow (*quantity)(const Setup&);
    Setup setup;
};

// Ours and the thesis', then the laws of other schools.
const std::vector<Variant>& measuredVariants() {
    static const std::vector<Variant> kVariants = [] {
        std::vector<Variant> list = allVariants();
        list.insert(list.end(), lawVariants().begin(), lawVariants().end());
        return list;
    }();
    return kVariants;
}

std::vector<Job> jobs(const char* only_variant, double only_rate) {
    std::vector<Job> all;
    for (const PressPlace& place : pressPlaces())
        for (const PressHand& hand : pressHands())
            for (const Variant& variant : measuredVariants()) {
                if (only_variant && variant.name != only_variant) continue;
                for (const double rate : kRates_hz) {
                    if (only_rate > 0 && rate != only_rate) continue;
                    const Setup setup{variant, place, hand, rate};
                    for (ZwidthRow (*quantity)(const Setup&) : {zwidth, largestCoupling, largestContact})
                        all.push_back({quantity, setup});
                    if (variant.isBaseline()) all.push_back({zwidth, {variant, place, hand, rate, true}});
                }
            }
    return all;
}

// It uses every core; the figures do not depend on time.
std::vector<ZwidthRow> measureAll(const char* only_variant, double only_rate) {
    const std::vector<Job> all = jobs(only_variant, only_rate);
    std::vector<ZwidthRow> rows(all.size());
    std::atomic<size_t> next = 0;
    const auto work = [&] {
        for (size_t n = next++; n < all.size(); n = next++) {
            rows[n] = all[n].quantity(all[n].setup);
            print(rows[n]);
        }
    };
    std::vector<std::jthread> workers;
    for (unsigned n = 0; n < std::max(1u, std::thread::hardware_concurrency()); ++n)
        workers.emplace_back(work);
    workers.clear();
    std::stable_sort(rows.begin(), rows.end(),
                     [](const ZwidthRow& a, const ZwidthRow& b) { return a.quantity > b.quantity; });
    return rows;
}

}  // namespace
}  // namespace bonemill::test

int main(int argc, char** argv) {
    if (argc % 2 == 0) {
        std::puts(
            "zwidth_bench [--out DIR] [--variant NAME] [--rate HZ]: the Z-width by loop rate, see "
            "docs/explanation/stability.md");
        return 2;
    }
    const auto valueOf = [&](const char* option) -> const char* {
        for (int i = 1; i + 1 < argc; ++i)
            if (std::strcmp(argv[i], option) == 0) return argv[i + 1];
        return nullptr;
    };
    const char* rate = valueOf("--rate");
    const char* out = valueOf("--out");
    return bonemill::runProgram([&] {
        const auto rows = bonemill::test::measureAll(valueOf("--variant"), rate ? std::atof(rate) : 0);
        return rows.empty() || (out && !bonemill::test::writeZwidth(out, rows)) ? 1 : 0;
    });
}
