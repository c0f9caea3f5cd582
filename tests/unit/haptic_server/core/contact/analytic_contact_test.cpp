// Compares the gradient law on voxels with closed forms and with quadrature over the exact surface, at many
// rotations and voxel sizes. The bounds are those that docs/explanation/accuracy.md promises for contact
// patches at least 8 voxels wide.
#include <gtest/gtest.h>

#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kKappa = 1e11;
constexpr int kVoxels = 64;

struct Bound {
    Preset preset;
    double force, direction_deg, torque;
};
constexpr Bound kBounds[] = {{Preset::kExact, 0.01, 1, 0.02}, {Preset::kBalanced, 0.03, 2, 0.05}};

struct Orientation {
    Matrix3d R;      // columns: the test's own axes in V
    Vector3d shift;  // of the body against the grid, in voxels
};

std::vector<Orientation> orientations() {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    std::vector<Orientation> all{{Matrix3d::Identity(), Vector3d(0.1, 0.2, 0.3)}};
    for (int n = 0; n < 20; ++n)
        all.push_back(
            {randomRotation(random).toRotationMatrix(), {uniform(random), uniform(random), uniform(random)}});
    return all;
}

double degreesBetween(const Vector3d& a, const Vector3d& b) {
    return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / M_PI;
}

// A torque smaller than the force at the tool's radius is measured against that.
void expectNear(const Wrench& got, const Wrench& truth, double radius, const Bound& bound,
                const std::string& what) {
    EXPECT_NEAR(got.force.norm() / truth.force.norm(), 1, bound.force) << what;
    EXPECT_LT(degreesBetween(got.force, truth.force), bound.direction_deg) << what;
    EXPECT_LT((got.torque - truth.torque).norm(),
              bound.torque * std::max(truth.torque.norm(), radius * truth.force.norm()))
        << what;
}

GradientContactConfig uncapped() {
    return {.stiffness_per_area = kKappa, .stiffness_cap = std::numeric_limits<double>::infinity()};
}

std::string nameOf(const Bound& bound, double h, size_t orientation) {
    return std::string(presetName(bound.preset)) + ", voxel " + std::to_string(h * 1e3) +
           " mm, orientation " + std::to_string(orientation);
}

TEST(AnalyticContact, BurrOnPlane) {
    for (const double h : {0.1e-3, 0.3e-3, 1e-3}) {
        const double radius = 12 * h, depth = 0.72 * h;  // patch 8.2 voxels wide
        const std::vector<Orientation> turns = orientations();
        std::vector<double> forces;
        for (size_t n = 0; n < turns.size(); ++n) {
            const Vector3d center = h * (Vector3d::Constant(kVoxels / 2) + turns[n].shift);
            const Vector3d normal = turns[n].R.col(2);
            const ContactScene scene(cubeGeometry(kVoxels, h), halfSpace(center, normal),
                                     {SphereShape{{0, 0, 0}, radius}});
            const double truth = M_PI * kKappa * (radius - depth) * depth * depth;
            for (const Bound& bound : kBounds) {
                const auto result = scene.contactAt(uncapped(), presetSettings(bound.preset),
                                                    Pose{center + (radius - depth) * normal});
                expectNear(result.term.wrench, {truth * normal, Vector3d::Zero()}, radius, bound,
                           nameOf(bound, h, n));
                if (bound.preset == Preset::kBalanced)
                    forces.push_back(result.term.wrench.force.norm() / truth);
            }
        }
        const auto [least, most] = std::minmax_element(forces.begin(), forces.end());
        EXPECT_LT(*most - *least, 0.02) << "anisotropy, voxel " << h * 1e3 << " mm";
    }
}

// A ball that is smaller than a voxel is felt wherever it touches, with every preset.
TEST(AnalyticContact, BallSmallerThanAVoxel) {
    const double h = 1e-3;
    const std::vector<Orientation> turns = orientations();
    for (size_t n = 0; n < turns.size(); ++n) {
        const Vector3d center = h * (Vector3d::Constant(12) + turns[n].shift);
        const Vector3d normal = turns[n].R.col(2);
        const auto body = halfSpace(center, normal);
        for (const double radius : {0.3e-3, 0.5e-3, 0.7e-3}) {
            const ContactScene scene(cubeGeometry(25, h), body, {SphereShape{{0, 0, 0}, radius}});
            const double depth = 0.05 * radius, truth = M_PI * 1e12 * (radius - depth) * depth * depth;
            for (const Preset preset : {Preset::kFast, Preset::kBalanced, Preset::kExact}) {
                const Vector3d place = center + 0.7e-3 * turns[n].R.col(0);
                const auto result = scene.contactAt({.stiffness_per_area = 1e12}, presetSettings(preset),
                                                    Pose{place + (radius - depth) * normal});
                const double bound = preset == Preset::kFast ? 0.1 : 0.03;
                EXPECT_NEAR(result.term.wrench.force.dot(normal) / truth, 1, bound)
                    << presetName(preset) << ", radius " << radius * 1e3 << " mm, orientation " << n;
            }
        }
    }
}

