#include <gtest/gtest.h>

#include "render_client/look/slices/slice_plane.h"
#include "tests/unit/render_client/look/slices/sliced_volume.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::SlicedVolume;

ViewSettings withPanes() {
    ViewSettings settings;
    settings.slices.are_shown = true;
    return settings;
}

TEST(Panes, StandInAColumnOfAtMostAThird) {
    constexpr std::pair<int, int> kSizes[] = {{1280, 720}, {1280, 800}, {3840, 2160}, {500, 900}, {64, 64}};
    for (const auto& [width, height] : kSizes) {
        const int columns = paneColumns(withPanes(), width, height);
        EXPECT_LE(columns, width / 3 + 1);
        const auto rects = paneRects(withPanes(), width, height);
        for (const PaneRect& rect : rects) {
            EXPECT_GE(rect.x, width - columns);
            EXPECT_LE(rect.x + rect.width, width);
            EXPECT_GE(rect.y, 0);
            EXPECT_LE(rect.y + rect.height, height);
            EXPECT_EQ(rect.width, rect.height);
        }
        EXPECT_LE(rects[2].y + rects[2].height, rects[1].y) << "axial above coronal";
        EXPECT_LE(rects[1].y + rects[1].height, rects[0].y) << "coronal above sagittal";
    }
    EXPECT_GE(paneRects(withPanes(), 1280, 720)[0].width, 230) << "readable";
}

TEST(Panes, ThereAreNoneUnlessWantedAndNeverBeforeOneEye) {
    ViewSettings settings;
    EXPECT_EQ(paneColumns(settings, 1280, 720), 0);
    settings.slices.are_shown = true;
    EXPECT_GT(paneColumns(settings, 1280, 720), 0);
    settings.stereo = StereoMode::kAnaglyph;
    EXPECT_GT(paneColumns(settings, 1280, 720), 0);
    settings.stereo = StereoMode::kSideBySide;
    EXPECT_EQ(paneColumns(settings, 1280, 720), 0);
}

TEST(Panes, FollowTheBurrUntilTheyAreScrolled) {
    const SlicedVolume volume;
    SliceSettings settings;
    const SliceBurr burr{scanBox(volume.grid, Pose()).center() + Vector3d(1e-3, 2e-3, 3e-3), 1.5e-3};
    for (size_t axis = 0; axis < 3; ++axis) {
        const auto pane = [&] {
            return makePane(volume.grid, Pose(), settings, axis, {0, 0, 200, 200}, burr);
        };
        const double at = burr.p_W[Eigen::Index(axis)];
        const double step = volume.grid.spacing_m[Eigen::Index(axis)];
        EXPECT_LE(std::abs(pane().position_W - at), step / 2);
        const double off = at - pane().position_W;
        EXPECT_NEAR(pane().circle * pane().metres_per_pixel, std::sqrt(1.5e-3 * 1.5e-3 - off * off), 1e-9);
        settings.positions[axis] = at - 2.5e-3;
        EXPECT_NEAR(pane().position_W, at - 2.5e-3, step / 2);
        EXPECT_EQ(pane().circle, 0) << "the plane passes the burr";
        EXPECT_TRUE(pane().cross) << "but where it is is shown";
    }
}

TEST(Panes, BeginInTheBoneWhileTheBurrIsOutsideOfTheScan) {
    const SlicedVolume volume;
    const Vector3d centre_W = scanBox(volume.grid, Pose()).center();
    const SliceBurr far{centre_W + Vector3d(1, 1, 1), 1.5e-3};
    for (size_t axis = 0; axis < 3; ++axis) {
        const Pane pane = makePane(volume.grid, Pose(), {}, axis, {0, 0, 200, 200}, far);
        EXPECT_LE(std::abs(pane.position_W - centre_W[Eigen::Index(axis)]),
                  volume.grid.spacing_m[Eigen::Index(axis)]);
    }
}

TEST(Panes, ZoomInAroundTheBurr) {
    const SlicedVolume volume;
    SliceSettings settings;
    const Eigen::AlignedBox3d box = scanBox(volume.grid, Pose());
    const PaneRect rect{0, 0, 200, 200};
    for (const double zoom : {1.0, 2.0, 8.0, 16.0})
        for (const Vector3d& part : {Vector3d(0.5, 0.5, 0.5), Vector3d(0.02, 0.97, 0.5), Vector3d(1, 0, 0)})
            for (size_t axis = 0; axis < 3; ++axis) {
                settings.zoom = zoom;
                const SliceBurr burr{box.min() + box.sizes().cwiseProduct(part), 1e-3};
                const Pane pane = makePane(volume.grid, Pose(), settings, axis, rect, burr);
                EXPECT_LE((*pane.cross - Eigen::Vector2d(100, 100)).cwiseAbs().maxCoeff(), 100 + 1e-6);
            }
    settings.zoom = 1;
    const Pane whole = makePane(volume.grid, Pose(), settings, 2, rect, {});
    settings.zoom = 4;
    EXPECT_NEAR(makePane(volume.grid, Pose(), settings, 2, rect, {}).metres_per_pixel * 4,
                whole.metres_per_pixel, 1e-12);
    EXPECT_FALSE(whole.cross);
}

}  // namespace
}  // namespace bonemill
