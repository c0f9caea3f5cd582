// Looks at pixels of two attempts' bones beside each other.
#include <gtest/gtest.h>

#include <algorithm>

#include "render_client/look/offscreen/osmesa_context.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/synthetic_scene.h"

namespace bonemill {
namespace {

constexpr uint32_t kFirstOther = 1000;  // of the other bone's leaves
const Eigen::Vector3d kMiddle(0.008, 0.008, 0.008);

std::vector<NodeMesh> ball(double radius, uint32_t first_leaf) {
    std::vector<NodeMesh> nodes =
        test::meshBody(65, 2.5e-4, [=](const Eigen::Vector3d& p) { return (p - kMiddle).norm() - radius; });
    for (NodeMesh& node : nodes) node.leaf += first_leaf;
    return nodes;
}

// The other ball is smaller.
class BesidePicture : public testing::TestWithParam<Quality> {
  protected:
    static constexpr int kWidth = 480, kHeight = 300;
    BesidePicture() : context_(kWidth, kHeight), scene_(context_.gl()) {
        scene_.settings().show_hud = false;
        scene_.settings().quality = GetParam();
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.005);
        info_ = test::makeSceneInfo("balls", kMiddle - half, kMiddle + half);
        info_.set_other_first_leaf(kFirstOther);
        *info_.mutable_tool() = test::makeToolMesh(1e-3, 4e-4, 0.006);
        status_ = test::makeStatus();
        status_.mutable_replay()->mutable_comparison()->set_shows_beside(true);
    }
    void set(const std::vector<NodeMesh>& nodes) {
        for (const NodeMesh& node : nodes) scene_.setNode(node);
    }
    Picture draw() {
        scene_.draw(kWidth, kHeight, 1);
        return context_.read();
    }
    // So many pixels are not as without bone.
    static int pixelsOfBone(const Picture& picture, const Picture& empty, int from, int to) {
        int count = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = from; x < to; ++x) {
                const auto a = picture.at(x, y), b = empty.at(x, y);
                count += std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > 60;
            }
        return count;
    }

    OsmesaContext context_;
    RenderScene scene_;
    topics::SceneInfo info_;
    topics::Status status_;
};

TEST_P(BesidePicture, EachBoneHasItsHalfWheneverItsNodesCame) {
    set(ball(0.003, kFirstOther));  // before the scene says whose they are
    scene_.setSceneInfo(info_);
    scene_.setStatus(status_);
    set(ball(0.0045, 0));
    const Picture both = draw();
    const auto place = scene_.pick(kWidth / 4, kHeight / 2);
    ASSERT_TRUE(place);
    EXPECT_NEAR((*place - kMiddle).norm(), 0.0045, 1e-4) << "one picks on the first bone";
    EXPECT_FALSE(scene_.pick(3 * kWidth / 4, kHeight / 2)) << "and not on the other";
    EXPECT_EQ(scene_.nodeCount(), ball(0.003, 0).size() + ball(0.0045, 0).size());

    for (NodeMesh& node : ball(0.003, kFirstOther)) scene_.setNode(test::emptyNode(node.leaf));
    for (NodeMesh& node : ball(0.0045, 0)) scene_.setNode(test::emptyNode(node.leaf));
    set(ball(0.0004, kFirstOther));  // hardly to be seen
    const Picture empty = draw();
    const int left = pixelsOfBone(both, empty, 0, kWidth / 2),
              right = pixelsOfBone(both, empty, kWidth / 2, kWidth);
    EXPECT_GT(right, 1000);
    EXPECT_NEAR(double(left) / right, 2.25, 0.4) << "as the squares of their radii";
}

TEST_P(BesidePicture, WithoutTheWishItIsThePictureOfTheFirstAlone) {
    scene_.setSceneInfo(info_);
    set(ball(0.0045, 0));
    status_.mutable_replay()->mutable_comparison()->set_shows_beside(false);
    scene_.setStatus(status_);
    const Picture alone = draw();
    set(ball(0.003, kFirstOther));
    scene_.drawWholeNext();
    EXPECT_EQ(draw(), alone);
}

// The other one's tool is in its half, where the first one has a ghost.
TEST_P(BesidePicture, TheToolIsInBothHalves) {
    scene_.setSceneInfo(info_);
    scene_.setStatus(status_);
    set(ball(0.0045, 0)), set(ball(0.003, kFirstOther));
    Pose X_WT;
    X_WT.position = kMiddle + Eigen::Vector3d(0, 0, 0.0045);
    const topics::ToolState alone = test::makeToolState(X_WT, X_WT, 0);
    scene_.setToolState(alone);
    const Picture without = draw();
    topics::ToolState with = alone;
    test::setVector(X_WT.position, with.mutable_p_wt_expert_m());
    test::setQuaternion(X_WT.rotation, with.mutable_q_wt_expert());
    scene_.setToolState(with);
    EXPECT_GT(pixelsOfBone(draw(), without, kWidth / 2, kWidth), 100);
}

INSTANTIATE_TEST_SUITE_P(Qualities, BesidePicture, testing::Values(Quality::kFull, Quality::kQuick));

}  // namespace
}  // namespace bonemill
