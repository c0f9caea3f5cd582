// Closed loop against a plane over devices, hands, delays and encoders.
#include <cstdio>

#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kPush = 2;            // N, by the hand's spring or, with no hand, a weight
constexpr double kLargestBuzz = 0.05;  // N RMS

template <class Kind>
struct Named {
    const char* name;
    Kind value;
};

// Ends and middle of the ranges in ALGORITHMS §5.
const Named<DevicePlant> kDevices[] = {
    {"light", {.mass = 0.1, .damping = 0.5, .coulomb = 0.1, .inertia = 2e-5, .amplifier_hz = 1000}},
    {"typical", {}},
    {"heavy", {.mass = 0.4, .damping = 5, .coulomb = 0.5, .inertia = 1e-4, .amplifier_hz = 200}},
};
const Named<HandPlant> kHands[] = {
    {"none", kNoHand},
    {"soft", {0.05, 1, 50, 1e-5, 0.002, 0.1}},
    {"typical", {}},
    {"stiff", {0.2, 15, 1000, 1e-4, 0.05, 2}},
};
struct Encoders {
    double step, angle_deg;
};
constexpr Encoders kEncoders[] = {{5e-6, 0.01}, {20e-6, 0.05}};

struct GridPoint {
    LoopConfig config;
    std::string name;
    // Colgate: viscous damping over K (T/2 + delay), with the amplifier's lag as delay. Below 1 no virtual
    // spring of the coupling's stiffness can be promised to be stable.
    double damping_ratio = 0;
};

std::vector<GridPoint> gridPoints(const CouplingConfig& coupling, double dt) {
    std::vector<GridPoint> points;
    for (const auto& device : kDevices)
        for (const auto& hand : kHands)
            for (const int delay : {1, 2, 3})
                for (const Encoders& encoders : kEncoders) {
                    GridPoint point{{delay, device.value, hand.value}, "", 0};
                    point.config.device.encoder_step = encoders.step;
                    point.config.device.encoder_angle = degrees(encoders.angle_deg);
                    const double lag = dt / 2 + delay * dt + 1 / (2 * M_PI * device.value.amplifier_hz);
                    point.damping_ratio =
                        (device.value.damping + hand.value.damping) / (coupling.translation_stiffness * lag);
                    point.name = std::string(device.name) + "/" + hand.name + "/" + std::to_string(delay) +
                                 "/" + std::to_string(int(encoders.step * 1e6)) + "um";
                    points.push_back(point);
                }
    return points;
}

double buzz(Scene& scene, const LoopConfig& config) {
    ClosedLoop loop(config, scene, abovePlane(0.2e-3));
    if (config.hand.stiffness > 0)
        loop.plant.setTarget(abovePlane(-kPush / config.hand.stiffness));
    else
        loop.plant.setBias({{0, 0, -kPush}, {0, 0, 0}});
    loop.run(0.5);
    const Residual r = residual(loop, 0.3);
    return r.is_finite ? r.rms : kNan;
}

// Worst buzz over the points that are passive by Colgate's bound.
double passivePoints(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    double worst = 0;
    for (const GridPoint& point : gridPoints(scene.config.coupling, scene.config.dt)) {
        if (point.damping_ratio < 1) continue;
        const double figure = buzz(scene, point.config);
        if (!(figure <= worst)) worst = figure;
    }
    return worst;
}

// All points: how many buzz, in %. Printed one by one.
double buzzingPoints(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    int buzzing = 0, count = 0;
    for (const GridPoint& point : gridPoints(scene.config.coupling, scene.config.dt)) {
        const double figure = buzz(scene, point.config);
        buzzing += !(figure <= kLargestBuzz);
        ++count;
        std::printf("  %-28s damping ratio %5.2f  %8.4f N rms%s\n", point.name.c_str(), point.damping_ratio,
                    figure, figure <= kLargestBuzz ? "" : "  BUZZES");
    }
    return 100.0 * buzzing / count;
}

const std::vector<StabilityCase> kCases{
    {"closed_loop_grid_passive", "N_rms_worst", kLargestBuzz, passivePoints, {}},
    {"closed_loop_grid_all", "percent_buzzing", 0, buzzingPoints, {"thesis_2012"}},
};
BONEMILL_STABILITY_CASES(ClosedLoopGrid, kCases);

}  // namespace
}  // namespace bonemill::test
