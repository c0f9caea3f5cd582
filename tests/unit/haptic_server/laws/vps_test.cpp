#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/unit/haptic_server/laws/law_scene.h"

namespace bonemill {
namespace {

using namespace test;
using Eigen::Vector3d;

constexpr double kVpsVoxel = 0.25e-3;

// A flat pin of 1.5 mm radius over a plane along the voxels: all its points meet voxels of one layer.
struct PinOnPlane {
    // Bone is what lies within `thickness` below the top.
    explicit PinOnPlane(double thickness)
        : scene(cubeGeometry(41, kVpsVoxel),
                [=](const Vector3d& p) { return std::max(p.z() - kTop, kTop - thickness - p.z()); },
                {CylinderShape{{0, 0, 0}, {0, 0, 2e-3}, 1.5e-3}}, {.levels = {{1}}}),
          run(ContactLaw::kVps, scene, at(-1e-3), 1.5e-3) {}
    Pose at(double depth) const { return uprightAt({5.06e-3, 4.93e-3, kSurfaceVoxel - depth}); }
    ContactWrench contact(double depth) { return static_cast<Vps&>(run.model).contactAt(at(depth)); }

    static constexpr double kTop = 5.05e-3;          // the highest bone voxels are at
    static constexpr double kSurfaceVoxel = 5.0e-3;  // this height
    ContactScene scene;
    LawRun run;
};

// McNeely, Puterbaugh and Troy: below the tangent plane through the voxel's middle each point pushes
// linearly; more than ten share the stiffness of ten; and no point pushes from deeper than its layers. The
// points of the pin's rim lean, so that their planes lie higher.
TEST(Vps, ForceIsLinearInDepthAndBounded) {
    PinOnPlane pin(5e-3);
    const LawConfig config;
    const double k = config.points.point_stiffness * config.points.full_stiffness_contacts;
    EXPECT_EQ(pin.contact(-0.2e-3).contacts, 0u);
    const double most_depth = (Vps::kLayers + 0.5) * kVpsVoxel;
    const double of_rim = pin.contact(1e-6).wrench.force.z();
    EXPECT_LT(of_rim, 0.2);
    double most = 0;
    for (double depth = 0.01e-3; depth < 4 * most_depth; depth += 0.02e-3) {
        const ContactWrench at = pin.contact(depth);
        most = std::max(most, at.wrench.force.z());
        if (depth < 0.1e-3) {  // the face alone; deeper the side's points share the stiffness
            EXPECT_NEAR(at.wrench.force.z() - of_rim, k * depth, 0.05 * k * depth + 0.03) << depth;
        }
        EXPECT_LE(at.wrench.force.z(), k * depth + of_rim + 0.03) << depth;
    }
    EXPECT_LE(most, k * most_depth);
    EXPECT_GT(most, 0.3 * k * most_depth);
    EXPECT_EQ(pin.contact(4 * most_depth).wrench.force.z(), 0);
}

// What it is known for: the tangent planes are those of voxels. A ball that slides over a plane askew feels
// their steps, though the hand's way is straight.
TEST(Vps, FeelsAStaircaseWhereTheBoneIsSmooth) {
    const Vector3d normal = Vector3d(0.25, 0, 1).normalized(), along = Vector3d(1, 0, -0.25).normalized();
    const ContactScene scene = lawPlane(normal);
    double spread[2];
    int n = 0;
    for (const ContactLaw law : {ContactLaw::kVps, ContactLaw::kConstraint}) {
        const auto hand = [&](double way) {
            return uprightAt(kLawMiddle + way * along + (kLawRadius - 0.3e-3) * normal);
        };
        LawRun run(law, scene, uprightAt(kLawMiddle - 0.5e-3 * along + 1.2e-3 * normal));
        run.settle(hand(-0.5e-3), 300);
        double least = INFINITY, most = 0;
        for (int tick = 0; tick < 1000; ++tick) {
            const double force = run.to(hand(-0.5e-3 + 1e-6 * tick)).wrench_hand_V.force.dot(normal);
            least = std::min(least, force), most = std::max(most, force);
        }
        spread[n++] = (most - least) / most;
    }
    EXPECT_GT(spread[0], 0.1);
    EXPECT_LT(spread[1], 0.01);
}

// Pop-through: a wall of one voxel has no layers below its surface.
TEST(Vps, IsPushedThroughAWallOfOneVoxel) {
    for (const double thickness : {kVpsVoxel, 2e-3}) {
        PinOnPlane pin(thickness);
        pin.run.spo = pin.at(-0.1e-3);
        pin.run.settle(pin.at(1.5e-3), 600);
        const bool is_through = pin.run.spo.position.z() < PinOnPlane::kSurfaceVoxel - 1e-3;
        EXPECT_EQ(is_through, thickness == kVpsVoxel);
    }
}

TEST(ToolPoints, LieOnTheToolAsDenselyAsAsked) {
    const ShapeField tool({CapsuleShape{{0, 0, 0}, {0, 20e-3, 0}, 0.5e-3}});
    for (const double spacing : {0.1e-3, 1e-5}) {
        const ToolPoints points(tool, spacing);
        EXPECT_LE(points.count(), ToolPoints::kMax);
        const double area = 2 * M_PI * 0.5e-3 * 21e-3;
        const double per_cell = double(points.count()) * points.spacing() * points.spacing() / area;
        EXPECT_GT(per_cell, 1.0);
        EXPECT_LT(per_cell, 2.0);
        size_t count = 0;
        for (const ToolPoints::Cluster& cluster : points.clusters())
            for (const ToolPoint& point : points.pointsOf(cluster)) {
                const ToolSample at = tool.sample(point.position.cast<double>());
                EXPECT_NEAR(at.distance, 0, 0.1 * points.spacing());
                EXPECT_LT(at.gradient.dot(point.inward.cast<double>()), -0.8);
                ++count;
            }
        EXPECT_EQ(count, points.count());
    }
}

}  // namespace
}  // namespace bonemill
