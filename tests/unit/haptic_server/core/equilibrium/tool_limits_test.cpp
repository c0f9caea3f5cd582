// A tool that may not go as fast, or be pulled as hard, as its hand wishes.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/core/equilibrium/gradient_model.h"
#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kLimitVoxel = 0.3e-3, kLimitTop = 5.05e-3, kLimitRadius = 1.5e-3;
// Also when the hand turns it about a place 0.1 m away.
const Vector3d kInTheAir(4.83e-3, 4.71e-3, kLimitTop + kLimitRadius + 60e-3);
const Eigen::Quaterniond kStanding = expRotation({M_PI / 2, 0, 0});

ContactScene faceAndBall() {
    return {cubeGeometry(33, kLimitVoxel),
            halfSpace({4.8e-3, 4.8e-3, kLimitTop}, Vector3d::UnitZ()),
            {SphereShape{{0, 0, 0}, kLimitRadius}},
            {.levels = {{1}, {2}}}};
}

// It turns as fast as it may until it has caught up, and then with the hand.
TEST(ToolLimits, AToolThatCatchesUpDoesNotTurnOn) {
    const ContactScene scene = faceAndBall();
    GradientConfig config;
    config.max_angular_speed = 240 * kDegree;
    config.coupling.damping_time = 0;
    config.coupling.p_TG = {0, 0.1, 0};
    for (const double hand_speed : {0.0, 90.0, 180.0}) {  // degrees/s
        GradientModel model(config, scene.world(), {&scene.tool, {.radius = kLimitRadius}, 12}, 1e-3);
        const Vector3d air = kInTheAir;
        Pose spo{air, kStanding};
        double worst = 0;
        for (int n = 0; n < 600; ++n) {
            const double angle = (10 + hand_speed * n * 1e-3) * kDegree;
            const Pose hand{air, expRotation({0.3 * angle, angle, -0.5 * angle}) * kStanding};
            spo = model.advance(spo, hand).X_VT;
            if (n > 550) worst = std::max(worst, spo.rotation.angularDistance(hand.rotation));
        }
        EXPECT_LT(worst, 0.01 * kDegree) << hand_speed;
    }
}

// A ball is driven into solid bone, far beyond what it carries: it stays outside at any speed of the hand.
// The scene's setup pulls with so much of what a ball ever carries (saturationForceOf()).
TEST(ToolLimits, ASmallBallStaysOutsideOfSolidBone) {
    constexpr double kOfMost = 0.4;
    for (const Preset preset : {Preset::kFast, Preset::kBalanced})
        for (const double voxel : {0.125e-3, 0.5e-3})
            for (const double voxels : {0.6, 0.8, 1.2, 2.0})
                for (const double speed : {2e-3, 20e-3, 100e-3, 500e-3}) {
                    const double radius = voxels * voxel, top = 15.3 * voxel;
                    const ContactScene scene{cubeGeometry(25, voxel),
                                             halfSpace({6e-3, 6e-3, top}, Vector3d::UnitZ()),
                                             {SphereShape{{0, 0, 0}, radius}},
                                             {.levels = {{1}}}};
                    const GradientConfig config;
                    const double most =
                        4.0 / 27 * M_PI * config.contact.stiffness_per_area * std::pow(radius, 3);
                    GradientModel model(config, scene.world(),
                                        {&scene.tool, {.radius = radius}, kOfMost * most}, 1e-3);
                    model.setAccuracy(presetSettings(preset));
                    const Vector3d above(12.2 * voxel, 11.7 * voxel, top + radius + 0.1 * voxel);
                    const int ticks = int(std::min(600.0, 2 * radius / (speed * 1e-3) + 100));
                    Pose spo{above, kStanding};
                    for (int n = 0; n < ticks; ++n)
                        spo = model.advance(spo, {above - Vector3d(0, 0, speed * 1e-3 * n), kStanding}).X_VT;
                    EXPECT_GT(spo.position.z(), top)
                        << presetName(preset) << " " << voxel << " " << voxels << " " << speed;
                }
}

// The less a tool may be pulled with, the less the air holds it back.
TEST(ToolLimits, AToolThatCarriesLittleFollowsInFreeAir) {
    const ContactScene scene = faceAndBall();
    for (const double most : {0.02, 0.2, 2.0}) {
        GradientModel model({}, scene.world(), {&scene.tool, {.radius = kLimitRadius}, most}, 1e-3);
        const Vector3d air = kInTheAir - Vector3d(0.05, 0, 0);
        Pose spo{air, kStanding};
        double worst = 0;
        for (int n = 0; n < 500; ++n) {
            const Pose hand{air + Vector3d(200e-6 * n, 0, 0), kStanding};
            spo = model.advance(spo, hand).X_VT;
            worst = std::max(worst, (spo.position - hand.position).norm());
        }
        EXPECT_LT(worst, 0.25e-3) << most;
    }
}

}  // namespace
}  // namespace bonemill
