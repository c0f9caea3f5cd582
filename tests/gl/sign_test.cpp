// Looks at the signs in the scene: the force arrow and the pointers of instructors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

// Rings, arrow, lines and figures: what differs from the small picture is edges that have become sharper.
TEST_F(ViewMode, OnADisplayOfTwiceThePixelsAllSignsAreTwiceAsLarge) {
    const OsmesaContext large_context(2 * kWidth, 2 * kHeight);
    RenderScene large(large_context.gl());
    scene_->settings().show_hud = true;
    scene_->settings().quality = large.settings().quality = Quality::kQuick;
    topics::ToolState tool = makeToolState(toolInCavity(), toolInCavity(), 1);
    setVector(Vector3d(0.3, 0, 3), tool.mutable_force_n());
    for (RenderScene* scene : {scene_.get(), &large}) {
        showMilledBlock(*scene);
        scene->setToolState(tool);
        scene->setPull(toolInCavity().position + Vector3d(0.004, 0, 0.002));
    }
    const Picture usual = draw();
    large.draw(2 * kWidth, 2 * kHeight, 2);
    const Picture twice = large_context.read();
    size_t different = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            int most = 0;
            for (size_t channel = 0; channel < 3; ++channel) {
                int sum = 0;
                for (const auto& [i, k] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}})
                    sum += twice.at(2 * x + i, 2 * y + k)[channel];
                most = std::max(most, std::abs(sum / 4 - int(usual.at(x, y)[channel])));
            }
            different += most > 60;
        }
    EXPECT_LT(different, size_t(kWidth) * kHeight / 33) << "of the pixels a thirtieth or so is an edge";
    scene_->draw(kWidth, kHeight, 2);
    EXPECT_GT(countDifferent(usual, context_.read()), size_t(kWidth) * kHeight / 25)
        << "larger text in a small picture is another picture";
}

TEST_F(ViewMode, NoArrowForNoForce) {
    showMilledBlock(*scene_);
    const auto effect_of = [&](const Vector3d& force) {
        topics::ToolState tool = makeToolState(toolInCavity(), toolInCavity(), 1);
        setVector(force, tool.mutable_force_n());
        scene_->setToolState(tool);
        scene_->settings().show_force = false;
        const Picture without = draw();
        scene_->settings().show_force = true;
        return countDifferent(without, draw());
    };
    const Vector3d up = Vector3d(0.1, 0, 1).normalized();
    EXPECT_EQ(effect_of(0.04 * up), 0u);
    const size_t small = effect_of(0.2 * up), large = effect_of(20 * up);
    EXPECT_GT(small, 40u);
    EXPECT_GT(large, 2 * small);
    EXPECT_EQ(effect_of({std::nan(""), 0, 0}), 0u);
}

TEST_F(ViewMode, AMouseThatHoldsTheToolHasALineToItInTheColourOfTheForce) {
    showMilledBlock(*scene_);
    scene_->settings().show_force = false;
    const Pose X_WT = toolInCavity();
    const auto draw_with = [&](const std::optional<Vector3d>& wish, double newtons) {
        topics::ToolState tool = makeToolState(X_WT, X_WT, 1);
        setVector({0, 0, newtons}, tool.mutable_force_n());
        scene_->setToolState(tool);
        scene_->setPull(wish);
        return draw();
    };
    const Vector3d away = X_WT.position + 0.004 * scene_->camera().R_WC().col(0);
    const Picture none = draw_with(std::nullopt, 5);
    EXPECT_EQ(countDifferent(none, draw_with(X_WT.position, 5)), 0u) << "tool and wish do not part";
    const Picture idle = draw_with(away, 0), pressing = draw_with(away, 5);
    EXPECT_GT(countDifferent(none, idle), 100u);
    EXPECT_GT(countDifferent(idle, pressing), 100u);
    EXPECT_EQ(countDifferent(none, draw_with(std::nullopt, 5)), 0u);
    const Vector3d behind_eye = scene_->camera().eye_W() + 0.1 * scene_->camera().towardsEye_W();
    EXPECT_EQ(countDifferent(none, draw_with(behind_eye, 5)), 0u);
}

// Nothing else in the picture says how near it is.
TEST_F(ViewMode, ABurrThatHangsInFrontOfTheBoneHasARingOnItThatClosesAsItComesNearer) {
    showMilledBlock(*scene_);
    scene_->settings().show_force = false;
    for (const Quality quality : {Quality::kQuick, Quality::kFull}) {
        scene_->settings().quality = quality;
        const auto ring_of = [&](double gap, uint32_t contacts) {
            Pose X_WT = toolInCavity();
            X_WT.position += (0.003 + gap) * scene_->camera().towardsEye_W();
            topics::ToolState tool = makeToolState(X_WT, X_WT, 0);
            tool.set_contacts(contacts);
            scene_->setToolState(tool);
            scene_->setPull(std::nullopt);
            draw();
            const Picture without = draw();
            scene_->setPull(X_WT.position);
            const Picture with = draw();
            // How far from the burr the ring is seen.
            const Pixel burr = project(scene_->viewCamera(), X_WT.position, kWidth, kHeight);
            double farthest = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x)
                    if (std::abs(with.at(x, y)[0] - without.at(x, y)[0]) > 20)
                        farthest = std::max(farthest, std::hypot(x - burr.x, y - burr.y));
            return farthest;
        };
        const double near = ring_of(0, 0), far = ring_of(0.004, 0);
        EXPECT_GT(near, 5) << int(quality);
        EXPECT_GT(far, 1.2 * near) << int(quality);
        EXPECT_EQ(ring_of(0.002, 3), 0) << "it touches";
    }
}

TEST_F(ViewMode, OnlyInstructorsPointAndAlsoFromBehindBone) {
    showSphere();
    const Picture bare = draw();
    topics::Viewer viewer = makeWatcher("", topics::Viewer::INSTRUCTOR, 60);
    const Vector3d towards_eye = scene_->camera().towardsEye_W();
    const auto effect_at = [&](const Vector3d& p) {
        setVector(p, viewer.mutable_pointer_m());
        scene_->setWatchers({viewer});
        const Picture picture = draw();
        int strongest = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                strongest = std::max(strongest, std::abs(picture.at(x, y)[1] - bare.at(x, y)[1]));
        return strongest;
    };
    const int visible = effect_at(kSphereCenter + kSphereRadius * towards_eye);
    const int hidden = effect_at(kSphereCenter - kSphereRadius * towards_eye);
    EXPECT_GT(hidden, 15);
    EXPECT_GT(visible, 2 * hidden);
    viewer.set_role(topics::Viewer::OPERATOR);
    EXPECT_EQ(effect_at(kSphereCenter + kSphereRadius * towards_eye), 0);
}

}  // namespace
}  // namespace bonemill::test
