// Tools with edges in holes of their own shape, under quick hands, and on spikes thinner than a voxel.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "haptic_server/core/equilibrium/gradient_model.h"
#include "tests/support/contact_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kHoldDt = 1e-3;
constexpr double kDrillRadius = 1.6e-3;
constexpr Preset kHeldBy[] = {Preset::kFast, Preset::kBalanced, Preset::kExact};

// Along T's y; its flat end is at the origin.
const std::vector<ToolShape> kFlatDrill = {
    CylinderShape{{0, 0, 0}, {0, 12e-3, 0}, kDrillRadius, kEdgeRadius}};

// F stands askew in the grid, its origin in the middle of the volume; the bone is given in F.
struct AskewBone {
    AskewBone(unsigned seed, double voxel, double side, const DistanceFunction& body,
              const std::vector<ToolShape>& tool)
        : random(seed),
          R_VF(randomRotation(random)),
          middle(Vector3d::Constant(std::ceil(side / voxel) * voxel / 2)),
          scene(
              cubeGeometry(int(std::ceil(side / voxel)) + 1, voxel),
              [&](const Vector3d& p_V) { return body(R_VF.conjugate() * (p_V - middle)); }, tool) {}
    Pose at(const Vector3d& p_F, const Quaterniond& R_FT = Quaterniond::Identity()) const {
        return {middle + R_VF * p_F, R_VF * R_FT};
    }
    GradientModel model(const AccuracySettings& settings) const {
        GradientModel model({}, scene.world(), {&scene.tool, {.radius = kDrillRadius}, 50}, kHoldDt);
        model.setAccuracy(settings);
        return model;
    }
    std::mt19937 random;
    Quaterniond R_VF;
    Vector3d middle;
    ContactScene scene;
};

struct Drawn {
    double resists = 0, behind = 0;  // N; m
};

// Draws the tool along its axis out of the hole by 4.5 mm at 10 mm/s, by a hand that leans `aside`.
Drawn drawOut(const AskewBone& bone, Preset preset, double aside) {
    GradientModel model = bone.model(presetSettings(preset));
    const Vector3d bottom(0, -1.5e-3, 0);
    Pose spo = bone.at(bottom);
    Drawn drawn;
    for (int tick = 0; tick < 500; ++tick) {
        const double up = std::max(0, tick - 50) * kHoldDt * 10e-3;
        const SpoStep step = model.advance(spo, bone.at(bottom + Vector3d(aside, up, 0)));
        spo = step.X_VT;
        const Vector3d f = bone.R_VF.conjugate() * step.wrench_hand_V.force;
        if (up > 0) drawn.resists = std::max(drawn.resists, -f.y());
        drawn.behind = up - (bone.R_VF.conjugate() * (spo.position - bone.at(bottom).position)).y();
    }
    return drawn;
}

TEST(EdgeHold, APlugComesOutOfItsOwnHole) {
    const ShapeField plug(kFlatDrill);
    const auto hole = [&](const Vector3d& p_F) {
        return std::max(p_F.y() - 1.5e-3, -plug.sample(p_F + Vector3d(0, 1.5e-3, 0)).distance);
    };
    for (const double voxel : {0.15e-3, 0.4e-3}) {
        const AskewBone bone(3, voxel, 9e-3, hole, kFlatDrill);
        for (const Preset preset : kHeldBy)
            for (const double aside : {0.0, 0.3e-3}) {
                const Drawn drawn = drawOut(bone, preset, aside);
                EXPECT_LE(drawn.resists, 0.06)  // of that the coupling's drag is 0.03
                    << presetName(preset) << ", voxel " << voxel << ", aside " << aside;
                EXPECT_LE(drawn.behind, 0.02e-3);
            }
    }
}

// Returns the force in each tick of a hand that goes over the bone at 200 mm/s.
std::vector<Vector3d> quickHand(const AskewBone& bone, const AccuracySettings& settings,
                                const Quaterniond& R_FT, double height) {
    GradientModel model = bone.model(settings);
    const auto device = [&](double x) { return bone.at({x, height, 0}, R_FT); };
    Pose spo = bone.at({-4e-3, height + 1e-3, 0}, R_FT);
    for (int n = 0; n < 100; ++n) spo = model.advance(spo, device(-4e-3)).X_VT;
    std::vector<Vector3d> forces;
    for (int n = 0; n < 40; ++n) {
        const SpoStep step = model.advance(spo, device(-4e-3 + 0.2e-3 * n));
        spo = step.X_VT;
        forces.push_back(step.wrench_hand_V.force);
    }
    return forces;
}

// Returns how far the force of a tick is from what it were if its solve went on to the end, N.
double unsolved(const AskewBone& bone, Preset preset, double lean, double height) {
    const Quaterniond R_FT = expRotation({0.1, 0, lean});
    AccuracySettings settings = presetSettings(preset);
    const auto felt = quickHand(bone, settings, R_FT, height);
    settings.iterations = 400;
    const auto solved = quickHand(bone, settings, R_FT, height);
    double worst = 0, most = 0;
    for (size_t n = 0; n < felt.size(); ++n) {
        worst = std::max(worst, (felt[n] - solved[n]).norm());
        most = std::max(most, solved[n].norm());
    }
    EXPECT_GT(most, 0.3) << "it meets the bone";
    return worst;
}

