// The point under a pixel is checked against what geometry says.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

// Returns the line of sight through a pixel's centre (W).
Vector3d sight(const Camera& camera, int x, int y) {
    const double right = (2 * (x + 0.5) / kWidth - 1) * camera.halfTangent() * kWidth / kHeight;
    const double up = (1 - 2 * (y + 0.5) / kHeight) * camera.halfTangent();
    return (camera.R_WC * Vector3d(right, up, -1)).normalized();
}

// Returns the distance along the line of sight to the sphere, or nothing when it misses or only grazes it.
std::optional<double> hitSphere(const Vector3d& eye, const Vector3d& direction) {
    const double along = direction.dot(kSphereCenter - eye);
    const double squared =
        kSphereRadius * kSphereRadius - (kSphereCenter - eye).squaredNorm() + along * along;
    if (squared < 0.04 * kSphereRadius * kSphereRadius) return std::nullopt;
    return along - std::sqrt(squared);
}

TEST_F(ViewMode, PickHitsTheSphereWhereTheLineOfSightMeetsIt) {
    showSphere();
    draw();
    const Camera camera = scene_->camera().view();
    size_t hits = 0;
    for (int y = 5; y < kHeight; y += 20)
        for (int x = 5; x < kWidth; x += 20) {
            const Vector3d direction = sight(camera, x, y);
            const auto distance = hitSphere(camera.eye_W, direction);
            if (!distance) continue;
            const auto picked = scene_->pick(x, y);
            ASSERT_TRUE(picked) << x << " " << y;
            ASSERT_LT((*picked - camera.eye_W).normalized().cross(direction).norm(), 1e-6);
            // A multisampled depth is that of one sample, up to half a pixel off.
            ASSERT_NEAR((*picked - kSphereCenter).norm(), kSphereRadius, camera.metresPerPixel(kHeight) / 2)
                << x << " " << y;
            ASSERT_NEAR((*picked - camera.eye_W).norm(), *distance, 0.04 * kSphereRadius) << x << " " << y;
            ++hits;
        }
    EXPECT_GT(hits, 40u);
}

TEST_F(ViewMode, PickFindsNothingOverTheBackgroundOutsideAndInStereo) {
    EXPECT_FALSE(scene_->pick(10, 10)) << "before the first picture";
    showSphere();
    draw();
    EXPECT_TRUE(scene_->pick(kWidth / 2, kHeight / 2));
    EXPECT_FALSE(scene_->pick(1, 1));
    EXPECT_FALSE(scene_->pick(-1, 5));
    EXPECT_FALSE(scene_->pick(kWidth, 5));
    EXPECT_FALSE(scene_->pick(5, kHeight));
    for (const StereoMode mode : {StereoMode::kSideBySide, StereoMode::kAnaglyph}) {
        scene_->settings().stereo = mode;
        draw();
        EXPECT_FALSE(scene_->pick(kWidth / 2, kHeight / 2));
    }
}

TEST_F(ViewMode, SignsAreNotPicked) {
    showSphere();
    draw();
    const auto bare = scene_->pick(kWidth / 2, kHeight / 2);
    topics::Viewer instructor = makeWatcher("I", topics::Viewer::INSTRUCTOR, 60);
    setVector(*bare, instructor.mutable_pointer_m());
    scene_->setWatchers({instructor});
    draw();
    EXPECT_EQ(*scene_->pick(kWidth / 2, kHeight / 2), *bare);
}

}  // namespace
}  // namespace bonemill::test
