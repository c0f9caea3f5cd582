// What the add button lays down is what the burr has swept, firm and closed, and never in the tool's way.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/milling_rig.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::MillingRig;
using test::RigConfig;

constexpr double kTrack = 4e-3;   // m: along x
constexpr double kAbove = 30e-6;  // m: of the burr over the flat face

RigConfig freeForm(double voxel, double rate = 1000) {
    RigConfig config;
    config.size = {8e-3, 4e-3, 6e-3};
    config.surface = 1.5e-3;
    config.spacing.setConstant(voxel);
    config.rate = rate;
    config.burr.radius = 0.8e-3;
    config.shaft_radius = 0.4e-3;
    config.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));  // the shaft is up
    config.time_removal = test::kTimeRemoval;
    config.add_material = test::kAddMaterial;
    return config;
}

double addedVolume(const MillingRig& rig) {
    return -rig.removedVolume();
}
double ball(const RigConfig& config) {
    return 4.0 / 3 * M_PI * std::pow(config.burr.radius, 3);
}
double capsule(const RigConfig& config) {
    return M_PI * config.burr.radius * config.burr.radius * kTrack + ball(config);
}
bool isClosed(const MillingRig& rig) {
    const auto meshes = test::meshAll(rig.bone.volume, rig.bone.lattice);
    return checkMesh(meshes, MeshGrid(rig.bone.volume, rig.bone.lattice)).isClosed();
}
// Just over the face, half the way from the middle.
Vector3d startOf(const MillingRig& rig) {
    return rig.center() + Vector3d(-kTrack / 2, 0, rig.config.burr.radius + kAbove);
}
// Up and away, with these buttons.
void lift(MillingRig& rig, uint32_t buttons = 0) {
    rig.feed(0.1, rig.position(), {0, 0, 25e-3}, buttons);
    rig.feed(0.05, rig.position(), Vector3d::Zero(), 0);
}
void draw(MillingRig& rig, double speed) {
    rig.feed(kTrack / speed, startOf(rig), {speed, 0, 0}, kButtonAdd);
    rig.feed(0.02, startOf(rig) + Vector3d(kTrack, 0, 0), Vector3d::Zero(), kButtonAdd);
    lift(rig);
}

TEST(AddMaterial, IsWhatTheBurrSweptAtAnySpeedAndAnyRateOfTheLoop) {
    struct Case {
        double voxel, rate, speed;  // m, Hz, m/s
    };
    for (const Case& c : {Case{0.1e-3, 1000, 5e-3}, Case{0.1e-3, 500, 50e-3}, Case{0.1e-3, 4000, 50e-3},
                          Case{0.2e-3, 1000, 20e-3}, Case{0.1e-3, 1000, 0.4}}) {
        MillingRig rig(freeForm(c.voxel, c.rate));
        draw(rig, c.speed);
        EXPECT_NEAR(addedVolume(rig) / capsule(rig.config), 1, 0.03)
            << c.voxel << ' ' << c.rate << ' ' << c.speed;
        EXPECT_TRUE(isClosed(rig)) << c.speed;
        // The coupling's damping alone takes this much.
        EXPECT_LT(rig.largestLag(), 0.02e-3 + 1.2e-3 * c.speed) << c.voxel << ' ' << c.rate << ' ' << c.speed;
    }
}

// A burr that is pressed onto the face stands on it as without the button.
TEST(AddMaterial, DoesNotMoveABurrThatIsPressedOnTheFace) {
    const auto way_of = [](uint32_t buttons) {
        MillingRig rig(freeForm(0.125e-3));
        const Vector3d from = startOf(rig) - Vector3d(0, 0, 0.3e-3);
        rig.feed(kTrack / 10e-3, from, {10e-3, 0, 0}, buttons);
        return std::pair(rig.position(), rig.largestLag());
    };
    const auto [with, lag_with] = way_of(kButtonAdd);
    const auto [without, lag_without] = way_of(0);
    EXPECT_LT((with - without).norm(), 0.02e-3);
    EXPECT_LT(lag_with, lag_without + 0.02e-3);
}

// As long as the button is held, the tool goes through what it has laid down, which makes way and comes
// again.
TEST(AddMaterial, MakesWayForAHandThatComesBackAlongItsOwnWay) {
    for (const double speed : {10e-3, 100e-3}) {
        MillingRig rig(freeForm(0.1e-3));
        const Vector3d end = startOf(rig) + Vector3d(kTrack, 0, 0);
        rig.feed(kTrack / speed, startOf(rig), {speed, 0, 0}, kButtonAdd);
        rig.feed(0.1, end, Vector3d::Zero(), kButtonAdd);
        rig.feed(kTrack / speed, end, {-speed, 0, 0}, kButtonAdd);
        rig.feed(0.1, startOf(rig), Vector3d::Zero(), kButtonAdd);
        EXPECT_LT(rig.largestLag(), 0.02e-3 + 1.2e-3 * speed) << speed;
        lift(rig);
        EXPECT_NEAR(addedVolume(rig) / capsule(rig.config), 1, 0.03) << speed;
        EXPECT_TRUE(isClosed(rig)) << speed;
    }
}

