// Looks through transparent bone.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

TEST_F(ViewMode, TransparentBoneShowsTheToolInside) {
    showMilledBlock(*scene_);
    // Seen from behind, the whole block lies between the eye and the burr.
    scene_->setViewWish({.target_W = {}, .distance = {}, .azimuth = M_PI, .elevation = 0.0});
    const auto effect_of_the_glow = [&] {
        scene_->setToolState(makeToolState(toolInCavity(), toolInCavity(), 0));
        const Picture idle = draw();
        scene_->setToolState(makeToolState(toolInCavity(), toolInCavity(), 1));
        return countDifferent(idle, draw());
    };
    EXPECT_EQ(effect_of_the_glow(), 0u);
    scene_->settings().is_transparent = true;
    EXPECT_GT(effect_of_the_glow(), 300u);
}

TEST_F(ViewMode, TransparencyDoesNotDependOnTheOrderOfArrival) {
    scene_->settings().is_transparent = true;
    scene_->settings().cuts[0] = {true, 0.6, false};
    showMilledBlock(*scene_);
    const Picture picture = draw();
    freshScene();
    scene_->settings().is_transparent = true;
    scene_->settings().cuts[0] = {true, 0.6, false};
    std::vector<NodeMesh> nodes = milledBlock();
    std::reverse(nodes.begin(), nodes.end());
    for (NodeMesh& node : nodes) {
        std::rotate(node.indices.begin(), node.indices.begin() + 3, node.indices.end());
        scene_->setNode(node);
    }
    showMilledBlock(*scene_);
    for (const NodeMesh& node : nodes) scene_->setNode(node);
    EXPECT_EQ(draw(), picture);
}

}  // namespace
}  // namespace bonemill::test
