#include <gtest/gtest.h>

#include "render_client/look/camera/camera.h"
#include "render_client/look/paint/render_targets.h"

namespace bonemill {
namespace {

constexpr int kChangesWidth = 400, kChangesHeight = 300;

class PictureChangesTest : public testing::Test {
  protected:
    PictureChangesTest() {
        view_.camera = OrbitCamera().view();
        view_.bone_V = {Eigen::Vector3d::Constant(-0.05), Eigen::Vector3d::Constant(0.05)};
    }
    PictureChanges::Dirty next(const Eigen::AlignedBox3f& changed_V, const PixelBox& moving,
                               std::vector<float> still_like = {}) {
        const DepthRange range = changes_.range(view_.camera, Frame::neededRange(view_, {}));
        const Frame frame = Frame::make(view_, {}, double(kChangesWidth) / kChangesHeight, range);
        return changes_.next(frame, kChangesWidth, kChangesHeight, changed_V, moving, std::move(still_like));
    }

    const PixelBox whole_ = PixelBox::whole(kChangesWidth, kChangesHeight);
    FrameView view_;
    PictureChanges changes_;
};

TEST_F(PictureChangesTest, OnlyWhatChangedAndWhatMovesOfARestingView) {
    EXPECT_EQ(next({}, {}).bone, whole_);
    const PixelBox here{10, 10, 20, 20}, there{50, 60, 80, 90};
    PictureChanges::Dirty dirty = next({}, here);
    EXPECT_TRUE(dirty.bone.isEmpty());
    EXPECT_EQ(dirty.all, here);
    dirty = next({}, there);
    EXPECT_EQ(dirty.all, here.joined(there)) << "where it was, too";
    const Eigen::AlignedBox3f node(Eigen::Vector3f::Constant(-0.005f), Eigen::Vector3f::Constant(0.005f));
    dirty = next(node, {});
    EXPECT_FALSE(dirty.bone.isEmpty());
    EXPECT_LT(dirty.bone.width(), kChangesWidth / 4);
    EXPECT_EQ(dirty.all, dirty.bone.joined(there));
    EXPECT_TRUE(next({}, {}).all.isEmpty());
}

TEST_F(PictureChangesTest, NothingOfWhatStandsStill) {
    const PixelBox here{10, 10, 20, 20};
    next({}, here, {1, 2});
    EXPECT_TRUE(next({}, here, {1, 2}).all.isEmpty());
    EXPECT_EQ(next({}, here, {1, 3}).all, here) << "it has moved within its box";
    EXPECT_EQ(next({}, here).all, here) << "nothing is known of it";
    EXPECT_EQ(next({}, here, {1, 3}).all, here);
    changes_.forget();
    EXPECT_EQ(next({}, here, {1, 3}).all, whole_);
}

TEST_F(PictureChangesTest, AllAfterAChangeOfTheView) {
    next({}, {});
    view_.camera.eye_W.x() += 0.001;
    EXPECT_EQ(next({}, {}).bone, whole_);
    EXPECT_TRUE(next({}, {}).bone.isEmpty());
    view_.cuts_W.planes[0] = {1, 0, 0, 0.01f};
    EXPECT_EQ(next({}, {}).bone, whole_);
    changes_.forget();
    EXPECT_EQ(next({}, {}).bone, whole_);
}

TEST_F(PictureChangesTest, TheDepthRangeHoldsWhatIsNeededAndRests) {
    const DepthRange first = changes_.range(view_.camera, {0.2, 0.4});
    EXPECT_LT(first.near, 0.2);
    EXPECT_GT(first.far, 0.4);
    const DepthRange same = changes_.range(view_.camera, {0.21, 0.41});
    EXPECT_EQ(same.near, first.near);
    EXPECT_EQ(same.far, first.far);
    EXPECT_EQ(changes_.range(view_.camera, {0.2, 0.5}).far, 0.5);
}

// The tool was far away, or at the eye, for a moment.
TEST_F(PictureChangesTest, TheDepthRangeDoesNotStayWide) {
    changes_.range(view_.camera, {0.2, 0.4});
    EXPECT_EQ(changes_.range(view_.camera, {0.2, 500}).far, 500);
    EXPECT_LT(changes_.range(view_.camera, {0.2, 0.4}).far, 0.8);
    EXPECT_LE(changes_.range(view_.camera, {0.001, 0.4}).near, 0.001);
    EXPECT_GT(changes_.range(view_.camera, {0.2, 0.4}).near, 0.1);
}

}  // namespace
}  // namespace bonemill
