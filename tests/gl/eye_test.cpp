// The eyes stand where they should: two of them in stereo, one on the tool in the endoscope.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

TEST_F(ViewMode, TheHalvesOfSideBySideAreTheEyesPictures) {
    showMilledBlock(*scene_);
    scene_->settings().stereo = StereoMode::kSideBySide;
    draw();
    const StereoPair eyes = stereoPair(scene_->camera().view());
    const double apart = (eyes.right.eye_W - eyes.left.eye_W).norm();
    EXPECT_NEAR(apart, scene_->camera().distance / 30, 1e-9);
    const Vector3d target = scene_->camera().target_W;
    const Vector3d nearer = target + 0.3 * (eyes.left.eye_W - target);
    const int half = kWidth / 2;
    EXPECT_NEAR(project(eyes.left, target, half, kHeight).x, half / 2.0, 1e-9) << "no parallax at the target";
    EXPECT_NEAR(project(eyes.right, target, half, kHeight).x, half / 2.0, 1e-9);
    EXPECT_GT(project(eyes.left, nearer, half, kHeight).x, project(eyes.right, nearer, half, kHeight).x)
        << "what is nearer comes out of the screen";
}

// The brightness of the left eye's picture gives the red, the right eye's picture green and blue.
TEST_F(ViewMode, TheAnaglyphTakesRedFromTheLeftAndTheRestFromTheRight) {
    showMilledBlock(*scene_);
    scene_->settings().stereo = StereoMode::kAnaglyph;
    const Picture anaglyph = draw();
    // The eyes' own pictures: the same size comes from side-by-side in a window of twice the width.
    scene_.reset();
    const OsmesaContext wide(2 * kWidth, kHeight);
    RenderScene scene(wide.gl());
    scene.settings().show_hud = false;
    scene.settings().stereo = StereoMode::kSideBySide;
    showMilledBlock(scene);
    scene.draw(2 * kWidth, kHeight, 1);
    const Picture eyes = wide.read();
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto left = eyes.at(x, y), right = eyes.at(kWidth + x, y), both = anaglyph.at(x, y);
            ASSERT_NEAR(both[0], 0.299 * left[0] + 0.587 * left[1] + 0.114 * left[2], 1.01) << x << " " << y;
            ASSERT_EQ(both[1], right[1]) << x << " " << y;
            ASSERT_EQ(both[2], right[2]) << x << " " << y;
        }
}

TEST_F(ViewMode, TheEndoscopeSeesTheCavity) {
    showMilledBlock(*scene_);
    Pose X_WT = toolInCavity();
    X_WT.position += 0.0022 * (X_WT.rotation * Vector3d::UnitY());  // a little out of it
    scene_->setToolState(makeToolState(X_WT, X_WT, 0));
    scene_->settings().camera = CameraMode::kEndoscope;
    draw();
    size_t on_the_cavity = 0, seen = 0;
    for (int y = 0; y < kHeight; y += 3)
        for (int x = 0; x < kWidth; x += 3) {
            const auto p = scene_->pick(x, y);
            seen += p.has_value();
            on_the_cavity += p && std::abs((*p - kCavityCenter).norm() - kCavityRadius) < 6e-5;
        }
    EXPECT_GT(on_the_cavity, 500u) << "of " << seen;
}

TEST_F(ViewMode, WithoutAToolTheEndoscopeFallsBackToTheOrbit) {
    showSphere();
    const Picture orbit = draw();
    scene_->settings().camera = CameraMode::kEndoscope;
    EXPECT_EQ(draw(), orbit);
}

}  // namespace
}  // namespace bonemill::test