// How far a solve gets depends on how the voxels lie to the face, hence many of them.
TEST(EdgeHold, AQuickHandOverAFlatFaceIsFollowedInOneTick) {
    const auto flat = [](const Vector3d& p_F) { return p_F.y(); };
    const auto most = [](Preset preset, bool is_worst) {
        if (preset == Preset::kFast) return is_worst ? 2.0 : 1.2;
        return preset == Preset::kBalanced ? (is_worst ? 0.4 : 0.1) : 0.001;
    };
    constexpr unsigned kBones = 7;
    for (const double voxel : {0.125e-3, 0.5e-3}) {
        std::vector<AskewBone> bones;
        for (unsigned seed = 1; seed <= kBones; ++seed)
            bones.emplace_back(seed, voxel, 12e-3, flat, kFlatDrill);
        for (const Preset preset : kHeldBy)
            for (const double lean : {0.0, 0.35}) {
                std::vector<double> left;
                for (const AskewBone& bone : bones) left.push_back(unsolved(bone, preset, lean, -0.5e-3));
                std::sort(left.begin(), left.end());
                EXPECT_LE(left[kBones / 2], most(preset, false))
                    << presetName(preset) << ", voxel " << voxel << ", lean " << lean;
                EXPECT_LE(left.back(), most(preset, true))
                    << presetName(preset) << ", voxel " << voxel << ", lean " << lean;
            }
    }
}

// In 5 mm the face rises and falls by 1.2 mm, which the tool goes through in 25 ticks.
TEST(EdgeHold, AQuickHandOverWavesIsFollowedInOneTick) {
    const auto waves = [](const Vector3d& p_F) {
        return p_F.y() + 0.6e-3 * std::cos(2 * M_PI * p_F.x() / 5e-3);
    };
    for (const double voxel : {0.125e-3, 0.5e-3}) {
        const AskewBone bone(2, voxel, 12e-3, waves, kFlatDrill);
        for (const double lean : {-0.5, 0.2, 0.5}) {
            EXPECT_LE(unsolved(bone, Preset::kBalanced, lean, 0.5e-3), 0.3) << voxel << ", lean " << lean;
            EXPECT_LE(unsolved(bone, Preset::kExact, lean, 0.5e-3), 0.1) << voxel << ", lean " << lean;
        }
    }
}

// Returns how much the force moves, N RMS, of a tool that is held on a spike of `half_angle`.
double restlessness(const AskewBone& bone, Preset preset, double aside, double deep) {
    GradientModel model = bone.model(presetSettings(preset));
    Pose spo = bone.at({aside, 2e-3, 0}, expRotation({0.2, 0, 0}));
    const Quaterniond rotation = spo.rotation;
    Vector3d sum = Vector3d::Zero();
    double squares = 0;
    constexpr int kPress = 200, kSettle = 200, kListen = 200;
    for (int n = 0; n < kPress + kSettle + kListen; ++n) {
        const double height = 2e-3 - (2e-3 - deep) * std::min(1.0, double(n) / kPress);
        const Pose device{bone.at({aside, height, 0}).position, rotation};
        const SpoStep step = model.advance(spo, device);
        spo = step.X_VT;
        if (n < kPress + kSettle) continue;
        sum += step.wrench_hand_V.force;
        squares += step.wrench_hand_V.force.squaredNorm();
    }
    EXPECT_GT((sum / kListen).norm(), 0.05);
    return std::sqrt(std::max(0.0, squares / kListen - (sum / kListen).squaredNorm()));
}

TEST(EdgeHold, OnAThinSpikeTheToolComesToRest) {
    const std::vector<ToolShape> ball = {SphereShape{Vector3d::Zero(), 1e-3}};
    for (unsigned seed = 0; seed < 4; ++seed) {
        const double half_angle = 0.2 + 0.05 * seed;
        const auto spike = [=](const Vector3d& p_F) {
            return std::hypot(p_F.x(), p_F.z()) * std::cos(half_angle) + p_F.y() * std::sin(half_angle);
        };
        const AskewBone for_ball(seed, 0.5e-3, 10e-3, spike, ball);
        const AskewBone for_drill(seed, 0.5e-3, 10e-3, spike, kFlatDrill);
        for (const Preset preset : kHeldBy) {
            EXPECT_LE(restlessness(for_ball, preset, 0.3e-3, -0.2e-3), 1e-4) << seed << presetName(preset);
            EXPECT_LE(restlessness(for_drill, preset, 0.3e-3, -1.2e-3), 1e-4) << seed << presetName(preset);
        }
    }
}

}  // namespace
}  // namespace bonemill
