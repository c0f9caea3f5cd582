// Closes the loop against a plane and in a hole, over devices, hands, delays and encoders.
#include <cstdio>

#include "common/base/units.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kPush = 2;        // N, by the hand's spring or, with no hand, a weight
constexpr double kMaxBuzz = 0.05;  // N RMS

template <class Kind>
struct Named {
    const char* name;
    Kind value;
};

// These are the ends and the middle of the ranges in docs/explanation/stability.md.
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
    // By Colgate it is the viscous damping over K (T/2 + delay), with the amplifier's lag as delay, the
    // worse of translation and rotation. Below 1 no virtual spring of the coupling's stiffness can be
    // promised to be stable.
    double damping_ratio = 0;
};

std::vector<GridPoint> gridPoints(const CouplingFigures& coupling, double dt) {
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
                        std::min((device.value.damping + hand.value.damping) / coupling.translation_stiffness,
                                 (device.value.angular_damping + hand.value.angular_damping) /
                                     coupling.rotation_stiffness) /
                        lag;
                    point.name = std::string(device.name) + "/" + hand.name + "/" + std::to_string(delay) +
                                 "/" + std::to_string(int(encoders.step * kPerMicrometre)) + "um";
                    points.push_back(point);
                }
    return points;
}

// `push` is what the hand's springs, stretched from the start pose, or with no hand a weight pull with.
double buzz(Scene& scene, const LoopConfig& config, const Pose& start, const Wrench& push) {
    ClosedLoop loop(config, scene, start);
    const HandPlant& hand = config.hand;
    if (hand.stiffness > 0)
        loop.plant.setTarget(
            start.incremented(push.force / hand.stiffness, push.torque / hand.angular_stiffness));
    else
        loop.plant.setBias(push);
    return forceBuzz(loop, 0.5, 0.2);
}

struct GridScene {
    VoxelVolume (*bone)();
    TestTool (*tool)();
    Pose start;
    Wrench push;
};
const GridScene kOnPlane{planeBone, burr, abovePlane(0.2e-3), {{0, 0, -kPush}, {0, 0, 0}}};
const GridScene kInHole{holeBone, peg, upright(kHoleMiddle), {{kPush, 0, kPush / 2}, {0.0003, 0, 0.0005}}};

// Returns the worst buzz over the points that are passive by Colgate's bound.
double passivePoints(const Variant& variant, const GridScene& grid) {
    Scene scene(grid.bone(), grid.tool(), variant);
    double worst = 0;
    int passive = 0;
    for (const GridPoint& point : gridPoints(couplingFigures(scene.config), scene.config.dt)) {
        if (point.damping_ratio < 1) continue;
        ++passive;
        const double figure = buzz(scene, point.config, grid.start, grid.push);
        worst = worseOf(worst, figure);
    }
    EXPECT_GT(passive, 0);
    return worst;
}

// With this delay it goes over every device, hand and encoder. Each point that buzzes or throws the tool off
// is printed.
struct DelayFigures {
    double worst = 0;            // N RMS
    double percent_buzzing = 0;  // of the points
};
DelayFigures withDelay(const Variant& variant, const GridScene& grid, int delay_ticks) {
    Scene scene(grid.bone(), grid.tool(), variant);
    DelayFigures figures;
    int buzzing = 0, count = 0;
    for (const GridPoint& point : gridPoints(couplingFigures(scene.config), scene.config.dt)) {
        if (point.config.delay_ticks != delay_ticks) continue;
        const double figure = buzz(scene, point.config, grid.start, grid.push);
        if (!(figure <= figures.worst)) figures.worst = figure;
        ++count;
        if (figure <= kMaxBuzz) continue;
        ++buzzing;
        std::printf("  %-28s damping ratio %5.2f  %8.4f N rms\n", point.name.c_str(), point.damping_ratio,
                    figure);
    }
    figures.percent_buzzing = 100.0 * buzzing / count;
    return figures;
}

double planePassive(const Variant& variant) {
    return passivePoints(variant, kOnPlane);
}
double planeOneTick(const Variant& variant) {
    return withDelay(variant, kOnPlane, 1).worst;
}
double planeThreeTicks(const Variant& variant) {
    return withDelay(variant, kOnPlane, 3).percent_buzzing;
}
double holePassive(const Variant& variant) {
    return passivePoints(variant, kInHole);
}
double holeOneTick(const Variant& variant) {
    return withDelay(variant, kInHole, 1).worst;
}
double holeThreeTicks(const Variant& variant) {
    return withDelay(variant, kInHole, 3).percent_buzzing;
}

// A device is too lightly damped for three ticks of delay: the figure is shown, not promised.
const std::vector<std::string> kEveryVariant{"thesis_2012", "fast", "balanced", "exact"};

const std::vector<StabilityCase> kClosedLoopGridCases{
    {"loop_grid_plane_passive", "N_rms_worst", kMaxBuzz, planePassive, {}},
    {"loop_grid_plane_one_tick", "N_rms_worst", kMaxBuzz, planeOneTick, {}, everyDevice()},
    {"loop_grid_plane_three_ticks", "percent_buzzing", 0, planeThreeTicks, kEveryVariant},
    {"loop_grid_hole_passive", "N_rms_worst", kMaxBuzz, holePassive, {}},
    {"loop_grid_hole_one_tick",
     "N_rms_worst",
     kMaxBuzz,
     holeOneTick,
     {"thesis_2012"},
     Names{"cutting_force", "surface_friction", "all_felt"} + everyDevice()},
    {"loop_grid_hole_three_ticks", "percent_buzzing", 0, holeThreeTicks, kEveryVariant},
};
BONEMILL_STABILITY_CASES(ClosedLoopGrid, kClosedLoopGridCases);

}  // namespace
}  // namespace bonemill::test