// What makes way is only what was laid down: the bone below is as firm as ever, and so is all when the button
// is let go.
TEST(AddMaterial, MakesWayOnlyForTheStrokeAndDownToTheBone) {
    MillingRig rig(freeForm(0.1e-3));
    const Vector3d velocity(10e-3, 0, 0), end = startOf(rig) + Vector3d(kTrack, 0, 0);
    const Vector3d deeper(0, 0, -0.3e-3);
    rig.feed(kTrack / 10e-3, startOf(rig), velocity, kButtonAdd);
    rig.feed(0.1, end, 10 * deeper, kButtonAdd);
    rig.feed(kTrack / 20e-3, end + deeper, -velocity, kButtonAdd);
    EXPECT_GT(rig.position().z(), startOf(rig).z() - kAbove - 0.03e-3);
    EXPECT_NEAR(rig.position().x(), rig.center().x(), 0.1e-3);
    const Vector3d middle = rig.center() + Vector3d(0, 0, rig.config.burr.radius + kAbove);
    const size_t let_go = rig.records.size();
    rig.feed(0.1, middle, Vector3d::Zero(), 0);
    EXPECT_LT(rig.largestLag(let_go + 50), 0.02e-3);
    rig.feed(0.2, middle, -velocity, 0);
    EXPECT_GT(rig.position().x(), middle.x() - 0.4e-3);
}

TEST(AddMaterial, ComesWhenTheToolGoesAlsoAfterTheButton) {
    MillingRig rig(freeForm(0.1e-3));
    const Vector3d place = rig.center() + Vector3d(0, 0, 1.2e-3);
    rig.feed(0.1, place, Vector3d::Zero(), kButtonAdd);
    EXPECT_EQ(addedVolume(rig), 0);
    lift(rig);
    EXPECT_NEAR(addedVolume(rig) / ball(rig.config), 1, 0.03);
    EXPECT_TRUE(isClosed(rig));
}

TEST(AddMaterial, IsFirm) {
    MillingRig rig(freeForm(0.1e-3));
    draw(rig, 10e-3);
    const double top = rig.center().z() + kAbove + 2 * rig.config.burr.radius;
    rig.run(
        0.3, rig.position(),
        [&rig, top](double, const Vector3d&) {
            return Vector3d(rig.center().x(), rig.center().y(), top + rig.config.burr.radius - 0.3e-3);
        },
        0);
    EXPECT_GT(rig.position().z(), top + rig.config.burr.radius - 0.03e-3);
}

TEST(AddMaterial, LeavesAToolThatDivedFreeToGoSideways) {
    constexpr double kDive = 2e-3;  // m
    MillingRig rig(freeForm(0.1e-3));
    const Vector3d above = startOf(rig) + Vector3d(0, 0, kDive);
    rig.feed(0.2, above, {0, 0, -10e-3}, kButtonAdd);
    rig.feed(0.4, startOf(rig), {10e-3, 0, 0}, kButtonAdd);
    EXPECT_LT(rig.largestLag(), 0.04e-3);
    lift(rig);
    // Two capsules make an elbow. They share three quarters of a ball and one of what two cylinders share.
    const double R = rig.config.burr.radius, shared = 0.75 * ball(rig.config) + 4.0 / 3 * std::pow(R, 3);
    const double swept = capsule(rig.config) + M_PI * R * R * kDive + ball(rig.config) - shared;
    EXPECT_NEAR(addedVolume(rig) / swept, 1, 0.03);
}

TEST(AddMaterial, IsNoTrapWhenItAlternatesWithRemoving) {
    MillingRig rig(freeForm(0.125e-3));
    const Vector3d velocity(10e-3, 0, 0);
    for (int n = 0; n < 400; ++n)
        rig.feed(1 / rig.config.rate, startOf(rig) + n / rig.config.rate * velocity, velocity,
                 n % 2 ? kButtonAdd : kButtonRemove);
    EXPECT_LT(rig.largestLag(), 0.04e-3);
    lift(rig);
    EXPECT_LT(rig.largestLag(), 0.06e-3);
}

}  // namespace
}  // namespace bonemill
