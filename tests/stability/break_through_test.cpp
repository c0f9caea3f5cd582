// A burr mills through a slab in a soft hand: the wall under it goes in a tick, the force does not.
#include <gtest/gtest.h>

#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"
#include "tests/stability/loop_point.h"
#include "tests/support/typical_effects.h"

namespace bonemill::test {
namespace {

// N per tick: the rate of a sudden change, beside what the hand's own motion explains.
constexpr double kMostAtOnce = 0.15;
constexpr double kSlab = 0.6e-3, kHandForce = 3;

// Returns the largest fall of the force in a tick beyond what the handle's motion makes of it.
double largestFall(void (*remove)(FixedTickConfig&)) {
    const Variant& balanced = allVariants()[2];
    Scene scene(bodyVolume(boxOf(Eigen::Vector3d::Constant(5e-3)),
                           wall(kMiddle - Eigen::Vector3d(0, 0, kSlab / 2), Eigen::Vector3d::UnitZ(), kSlab)),
                burr(), balanced, 1e-3, remove);
    LoopConfig config;
    config.hand = loopHands()[1].plant;  // soft
    const Pose start = abovePlane(0.1e-3);
    ClosedLoop loop(config, scene, start);
    loop.plant.setTarget(
        start.incremented({0, 0, -kHandForce / config.hand.stiffness}, Eigen::Vector3d::Zero()));
    loop.run(0.5);
    EXPECT_GT(loop.stepper.wrenchOnHand().force.z(), kHandForce / 2);
    double worst = 0;
    for (int n = 0; n < 4000 && loop.stepper.spo().position.z() > kMiddle.z() - 3 * kSlab; ++n) {
        const double before = loop.stepper.wrenchOnHand().force.norm();
        const Eigen::Vector3d place = loop.plant.measured().position;
        loop.step(kButtonRemove);
        const double way = (loop.plant.measured().position - place).norm();
        const double moved = couplingFigures(scene.config).quick_stiffness * way;
        worst = std::max(worst, before - loop.stepper.wrenchOnHand().force.norm() - moved);
    }
    EXPECT_LT(loop.stepper.spo().position.z(), kMiddle.z() - kSlab) << "it is through";
    return worst;
}

TEST(BreakThrough, ByTimeTakesNoMoreForceThanTheBurrTakesBone) {
    EXPECT_LE(largestFall([](FixedTickConfig& config) {
                  config.effects = {};
                  config.effects.time_removal = kTimeRemoval;
              }),
              kMostAtOnce);
}

TEST(BreakThrough, ByEnergyLikewise) {
    EXPECT_LE(largestFall([](FixedTickConfig& config) {
                  config.effects = {};
                  config.effects.energy_removal = kEnergyRemoval;
                  config.tool.burr.speed = kSpinSpeed;
                  config.tool.burr.friction = kCuttingFriction;
              }),
              kMostAtOnce);
}

}  // namespace
}  // namespace bonemill::test
