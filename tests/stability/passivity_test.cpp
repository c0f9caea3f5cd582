// On closed paths without milling no energy comes from nowhere, with every tick run or with some dropped.
#include "common/base/units.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/energy_meter.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kEnergySlack_uJ = 1;

// The corners are visited in order at `speed`, with the turn between them spread evenly, and a rest
// at the end.
std::vector<Pose> polyline(const std::vector<Pose>& corners, double speed, int rest_ticks) {
    std::vector<Pose> path;
    for (size_t c = 1; c < corners.size(); ++c) {
        const Pose& a = corners[c - 1];
        const Pose& b = corners[c];
        const int ticks = std::max(1, int((b.position - a.position).norm() / (speed * 1e-3)));
        for (int n = 0; n < ticks; ++n) {
            const double s = double(n) / ticks;
            path.push_back({a.position + s * (b.position - a.position), a.rotation.slerp(s, b.rotation)});
        }
    }
    path.insert(path.end(), size_t(rest_ticks), corners.back());
    return path;
}

// Returns the energy gained over the path, µJ; 0 if none was. `dropped` ticks from `drop_from` on are
// missing; what happens meanwhile is charged with the forces of an undisturbed run, so that the gap itself
// costs and brings nothing: what remains is what the tool does when it comes back.
double gained(Scene& scene, const std::vector<Pose>& path, size_t drop_from = 0, size_t dropped = 0) {
    Stepper stepper(scene), undisturbed(scene);
    AlgorithmEnergy meter;
    const auto handle = [&](const Pose& tool) { return scene.config.hand_space.poseAtHand(tool); };
    double pressed = 0;
    for (size_t n = 0; n < path.size(); ++n) {
        const bool is_dropped = n >= drop_from && n < drop_from + dropped;
        if (dropped > 0) undisturbed.step(path[n]);
        if (!is_dropped) stepper.step(path[n]);
        if (!stepper.isFinite()) return kNan;
        meter.add(handle(path[n]), is_dropped ? undisturbed.wrenchOnHand() : stepper.wrenchOnHand());
        pressed = std::max(pressed, stepper.wrenchOnHand().force.norm());
    }
    return pressed > 0.1 ? std::max(0.0, -meter.energy() * kPerMicro) : kLost;
}

// The path goes down, sideways, up and back over a plane that lies askew in the grid, both ways round.
double loopOverPlane(const Variant& variant) {
    const Eigen::Vector3d normal = Eigen::Vector3d(0.3, 0.2, 1).normalized();
    const Eigen::Vector3d side = normal.cross(Eigen::Vector3d(0.2, 1, 0)).normalized();
    const auto at = [&](double along, double height, double turn) {
        return Pose{kMiddle + along * side + (kBurrRadius + height) * normal, expRotation({turn, 0, turn})};
    };
    double worst = 0;
    for (const double way : {-1.0, 1.0}) {
        Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), halfSpace(kMiddle, normal)), burr(),
                    variant);
        const double x = way * 0.8e-3;
        worst =
            worseOf(worst, gained(scene, polyline({at(-x, 0.1e-3, 0), at(-x, -0.3e-3, 0), at(x, -0.3e-3, 0.1),
                                                   at(x, 0.1e-3, 0.1), at(-x, 0.1e-3, 0)},
                                                  2e-3, 300)));
    }
    return worst;
}

// At rest each pose is held until the tool has settled, so that only the law of force is judged, not the
// damping of the solve. In a conservative law both ways round give 0; otherwise one way gains.
double gainedAtRest(Scene& scene, std::vector<Pose> path) {
    constexpr int kSettleTicks = 16;
    double worst = 0;
    for (int way = 0; way < 2; ++way) {
        Stepper stepper(scene);
        AlgorithmEnergy meter;
        for (const Pose& pose : path) {
            for (int n = 0; n < kSettleTicks; ++n) stepper.step(pose);
            if (!stepper.isFinite()) return kNan;
            meter.add(pose, stepper.wrenchOnHand());
        }
        worst = worseOf(worst, -meter.energy() * kPerMicro);
        std::reverse(path.begin(), path.end());
    }
    return worst;
}

constexpr double kFineStep = 5e-6 * 1e3;  // m/s that make 5 µm per pose

