// Cut-planes are checked against what geometry says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

double redness(const std::array<int, 3>& rgb) {
    return double(rgb[0]) / std::max(1, rgb[1]);
}

// The plane x = 0.6 of the box cuts the disc of radius r·sqrt(1 - 0.2²) out of the sphere; the eye looks
// straight at it.
TEST_F(ViewMode, TheCapCoversTheDiscThatGeometrySays) {
    lookFromTheLeft();
    showSphere();
    scene_->settings().cuts[0] = {true, 0.6, false};
    const Picture cut = draw();
    const Camera camera = scene_->camera().view();
    const double plane_x = kSphereCenter.x() + 0.2 * kSphereRadius;
    const double disc = kSphereRadius * std::sqrt(1 - 0.2 * 0.2);
    const Vector3d middle(plane_x, kSphereCenter.y(), kSphereCenter.z());
    const Pixel center = project(camera, middle, kWidth, kHeight);
    const Pixel rim = project(camera, middle + Vector3d(0, 0, disc), kWidth, kHeight);
    const double radius = center.y - rim.y;
    ASSERT_GT(radius, 60);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const double from_center = std::hypot(x + 0.5 - center.x, y + 0.5 - center.y);
            if (from_center < radius - 2) {
                ASSERT_GT(redness(cut.at(x, y)), 1.17) << "cut bone at " << x << " " << y;
                const auto point = scene_->pick(x, y);
                ASSERT_TRUE(point);
                ASSERT_NEAR(point->x(), plane_x, 2e-6);
            }
        }
    scene_->settings().cuts[0].is_on = false;
    const Picture whole = draw();
    EXPECT_LT(redness(whole.at(int(center.x), int(center.y))), 1.10) << "ivory is not the cut's colour";
}

TEST_F(ViewMode, AFlippedCutHidesTheOtherSide) {
    lookFromTheLeft();
    showSphere();
    scene_->settings().cuts[0] = {true, 0.6, true};  // all below is hidden: the near part is left
    draw();
    const auto near_part = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(near_part);
    EXPECT_NEAR(near_part->x(), kSphereCenter.x() + kSphereRadius, 5e-6);
    scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = -M_PI / 2, .elevation = 0.0});
    draw();
    const auto cap = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(cap);
    EXPECT_NEAR(cap->x(), kSphereCenter.x() + 0.2 * kSphereRadius, 2e-6);
}

// The volume's axes are not the world's: the plane is across W's x, whatever V is.
TEST_F(ViewMode, CutsAreAcrossTheWorldsAxes) {
    const Vector3d half = Vector3d::Constant(kSphereRadius);
    topics::SceneInfo info = makeSceneInfo("turned sphere", kSphereCenter - half, kSphereCenter + half);
    const Pose X_WV{{0.02, -0.01, 0.03}, expRotation({0.5, -0.3, 0.9})};
    setVector(X_WV.position, info.mutable_p_wv_m());
    setQuaternion(X_WV.rotation, info.mutable_q_wv());
    lookFromTheLeft();
    scene_->setSceneInfo(info);
    for (const NodeMesh& node : sphereNodes()) scene_->setNode(node);
    scene_->settings().cuts[0] = {true, 0.5, false};  // the turned box' middle is the sphere's
    draw();
    const auto cap = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(cap);
    EXPECT_LT((*cap - X_WV * kSphereCenter).norm(), scene_->camera().view().metresPerPixel(kHeight));
    EXPECT_NEAR(cap->x(), (X_WV * kSphereCenter).x(), 2e-6);
}

TEST_F(ViewMode, ThreeCutsLeaveOneCorner) {
    showSphere();
    scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = M_PI * 3 / 4, .elevation = 0.6});
    for (CutPlane& cut : scene_->settings().cuts) cut = {true, 0.5, false};
    draw();
    size_t on_planes = 0;
    for (int y = 0; y < kHeight; y += 3)
        for (int x = 0; x < kWidth; x += 3) {
            const auto p = scene_->pick(x, y);
            if (!p) continue;
            const Vector3d beyond = *p - kSphereCenter;
            ASSERT_LT(beyond.maxCoeff(), 1e-5) << "beyond a cut";
            on_planes += beyond.maxCoeff() > -1e-5;
        }
    EXPECT_GT(on_planes, 500u);
}

// The surface of a bone that the scan's border leaves open is not closed by a cut elsewhere.
TEST_F(ViewMode, AnOpenBorderGetsNoCap) {
    const auto nodes = meshBody(
        65, 2.5e-4, [](const Vector3d& p) { return std::hypot(p.x() - 0.008, p.y() - 0.008) - 0.003; });
    scene_->setSceneInfo(makeSceneInfo("open rod", {0.005, 0.005, 0}, {0.011, 0.011, 0.016}));
    for (const NodeMesh& node : nodes) scene_->setNode(node);
    scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = 0.2, .elevation = 1.2});
    const Picture open = draw();
    const auto inside = scene_->pick(kWidth / 2, kHeight / 2);
    ASSERT_TRUE(inside);
    scene_->settings().cuts[2] = {true, 1.0, false};
    scene_->settings().cuts[2].position = 0.5;
    draw();
    size_t caps = 0;
    for (int y = 0; y < kHeight; y += 2)
        for (int x = 0; x < kWidth; x += 2) {
            const auto p = scene_->pick(x, y);
            caps += p && std::abs(p->z() - 0.008) < 1e-5;
        }
    EXPECT_GT(caps, 200u) << "the cut in the middle of the rod has one";
    scene_->settings().cuts[2].is_on = false;
    EXPECT_EQ(draw(), open);
}

TEST_F(ViewMode, TheToolIsNotCut) {
    showMilledBlock(*scene_);
    const topics::ToolState nowhere;
    scene_->settings().cuts[1] = {true, 0.5, true};  // hides the front, where the tool is
    const Picture with_tool = draw();
    scene_->setToolState(nowhere);
    EXPECT_GT(countDifferent(with_tool, draw()), 500u);
}

}  // namespace
}  // namespace bonemill::test
