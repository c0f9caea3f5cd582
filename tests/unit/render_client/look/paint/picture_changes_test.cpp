#include "render_client/look/paint/picture_changes.h"

#include <gtest/gtest.h>

#include "render_client/look/camera/camera.h"

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
                               std::vector<float> still_like = {},
                               std::vector<Eigen::AlignedBox3f> look_V = {}) {
        const DepthRange range = changes_.range(view_.camera, Frame::neededRange(view_, {}));
        const Frame frame = Frame::make(view_, {}, double(kChangesWidth) / kChangesHeight, range);
        return changes_.next(frame, kChangesWidth, kChangesHeight,
                             {changed_V, std::move(look_V), tiles({moving}), std::move(still_like)});
    }
    static PixelTiles tiles(const std::vector<PixelBox>& boxes) {
        PixelTiles tiles(kChangesWidth, kChangesHeight);
        for (const PixelBox& box : boxes) tiles.add(box);
        return tiles;
    }

    const Eigen::AlignedBox3f node_{Eigen::Vector3f::Constant(-0.005f), Eigen::Vector3f::Constant(0.005f)};
    const PixelBox whole_ = PixelBox::whole(kChangesWidth, kChangesHeight);
    FrameView view_;
    PictureChanges changes_;
};

TEST_F(PictureChangesTest, OnlyWhatChangedAndWhatMovesOfARestingView) {
    EXPECT_EQ(next({}, {}).bone, whole_);
    const PixelBox here{10, 10, 20, 20}, there{50, 60, 80, 90};
    PictureChanges::Dirty dirty = next({}, here);
    EXPECT_FALSE(dirty.is_whole);
    EXPECT_TRUE(dirty.bone.isEmpty());
    EXPECT_EQ(dirty.moving, tiles({here}));
    dirty = next({}, there);
    EXPECT_EQ(dirty.moving, tiles({here, there})) << "where it was, too";
    dirty = next(node_, {});
    EXPECT_FALSE(dirty.bone.isEmpty());
    EXPECT_LT(dirty.bone.width(), kChangesWidth / 4);
    EXPECT_TRUE(dirty.look.isEmpty());
    EXPECT_EQ(dirty.moving, tiles({there}));
    dirty = next({}, {});
    EXPECT_TRUE(dirty.bone.isEmpty() && dirty.moving.isEmpty());
}

TEST_F(PictureChangesTest, BoneThatOnlyLooksDifferent) {
    const PixelBox bone = (next({}, {}), next(node_, {})).bone;
    const PictureChanges::Dirty dirty = next({}, {}, {}, {node_});
    EXPECT_TRUE(dirty.bone.isEmpty());
    EXPECT_EQ(dirty.look, tiles({bone}));
}

TEST_F(PictureChangesTest, NothingOfWhatStandsStill) {
    const PixelBox here{10, 10, 20, 20};
    next({}, here, {1, 2});
    EXPECT_TRUE(next({}, here, {1, 2}).moving.isEmpty());
    EXPECT_EQ(next(node_, here, {1, 2}).moving, tiles({here})) << "the bone behind it has changed";
    EXPECT_EQ(next({}, here, {1, 3}).moving, tiles({here})) << "it has moved within its box";
    EXPECT_EQ(next({}, here).moving, tiles({here})) << "nothing is known of it";
    EXPECT_EQ(next({}, here, {1, 3}).moving, tiles({here}));
    changes_.forget();
    EXPECT_EQ(next({}, here, {1, 3}).moving, PixelTiles::whole(kChangesWidth, kChangesHeight));
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
