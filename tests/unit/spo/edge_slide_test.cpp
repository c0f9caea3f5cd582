// Tools with edges slide over a flat face without friction, whatever the voxels and the lean.
#include <gtest/gtest.h>

#include "haptic_server/spo/gradient_model.h"
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
    double friction = 0;  // largest tangential force per normal force
    double step = 0;      // N, the largest change of the force in a tick
};

const std::vector<ToolShape> kDrill = {CylinderShape{{0, -4e-3, 0}, {0, 4e-3, 0}, 1.6e-3, kEdgeRadius},
                                       CapsuleShape{{0, 4e-3, 0}, {0, 20e-3, 0}, 1.2e-3}};
constexpr double kDt = 1e-3;

// Returns the tool's lowest height over the face below T's origin, by its distance field.
double heightOver(const ToolField& tool, const Eigen::Quaterniond& R_FT) {
    // The height at which the field first touches the plane z = 0 is found by bisection over samples of the plane.
    double low = 0, high = 8e-3;
    for (int n = 0; n < 40; ++n) {
        const double height = (low + high) / 2;
        double nearest = 1;
        for (int i = -60; i <= 60; ++i)
            for (int j = -60; j <= 60; ++j)
                nearest = std::min(nearest, tool.sample(R_FT.conjugate() * Vector3d(i * 0.1e-3, j * 0.1e-3, -height))
                                                .distance);
        (nearest < 0 ? low : high) = height;
    }
    return high;
}

SlideFigures slide(const Slide& s) {
    std::mt19937 random(s.seed);
    const Eigen::Quaterniond R_VF = s.seed ? randomRotation(random) : Eigen::Quaterniond::Identity();
    std::uniform_real_distribution<double> angle(0, 2 * M_PI);
    const Eigen::Quaterniond R_FT = expRotation(angle(random) * Vector3d::UnitZ()) *
                                    expRotation({M_PI / 2 - s.lean, 0, 0});
    const double way = angle(random);
    const Vector3d along_F(std::cos(way), std::sin(way), 0);
    const int cells = std::max(24, int(std::ceil(5e-3 / s.voxel)));
    const Vector3d middle = Vector3d::Constant(cells * s.voxel / 2) + s.voxel * Vector3d(0.13, 0.22, 0.31);
    const ContactScene scene(cubeGeometry(cells + 1, s.voxel), halfSpace(middle, R_VF * Vector3d::UnitZ()), s.shapes);
    GradientModel model({}, scene.world(), {&scene.tool, {.radius = 1.6e-3}, 50}, kDt);
    model.setAccuracy(presetSettings(s.preset));
    const ToolField& field = scene.tool.field(presetSettings(s.preset));
    // Where the tool touches shall be in the middle of the volume.
    const double height = heightOver(field, R_FT);
    Vector3d touch_F = Vector3d::Zero();
    double nearest = 1;
    for (int i = -100; i <= 100; ++i)
        for (int j = -100; j <= 100; ++j) {
            const Vector3d p(i * 0.06e-3, j * 0.06e-3, -height);
            const double d = field.sample(R_FT.conjugate() * p).distance;
            if (d < nearest) nearest = d, touch_F = {p.x(), p.y(), 0};
        }
    const double stretch = s.load / 3000;
    const int press = 150, ticks = std::min(400, int(0.4e-3 / (s.speed * kDt)));
    const auto device = [&](int tick) {
        const double x = s.speed * kDt * std::max(0, tick - press);
        const double z = height + 0.05e-3 - (stretch + 0.05e-3) * std::min(1.0, tick / 80.0);
        return Pose{middle + R_VF * (Vector3d(0, 0, z) - touch_F + (x - 0.2e-3) * along_F), R_VF * R_FT};
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
            figures.friction = std::max(figures.friction, (f - drag).head<2>().norm() / f.z());
            figures.step = std::max(figures.step, (f - before).norm());
        }
        before = f;
    }
    return figures;
}

TEST(EdgeSlide, Explore) {
    for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact})
        for (const double voxel : {0.125e-3, 0.25e-3, 0.5e-3, 0.8e-3}) {
            double friction = 0, step = 0;
            for (unsigned seed = 0; seed < 4; ++seed) {
                const SlideFigures f = slide({.preset = preset, .voxel = voxel, .lean = 20 * kDegree, .seed = seed, .shapes = kDrill});
                friction = std::max(friction, f.friction), step = std::max(step, f.step);
            }
            std::printf("%s voxel %.3g: friction %.2f %% step %.4f N\n", std::string(presetName(preset)).c_str(), voxel * 1e3, 100 * friction, step);
        }
}

}  // namespace
}  // namespace bonemill