TEST(AnalyticContact, ShaftLyingOnPlane) {
    for (const double h : {0.1e-3, 0.3e-3, 1e-3}) {
        const double radius = 12 * h, depth = 0.72 * h, length = 24 * h;
        const std::vector<Orientation> turns = orientations();
        for (size_t n = 0; n < turns.size(); ++n) {
            const Matrix3d& R = turns[n].R;
            const Vector3d center = h * (Vector3d::Constant(kVoxels / 2) + turns[n].shift);
            // The tool point is off the middle, so that there is a torque.
            const CylinderShape shaft{{0, -length / 4, 0}, {0, 3 * length / 4, 0}, radius};
            const ContactScene scene(cubeGeometry(kVoxels, h), halfSpace(center, R.col(2)), {shaft});
            const Pose X_VT{center + (radius - depth) * R.col(2) - length / 4 * R.col(1),
                            Eigen::Quaterniond(R)};
            const Wrench truth =
                quadrature(planeElements(center, R, length, h / 8), scene.tool.field({}), kKappa, X_VT);
            for (const Bound& bound : kBounds)
                expectNear(scene.contactAt(uncapped(), presetSettings(bound.preset), X_VT).term.wrench, truth,
                           radius, bound, nameOf(bound, h, n));
        }
    }
}

// Per length, a shaft that goes on for ever, with h = R - δ and a = √(R² - h²), has ∫ κ (R - ρ) h/ρ dx with
// ρ² = x² + h², which is 2κh(R asinh(a/h) - a). (The bone-normal law has κ(aR - h² asinh(a/h)) instead.) This
// checks the quadrature itself.
TEST(AnalyticContact, QuadratureAgreesWithTheClosedForms) {
    const double radius = 1.2e-3, depth = 0.1e-3, high = radius - depth;
    const Matrix3d R = expRotation({0.3, 0.2, -0.7}).toRotationMatrix();
    const std::vector<SurfaceElement> plane = planeElements(Vector3d::Zero(), R, 1.5e-3, 4e-6);
    const ShapeField sphere({SphereShape{{0, 0, 0}, radius}});
    const double on_sphere = quadrature(plane, sphere, kKappa, Pose{high * R.col(2)}).force.norm();
    EXPECT_NEAR(on_sphere / (M_PI * kKappa * high * depth * depth), 1, 1e-4);
    const ShapeField shaft({CylinderShape{{0, -9e-3, 0}, {0, 9e-3, 0}, radius}});
    const double on_shaft =
        quadrature(plane, shaft, kKappa, {high * R.col(2), Eigen::Quaterniond(R)}).force.norm() / 3e-3;
    const double a = std::sqrt(radius * radius - high * high);
    EXPECT_NEAR(on_shaft / (2 * kKappa * high * (radius * std::asinh(a / high) - a)), 1, 2e-3);
}

TEST(AnalyticContact, PegInHole) {
    for (const double h : {0.1e-3, 0.3e-3, 1e-3}) {
        const double hole = 20 * h, radius = 19.5 * h, offset = 3 * h;  // contact arc 58 voxels wide
        const std::vector<Orientation> turns = orientations();
        for (size_t n = 0; n < turns.size(); ++n) {
            const Matrix3d& R = turns[n].R;
            const Vector3d center = h * (Vector3d::Constant(kVoxels / 2) + turns[n].shift);
            const auto body = [&](const Vector3d& p) {
                const Vector3d q = R.transpose() * (p - center);
                return hole - std::hypot(q.x(), q.y());
            };
            const CylinderShape peg{{0, 0, -10 * h}, {0, 0, 10 * h}, radius};
            const ContactScene scene(cubeGeometry(kVoxels, h), body, {peg});
            const Pose X_VT{center + offset * R.col(0), Eigen::Quaterniond(R)};
            const Wrench truth =
                quadrature(holeElements(center, R, hole, 15 * h, h / 6), scene.tool.field({}), kKappa, X_VT);
            for (const Bound& bound : kBounds)
                expectNear(scene.contactAt(uncapped(), presetSettings(bound.preset), X_VT).term.wrench, truth,
                           radius, bound, nameOf(bound, h, n));
        }
    }
}

// Every level stands for the same surface: with areas the force does not depend on the shell factor.
TEST(AnalyticContact, CoarserLevelsKeepTheForce) {
    const double h = 0.1e-3, radius = 40 * h, depth = 2.6 * h;  // patch 28 voxels wide: 9 points at s = 3
    const Vector3d center = Vector3d::Constant(32.3 * h), normal = Vector3d(1, 2, 3).normalized();
    const ContactScene scene(cubeGeometry(kVoxels, h), halfSpace(center, normal),
                             {SphereShape{{0, 0, 0}, radius}}, {.levels = {{1}, {2}, {3}}});
    const double truth = M_PI * kKappa * (radius - depth) * depth * depth;
    for (const int factor : {1, 2, 3}) {
        AccuracySettings settings;
        settings.shell_factor = factor;
        const auto result = scene.contactAt(uncapped(), settings, Pose{center + (radius - depth) * normal});
        EXPECT_NEAR(result.term.wrench.force.norm() / truth, 1, 0.03) << factor;
    }
}

}  // namespace
}  // namespace bonemill
