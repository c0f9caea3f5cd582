// A tool's medial axis has got into a wall thinner than itself, with the hand outside: neither face of the
// wall may hold it there or pull it on.
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr int kMaxTicks = 500;
constexpr double kClear = 0.5e-3;  // m: how far outside, beyond touching, the hand waits

// These are the walls, and where in them the burr's centre starts, of the wall's thickness from
// its lower face.
constexpr double kWalls[] = {0.25e-3, 0.5e-3, 0.75e-3};
constexpr double kStarts[] = {0.2, 0.5, 0.8};

struct Start {
    double thickness, share;
    double side;  // +1: the hand waits above, -1: below

    Pose inside() const { return upright(kMiddle + Eigen::Vector3d(0, 0, (share - 0.5) * thickness)); }
    Pose outside() const {
        return upright(kMiddle + side * Eigen::Vector3d(0, 0, thickness / 2 + kBurrRadius + kClear));
    }
    // The burr has left the wall on the hand's side.
    bool isOut(const Pose& spo) const {
        return side * (spo.position.z() - kMiddle.z()) > thickness / 2 + kBurrRadius;
    }
};

struct Course {
    double ticks = 0;       // until it is out; kMaxTicks: never
    double most_force = 0;  // N
};

// `step(n)` runs one tick, after one at Start::inside().
template <class Step>
Course follow(const Start& start, const Stepper& stepper, Step&& step) {
    Course course{kMaxTicks, 0};
    for (int n = 1; n <= kMaxTicks; ++n) {
        step();
        if (!stepper.isFinite()) return {kNan, kNan};
        course.most_force = std::max(course.most_force, stepper.wrenchOnHand().force.norm());
        if (!start.isOut(stepper.spo())) continue;
        course.ticks = n;
        break;
    }
    return course;
}

// The device is at once where the hand waits.
Course deviceOutside(Scene& scene, const Start& start) {
    Stepper stepper(scene);
    stepper.step(start.inside());
    return follow(start, stepper, [&] { stepper.step(start.outside()); });
}

// The device starts in the wall too, and the hand's spring draws it out.
Course handOutside(Scene& scene, const Start& start) {
    ClosedLoop loop({}, scene, start.inside());
    loop.plant.setTarget(start.outside());
    loop.step();
    return follow(start, loop.stepper, [&] { loop.step(); });
}

template <class Figure>
double worstOf(const Variant& variant, Course (*course)(Scene&, const Start&), Figure&& figure_of) {
    double worst = 0;
    for (const double thickness : kWalls) {
        const DistanceFunction slab = wall(kMiddle, Eigen::Vector3d::UnitZ(), thickness);
        Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)), slab), burr(), variant);
        for (const double share : kStarts)
            for (const double side : {1.0, -1.0}) {
                const double figure = figure_of(course(scene, {thickness, share, side}));
                worst = worseOf(worst, figure);
            }
    }
    return worst;
}

double milliseconds(const Course& course) {
    return course.ticks;
}

double deviceOutsideTime(const Variant& variant) {
    return worstOf(variant, deviceOutside, milliseconds);
}
double handOutsideTime(const Variant& variant) {
    return worstOf(variant, handOutside, milliseconds);
}
double handOutsideForce(const Variant& variant) {
    return worstOf(variant, handOutside, [](const Course& course) { return course.most_force; });
}

const std::vector<StabilityCase> kFarSideCases{
    {"inside_thin_wall_device_outside", "ms", 20, deviceOutsideTime, {}, feltEffects()},
    {"inside_thin_wall_hand_pulls",
     "ms",
     100,
     handOutsideTime,
     {"thesis_2012", "proxy_3dof", "penalty_sdf", "constraint"},
     feltEffects() + everyLaw()},
    {"inside_thin_wall_force", "N", 10, handOutsideForce, {}},
};
BONEMILL_STABILITY_CASES(FarSide, kFarSideCases);

}  // namespace
}  // namespace bonemill::test
