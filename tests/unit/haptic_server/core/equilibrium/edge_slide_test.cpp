// Tools with edges slide over a flat face without friction, whatever the voxels and the lean.
#include <gtest/gtest.h>

#include "haptic_server/core/equilibrium/gradient_model.h"
#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

struct Slide {
    Preset preset;
    double voxel;                   // m
    double lean;                    // rad, of the tool's axis from the face's normal
    double load = 1.5;              // N
    double speed = 2e-3;            // m/s
    unsigned seed = 1;              // of the face's direction in the grid, and the slide's in the face
    std::vector<ToolShape> shapes;  // of radius 1.6 mm
};

struct SlideFigures {
    double friction = 0;    // largest tangential force per normal force
    double step = 0;        // N, the largest change of the force in a tick
    double least_load = 1;  // the least normal force per load
};

const std::vector<ToolShape> kDrill = {CylinderShape{{0, -4e-3, 0}, {0, 4e-3, 0}, 1.6e-3, kEdgeRadius},
                                       CapsuleShape{{0, 4e-3, 0}, {0, 20e-3, 0}, 1.2e-3}};
constexpr double kDt = 1e-3;

struct Touch {
    double height = 9e-3;             // m, of T's origin over the face z = 0 that the tool touches
    Vector3d p_F = Vector3d::Zero();  // where
};

// Lowers the tool by its least distance from the face until it touches.
Touch touchdown(const ToolField& tool, const Eigen::Quaterniond& R_FT) {
    constexpr double kGrid = 0.07e-3;
    Touch touch;
    for (int n = 0; n < 6; ++n) {
        double nearest = 1;
        for (int i = -85; i <= 85; ++i)
            for (int j = -85; j <= 85; ++j) {
                const Vector3d p(i * kGrid, j * kGrid, -touch.height);
                const double distance = tool.sample(R_FT.conjugate() * p).distance;
                if (distance < nearest) nearest = distance, touch.p_F = {p.x(), p.y(), 0};
            }
        touch.height -= nearest;
    }
    return touch;
}

SlideFigures slide(const Slide& s) {
    std::mt19937 random(s.seed);
    const Eigen::Quaterniond R_VF = s.seed ? randomRotation(random) : Eigen::Quaterniond::Identity();
    std::uniform_real_distribution<double> angle(0, 2 * M_PI);
    const Eigen::Quaterniond R_FT =
        expRotation(angle(random) * Vector3d::UnitZ()) * expRotation({M_PI / 2 - s.lean, 0, 0});
    const double way = angle(random);
    const Vector3d along_F(std::cos(way), std::sin(way), 0);
    const int cells = std::max(24, int(std::ceil(5e-3 / s.voxel)));
    const Vector3d middle = Vector3d::Constant(cells * s.voxel / 2) + s.voxel * Vector3d(0.13, 0.22, 0.31);
    const ContactScene scene(cubeGeometry(cells + 1, s.voxel), halfSpace(middle, R_VF * Vector3d::UnitZ()),
                             s.shapes);
    GradientModel model({}, scene.world(), {&scene.tool, {.radius = 1.6e-3}, 50}, kDt);
    model.setAccuracy(presetSettings(s.preset));
    const ToolField& field = scene.tool.field(presetSettings(s.preset));
    const Touch touch = touchdown(field, R_FT);
    const double stretch = s.load / 3000;
    const int press = 150, ticks = std::min(400, int(0.4e-3 / (s.speed * kDt)));
    const auto device = [&](int tick) {
        const double x = s.speed * kDt * std::max(0, tick - press);
        const double z = touch.height + 0.05e-3 - (stretch + 0.05e-3) * std::min(1.0, tick / 80.0);
        return Pose{middle + R_VF * (Vector3d(0, 0, z) - touch.p_F + (x - 0.2e-3) * along_F), R_VF * R_FT};
    };
    Pose spo = device(0);
    SlideFigures figures;
    Vector3d before = Vector3d::Zero();
    for (int tick = 0; tick < press + ticks; ++tick) {
        const SpoStep step = model.advance(spo, device(tick));
        spo = step.X_VT;
        Vector3d f = R_VF.conjugate() * step.wrench_hand_V.force;
        if (tick > press + 20) {
            const Vector3d drag = -3 * s.speed * along_F;  // N·s/m of the coupling, in free air too
            figures.friction = std::max(figures.friction, (f - drag).head<2>().norm() / std::abs(f.z()));
            figures.least_load = std::min(figures.least_load, f.z() / s.load);
            figures.step = std::max(figures.step, (f - before).norm());
        }
        before = f;
    }
    return figures;
}

const std::vector<ToolShape> kCone = {ConeShape{{0, -3e-3, 0}, {0, 3e-3, 0}, 0.3e-3, 1.6e-3, kEdgeRadius},
                                      CapsuleShape{{0, 3e-3, 0}, {0, 20e-3, 0}, 1.2e-3}};

constexpr double kVoxelSizes[] = {0.1e-3, 0.25e-3, 0.5e-3, 1e-3};

// The same slides for each preset: every seed has a direction in the grid, a lean and a voxel of its own.
void expectToSlide(Preset preset, double most_friction, double most_step) {
    constexpr double kLeans[] = {0, 1, 5, 20, 45, 70, 89, 90};  // degrees
    for (unsigned seed = 0; seed < 20; ++seed) {
        Slide s{.preset = preset,
                .voxel = kVoxelSizes[seed / 2 % 4],
                .lean = kLeans[seed % 8] * kDegree,
                .seed = seed,
                .shapes = seed % 3 == 2 ? kCone : kDrill};
        if (seed % 5 == 4) s.load = 0.5;
        const SlideFigures f = slide(s);
        EXPECT_GE(f.least_load, 0.8) << "seed " << seed;
        EXPECT_LE(f.friction, most_friction)
            << "seed " << seed << ", voxel " << s.voxel << ", lean " << s.lean;
        EXPECT_LE(f.step, most_step) << "seed " << seed << ", voxel " << s.voxel << ", lean " << s.lean;
    }
}

TEST(EdgeSlide, ExactHasNoFalseFriction) {
    expectToSlide(Preset::kExact, 0.01, 0.02);
}

TEST(EdgeSlide, BalancedHasHardlyAnyFalseFriction) {
    expectToSlide(Preset::kBalanced, 0.03, 0.02);
}

TEST(EdgeSlide, FastIsSmooth) {
    expectToSlide(Preset::kFast, 0.05, 0.02);
}

// Balls far smaller than a voxel are felt everywhere, as strongly as they should be.
TEST(EdgeSlide, SmallBallsSlideOnLargeVoxels) {
    for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact})
        for (const double radius : {0.3e-3, 0.5e-3, 1e-3})
            for (unsigned seed = 0; seed < 3; ++seed) {
                const SlideFigures f = slide({.preset = preset,
                                              .voxel = 1e-3,
                                              .lean = 0,
                                              .load = 0.3,
                                              .seed = seed,
                                              .shapes = {SphereShape{Vector3d::Zero(), radius}}});
                EXPECT_GE(f.least_load, 0.8) << presetName(preset) << radius;
                EXPECT_LE(f.friction, preset == Preset::kFast ? 0.03 : 0.01) << presetName(preset) << radius;
                EXPECT_LE(f.step, 0.02);
            }
}

}  // namespace
}  // namespace bonemill
