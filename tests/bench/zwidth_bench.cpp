// Z-width: how stiff coupling and contact may become, by loop rate, before the closed loop with the simulated
// device buzzes.
//
// Device: Plant's defaults (0.25 kg, 2 N·s/m, 0.2 N Coulomb, amplifiers 500 Hz, encoders 5 µm and 0.01°), one
// tick of delay; hand: the default hand, or none and a weight instead. The tool falls or is pressed with 2 N
// against a plane, or leans with 2.2 N and a little torque in a hole with half a voxel of clearance.
// Stable: over 0.5 s after 1 s the force's RMS about its mean stays below 0.05 N and the handle's below
// 10 µm, and the motion does not grow. Stiffness rises from its default by factors of two until the first
// unstable value (or falls until the first stable one); the limit is then bisected to 3 %. One stiffness is
// changed, the other stays at its default. A stiff coupling that lags is also a damper: the drag felt in free
// air at that stiffness is printed beside it, since a wide range of stiffness is worth nothing without it.
//
//   zwidth_bench [--out DIR] [--variant NAME]
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "tests/bench/zwidth_plot.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kSettle = 1.0, kWatch = 0.5;           // s
constexpr double kForceBuzz = 0.05, kMotion = 10e-6;    // N, m; RMS
constexpr double kGrowth = 1.5, kMotionFloor = 0.2e-6;  // growth counts above this RMS (m)
constexpr double kResolution = 1.03;
constexpr double kRates_hz[] = {500, 1000, 2000, 4000};
constexpr double kScanFrom = 1.0 / 64, kScanTo = 256;  // of the default stiffness

struct Place {
    const char* name;
    VoxelVolume (*bone)();
    TestTool (*tool)();
    Pose start;
    Wrench push;
};
const Place kPlaces[] = {{"plane", planeBone, burr, abovePlane(0.2e-3), {{0, 0, -2}, {0, 0, 0}}},
                         {"hole", holeBone, peg, upright(kHoleMiddle), {{2, 0, 1}, {0.0003, 0, 0.0005}}}};
struct Hand {
    const char* name;
    HandPlant plant;
};
const Hand kHands[] = {{"typical", {}}, {"none", kNoHand}};
enum class Quantity { kCoupling, kContact };

bool isStable(Scene& scene, const Place& place, const HandPlant& hand) {
    LoopConfig config;
    config.hand = hand;
    ClosedLoop loop(config, scene, place.start);
    if (hand.stiffness > 0)
        loop.plant.setTarget(place.start.incremented(place.push.force / hand.stiffness,
                                                     place.push.torque / hand.angular_stiffness));
    else
        loop.plant.setBias(place.push);
    loop.run(kSettle);
    const Residual r = residual(loop, kWatch);
    const bool grows = r.position_rms > kMotionFloor && r.growth > kGrowth;
    return r.is_finite && r.is_touching && r.rms < kForceBuzz && r.position_rms < kMotion && !grows;
}

// Largest factor on the default stiffness, connected to a stable start: the default or, if that is unstable,
// the first stable one below it. 0: none found; kScanTo: no end found.
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

// What the hand must push with to move through the air, N·s/m: the other end of the Z-width.
double dragInAir(Scene& scene) {
    constexpr double kSpeed = 0.05;  // m/s
    Stepper stepper(scene);
    for (int n = 0; n < 200; ++n) stepper.step(upright({0, 0, 1 + kSpeed * scene.config.dt * n}));
    return stepper.wrenchOnHand().force.norm() / kSpeed;
}

ZwidthRow measure(const Variant& variant, const Place& place, const Hand& hand, Quantity quantity,
                  double rate_hz) {
    const bool is_coupling = quantity == Quantity::kCoupling;
    double default_stiffness = 0;
    const auto sceneAt = [&](double f) {
        return std::make_unique<Scene>(
            place.bone(), place.tool(), variant, 1 / rate_hz, [&](TickConfig& config) {
                double& stiffness = is_coupling ? couplingStiffness(config) : contactStiffness(config);
                default_stiffness = stiffness;
                stiffness *= f;
            });
    };
    const double factor = largestStable([&](double f) { return isStable(*sceneAt(f), place, hand.plant); });
    const DevicePlant device;
    const double lag = 1.5 / rate_hz + 1 / (2 * M_PI * device.amplifier_hz);
    return {variant.name,
            place.name,
            hand.name,
            is_coupling ? "coupling" : "contact",
            rate_hz,
            factor * default_stiffness,
            factor >= kScanTo,
            factor,
            (device.damping + hand.plant.damping) / lag,
            dragInAir(*sceneAt(factor))};
}

void print(const ZwidthRow& r) {
    std::printf(
        "%-12s %-6s %-8s %-9s %6.0f Hz  %s%11.4g  = %8.3f x default   (Colgate %6.0f N/m)  drag in air %7.2f "
        "N s/m\n",
        r.variant.c_str(), r.place.c_str(), r.hand.c_str(), r.quantity.c_str(), r.rate_hz,
        r.is_scan_end ? ">=" : "  ", r.largest, r.relative, r.colgate_bound, r.drag_in_air);
    std::fflush(stdout);
}

std::vector<ZwidthRow> measureAll(const char* only_variant) {
    std::vector<ZwidthRow> rows;
    for (const Quantity quantity : {Quantity::kCoupling, Quantity::kContact})
        for (const Place& place : kPlaces)
            for (const Hand& hand : kHands)
                for (const Variant& variant : allVariants()) {
                    if (only_variant && variant.name != only_variant) continue;
                    for (const double rate : kRates_hz) {
                        rows.push_back(measure(variant, place, hand, quantity, rate));
                        print(rows.back());
                    }
                }
    return rows;
}

}  // namespace
}  // namespace bonemill::test

int main(int argc, char** argv) {
    const auto valueOf = [&](const char* option) -> const char* {
        for (int i = 1; i + 1 < argc; ++i)
            if (std::strcmp(argv[i], option) == 0) return argv[i + 1];
        return nullptr;
    };
    const auto rows = bonemill::test::measureAll(valueOf("--variant"));
    const char* out = valueOf("--out");
    return rows.empty() || (out && !bonemill::test::writeZwidth(out, rows)) ? 1 : 0;
}
