#include "render_client/look/slices/slice_plane.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "render_client/look/slices/slice_image.h"
#include "tests/unit/render_client/look/slices/sliced_volume.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::SlicedVolume;

SlicePlane throughTheMiddle(const DensityGrid& grid, const Pose& X_WV, size_t axis, int edge) {
    const Eigen::AlignedBox3d box = scanBox(grid, X_WV);
    Vector3d middle = box.center();
    middle[Eigen::Index(axis)] = nearestSlice(grid, X_WV, axis, middle[Eigen::Index(axis)]);
    return slicePlane(X_WV, axis, middle, box.sizes().maxCoeff() / edge, edge, edge);
}

TEST(SlicePlane, TheScanIsWhatItsVoxelsFill) {
    const SlicedVolume volume;
    const Eigen::AlignedBox3d box = scanBox(volume.grid, Pose());
    EXPECT_LT((box.min() - Vector3d(0.8e-3, -2.25e-3, 0.15e-3)).norm(), 1e-12);
    EXPECT_LT((box.sizes() - Vector3d(37 * 4e-4, 29 * 5e-4, 23 * 7e-4)).norm(), 1e-12);
}

TEST(SlicePlane, SnapsToTheScansOwnSlices) {
    const SlicedVolume volume;
    for (size_t axis = 0; axis < 3; ++axis) {
        const auto nearest = [&](double at) { return nearestSlice(volume.grid, Pose(), axis, at); };
        const double first = volume.grid.origin_m[Eigen::Index(axis)],
                     step = volume.grid.spacing_m[Eigen::Index(axis)],
                     last = first + (volume.grid.voxels[Eigen::Index(axis)] - 1) * step;
        EXPECT_DOUBLE_EQ(sliceStep(volume.grid, Pose(), axis), step);
        EXPECT_NEAR(nearest(first + 3.4 * step), first + 3 * step, 1e-12);
        EXPECT_NEAR(nearest(first - 1), first, 1e-12);
        EXPECT_NEAR(nearest(first + 1), last, 1e-12);
    }
    // A quarter turn about z: the slices across W's x are those across V's y.
    EXPECT_DOUBLE_EQ(sliceStep(volume.grid, test::turned({0, 0, M_PI / 2}), 0), 5e-4);
}

// With the bricks that are asked for every pixel is there; a plane on the scan's own slice asks for one
// layer.
TEST(SlicePlane, AsksForTheBricksThatItShows) {
    const SlicedVolume volume;
    for (const Vector3d& rotation : {Vector3d(0, 0, 0), Vector3d(0, 0, M_PI / 2), Vector3d(0.5, -0.3, 0.9)})
        for (size_t axis = 0; axis < 3; ++axis) {
            const SlicePlane plane = throughTheMiddle(volume.grid, test::turned(rotation), axis, 60);
            const std::vector<uint32_t> bricks = bricksOf(volume.grid, plane);
            DensityStore store;
            store.setGrid(volume.grid);
            for (const uint32_t brick : bricks) store.put(brick, volume.brick(brick));
            const SliceImage image = DensitySampler(store).image(plane);
            EXPECT_EQ(std::ranges::count(image.state, SliceState::kLoading), 0);
            EXPECT_GT(std::ranges::count(image.state, SliceState::kHere), 900);
            EXPECT_LT(bricks.size(), size_t(brickCount(volume.grid))) << "not all of them";
            EXPECT_EQ(std::set(bricks.begin(), bricks.end()).size(), bricks.size());
            if (!rotation.isZero()) continue;
            std::set<int> layers;
            for (const uint32_t brick : bricks)
                layers.insert(firstVoxelOf(volume.grid, brick)[Eigen::Index(axis)]);
            EXPECT_EQ(layers.size(), 1u) << "axis " << axis;
        }
}

TEST(SlicePlane, ItsEdgesNameWhatLiesThere) {
    const std::map<std::string, Vector3d> directions = {
        {"L", Vector3d::UnitX()},   {"R", -Vector3d::UnitX()},  {"P", Vector3d::UnitY()},
        {"A", -Vector3d::UnitY()},  {"S", Vector3d::UnitZ()},   {"I", -Vector3d::UnitZ()},
        {"+x", Vector3d::UnitX()},  {"-x", -Vector3d::UnitX()}, {"+y", Vector3d::UnitY()},
        {"-y", -Vector3d::UnitY()}, {"+z", Vector3d::UnitZ()},  {"-z", -Vector3d::UnitZ()}};
    for (size_t axis = 0; axis < 3; ++axis)
        for (const bool are_patients : {true, false}) {
            const SliceView& view = sliceViewOf(axis);
            const SliceLabels& labels = sliceLabelsOf(axis, are_patients);
            EXPECT_EQ(directions.at(labels.right), view.right_W) << labels.title;
            EXPECT_EQ(directions.at(labels.left), -view.right_W) << labels.title;
            EXPECT_EQ(directions.at(labels.bottom), view.down_W) << labels.title;
            EXPECT_EQ(directions.at(labels.top), -view.down_W) << labels.title;
        }
}

TEST(SlicePlane, AFaceCoversTheBoxInStepsOfAVoxel) {
    const SlicedVolume volume;
    for (const Vector3d& rotation : {Vector3d(0, 0, 0), Vector3d(0.5, -0.3, 0.9)}) {
        const Pose X_WV = test::turned(rotation);
        const Eigen::AlignedBox3d box = scanBox(volume.grid, X_WV);
        const SlicePlane fine = facePlane(volume.grid, X_WV, 1, box.center().y(), box, 4096);
        EXPECT_NEAR(fine.right_V.norm(), sliceStep(volume.grid, X_WV, 0), 1e-12);
        EXPECT_NEAR(fine.down_V.norm(), sliceStep(volume.grid, X_WV, 2), 1e-12);
        for (const auto& [column, row] : {std::pair(0, 0), std::pair(fine.width - 1, fine.height - 1)}) {
            const Vector3d corner_W = X_WV * (fine.corner_V + column * fine.right_V + row * fine.down_V);
            EXPECT_NEAR(corner_W.y(), box.center().y(), 1e-12);
            const double beyond_x = column == 0 ? box.min().x() - corner_W.x() : corner_W.x() - box.max().x();
            const double beyond_z = row == 0 ? corner_W.z() - box.max().z() : box.min().z() - corner_W.z();
            EXPECT_GE(std::min(beyond_x, beyond_z), 0);
            EXPECT_LE(std::max(beyond_x, beyond_z), 3 * 7e-4);
        }
        const SlicePlane coarse = facePlane(volume.grid, X_WV, 1, box.center().y(), box, 20);
        EXPECT_LE(std::max(coarse.width, coarse.height), 20);
        EXPECT_GE(coarse.width * coarse.right_V.norm(), box.sizes().x());
    }
    // The pixels are the scan's own voxels.
    const Eigen::AlignedBox3d part(Vector3d(3e-3, 1e-3, 2e-3), Vector3d(9e-3, 7e-3, 8e-3));
    const SlicePlane plane = facePlane(volume.grid, Pose(), 2, 5e-3, part, 4096);
    const Vector3d voxel = (plane.corner_V - volume.grid.origin_m).cwiseQuotient(volume.grid.spacing_m);
    EXPECT_NEAR(voxel.x(), std::round(voxel.x()), 1e-9);
    EXPECT_NEAR(voxel.y(), std::round(voxel.y()), 1e-9);
}

}  // namespace
}  // namespace bonemill