// The path goes over a right-angled edge, from one face to the other and back through the air.
double overTheEdge(const Variant& variant) {
    const Eigen::Quaterniond askew = expRotation({0.15, 0.35, 0.1});
    const Eigen::Vector3d edge(3e-3, 2.5e-3, 3e-3);
    const auto corner = [=](const Eigen::Vector3d& p) {
        const Eigen::Vector3d q = askew.conjugate() * (p - edge);
        return std::max(q.x(), q.z());
    };
    Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), corner), burr(), variant);
    const auto at = [&](double x, double z) { return Pose{edge + askew * Eigen::Vector3d(x, 0, z), askew}; };
    const double deep = kBurrRadius - 0.3e-3, clear = kBurrRadius + 0.2e-3, away = 0.8e-3;
    std::vector<Pose> corners{at(-away, clear), at(-away, deep)};
    for (int n = 0; n <= 8; ++n) {
        const double a = M_PI / 2 * n / 8;
        corners.push_back(at(deep * std::sin(a), deep * std::cos(a)));
    }
    for (const Pose& pose : {at(deep, -away), at(clear, -away), at(clear, clear), at(-away, clear)})
        corners.push_back(pose);
    return gainedAtRest(scene, polyline(corners, kFineStep, 1));
}

// The peg goes round the hole, leaning on its wall, and tilts.
std::vector<Pose> roundTheHole(double speed, int rest_ticks) {
    std::vector<Pose> corners{upright(kHoleMiddle)};
    for (int n = 0; n <= 24; ++n) {
        const double a = 2 * M_PI * n / 24;
        corners.push_back({kHoleMiddle + 0.3e-3 * Eigen::Vector3d(std::cos(a), 0, std::sin(a)),
                           expRotation(0.03 * Eigen::Vector3d(std::sin(a), 0, std::cos(2 * a)))});
    }
    corners.push_back(upright(kHoleMiddle));
    return polyline(corners, speed, rest_ticks);
}

double pegMoving(const Variant& variant) {
    Scene scene(holeBone(), peg(), variant);
    return gained(scene, roundTheHole(2e-3, 300));
}

double pegAtRest(const Variant& variant) {
    Scene scene(holeBone(), peg(), variant);
    return gainedAtRest(scene, roundTheHole(kFineStep, 1));
}

// The hand presses straight down and releases at a brisk 20 mm/s.
std::vector<Pose> pressAndRelease() {
    return polyline({abovePlane(0.1e-3), abovePlane(-0.6e-3), abovePlane(0.1e-3)}, 20e-3, 300);
}

double worstDroppedTicks(const Variant& variant) {
    double worst = 0;
    const std::vector<Pose> path = pressAndRelease();
    for (const size_t dropped : {5u, 10u, 20u, 50u})
        for (const size_t from : {10u, 20u, 34u, 45u}) {  // going in, at the bottom, coming out
            Scene scene(planeBone(), burr(), variant);
            const double figure = gained(scene, path, from, dropped);
            worst = worseOf(worst, figure);
        }
    return worst;
}

// At the port the held force gives back at most what holding it that long explains.
double droppedTicksAtThePort(const Variant& variant) {
    constexpr double kSpeed = 20e-3, kDt = 1e-3, kDepth = 0.6e-3;
    double worst = 0;
    const std::vector<Pose> path = pressAndRelease();
    for (const size_t dropped : {5u, 10u, 20u, 50u}) {
        Scene scene(planeBone(), burr(), variant);
        Stepper stepper(scene);
        PortEnergy meter;
        for (size_t n = 0; n < path.size(); ++n) {
            const bool is_dropped = n >= 34 && n < 34 + dropped;
            if (!is_dropped) stepper.step(path[n]);
            meter.add(path[n], stepper.wrenchOnHand());
        }
        const double k = couplingFigures(scene.config).translation_stiffness;
        const double bound = PortEnergy::holdBound(k, kDt, kSpeed, kDepth, 0) +
                             k * kDepth * std::min(kDepth, kSpeed * kDt * double(dropped));
        const double figure = -meter.energy() / bound;
        worst = worseOf(worst, figure);
    }
    return worst;
}

const std::vector<StabilityCase> kPassivityCases{
    {"energy_loop_over_plane",
     "uJ_gained",
     kEnergySlack_uJ,
     loopOverPlane,
     {},
     Names{"surface_friction"} + everyDevice()},
    {"energy_round_the_hole",
     "uJ_gained",
     kEnergySlack_uJ,
     pegMoving,
     {},
     Names{"surface_friction"} + everyDevice()},
    {"energy_over_edge_at_rest",
     "uJ_gained",
     kEnergySlack_uJ,
     overTheEdge,
     {"thesis_2012", "penalty_sdf"},
     everyLaw()},
    {"energy_round_hole_at_rest", "uJ_gained", kEnergySlack_uJ, pegAtRest, {}},
    {"energy_dropped_ticks",
     "uJ_gained",
     kEnergySlack_uJ,
     worstDroppedTicks,
     {},
     Names{"surface_friction"} + everyDevice()},
    {"port_energy_dropped_ticks", "of_hold_bound", 1, droppedTicksAtThePort, {}},
};
BONEMILL_STABILITY_CASES(Passivity, kPassivityCases);

}  // namespace
}  // namespace bonemill::test
