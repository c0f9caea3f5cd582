// A model that is already shown changes: another tool, another node, another quantisation.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

TEST_F(ViewMode, ANewToolOfTheSameSceneKeepsTheView) {
    topics::SceneInfo info = milledInfo();
    info.set_revision(1);
    showMilledBlock(*scene_);
    scene_->setSceneInfo(info);
    draw();
    scene_->camera().orbit(0.3, 0.1);
    const double azimuth = scene_->camera().azimuth;
    const Picture first = draw();
    topics::SceneInfo other = info;
    other.set_revision(2);
    other.set_burr_radius_m(0.0016);
    *other.mutable_tool() = makeToolMesh(0.0016, 4e-4, 0.014);
    scene_->setSceneInfo(other);
    const Picture second = draw();
    EXPECT_DOUBLE_EQ(scene_->camera().azimuth, azimuth);
    EXPECT_GT(countDifferent(first, second), 500u);
    scene_->setSceneInfo(info);  // comes late
    EXPECT_EQ(draw(), second);
}

TEST_F(ViewMode, OnlyWhatIsSetGoesToTheGpu) {
    showSphere();
    const uint64_t nodes = scene_->uploads().nodes, bytes = scene_->uploads().bytes;
    EXPECT_EQ(nodes, sphereNodes().size());
    draw();
    draw();
    EXPECT_EQ(scene_->uploads().nodes, nodes) << "drawing sends nothing";
    const NodeMesh& changed = sphereNodes().front();
    scene_->setNode(changed);
    EXPECT_EQ(scene_->uploads().nodes, nodes + 1);
    EXPECT_EQ(scene_->uploads().bytes - bytes,
              changed.vertices.size() * sizeof(PackedVertex) + changed.indices.size() * sizeof(uint32_t));
    scene_->setNode(emptyNode(changed.leaf));
    EXPECT_EQ(scene_->uploads().nodes, nodes + 1);
}

// The quantisation has 64 steps per voxel instead of thousands, so that it is at most half a step,
// 1/128 voxel, off.
TEST_F(ViewMode, ACoarseQuantisationLooksTheSame) {
    showSphere();
    const Picture fine = draw();
    constexpr float kCoarseStep = 2.5e-4f / 64;
    std::vector<NodeMesh> coarse = sphereNodes();
    for (NodeMesh& node : coarse) {
        const Eigen::Vector3f factor = node.step / kCoarseStep;
        ASSERT_LT(factor.maxCoeff(), 0.2f) << "it is coarser";
        for (PackedVertex& v : node.vertices) {
            v.x = uint16_t(std::lround(float(v.x) * factor.x()));
            v.y = uint16_t(std::lround(float(v.y) * factor.y()));
            v.z = uint16_t(std::lround(float(v.z) * factor.z()));
        }
        node.step.setConstant(kCoarseStep);
    }
    freshScene();
    showSphere(coarse);
    EXPECT_LT(countDifferent(fine, draw()), 300u);
}

}  // namespace
}  // namespace bonemill::test
