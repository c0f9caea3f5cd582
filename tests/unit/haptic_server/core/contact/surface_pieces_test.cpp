#include "haptic_server/core/contact/surface_pieces.h"

#include <gtest/gtest.h>

#include <map>

#include "haptic_server/core/contact/surface_cells.h"
#include "haptic_server/core/tool/shape_field.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kSpacing = 60e-6, kFineWithin = 50e-6;
constexpr uint32_t kPatches = 16;

class Pieces : public testing::Test {
  protected:
    Pieces() : volume_(test::boxGeometry({19, 19, 19}, Vector3d::Constant(0.3e-3)), 32768) {
        std::mt19937 random(11);
        test::fillWaves(volume_, random);
    }
    // A ball in the middle of the waves.
    void start(SurfacePieces& pieces, double margin) {
        const Pose X_VT{Vector3d::Constant(2.7e-3), Eigen::Quaterniond::Identity()};
        pieces.start(ball_, X_VT, X_VT.position, margin, kFineWithin, kSpacing);
        forEachIndex(cells_, [&](const Vector3i& cell) {
            pieces.add(volume_, cell, uint32_t(cell.x()) % kPatches, PatchMemory::kNew);
        });
    }
    double areaOfCells() const {
        SurfaceCells cells(volume_, Vector3i::Constant(19));
        cells.collect(volume_, Vector3i::Zero(), cells_);
        double area = 0;
        for (size_t n = 0; n < cells.count(); ++n) area += double(cells.area(n));
        return area;
    }

    VoxelVolume volume_;
    const IndexBox cells_{Vector3i::Constant(2), Vector3i::Constant(15)};
    const ShapeField ball_{{SphereShape{Vector3d::Zero(), 1e-3}}};
    SurfacePieces pieces_{65536};
};

TEST_F(Pieces, TileTheSurface) {
    const double everywhere = 1;
    start(pieces_, everywhere);
    pieces_.cut(volume_, 60000, 60000);
    ASSERT_FALSE(pieces_.isCoarse());
    double area = 0;
    size_t count = 0;
    for (const SurfacePiece& piece : pieces_.finished()) {
        ASSERT_LT(piece.patch, kPatches);
        area += double(piece.area);
        ++count;
    }
    EXPECT_EQ(count, pieces_.count());
    EXPECT_GT(count, 1000u);
    EXPECT_NEAR(area / areaOfCells(), 1, 1e-5);
}

// No corner of a cell's surface is dropped that the tool can reach, and none is visited that it cannot.
TEST_F(Pieces, ThoseInReachAreVisited) {
    SurfacePieces all(65536);
    start(all, 1);
    all.cut(volume_, 60000, 60000);
    const auto areaWithin = [](const SurfacePieces& pieces, double distance) {
        double area = 0;
        for (const SurfacePiece& piece : pieces.finished())
            if (double(piece.centroid.norm()) - 1e-3 < distance) area += double(piece.area);
        return area;
    };
    start(pieces_, 30e-6);
    pieces_.cut(volume_, 60000, 60000);
    const double wanted = areaWithin(all, 0);
    ASSERT_GT(wanted, 0);
    EXPECT_NEAR(areaWithin(pieces_, 0) / wanted, 1, 1e-5);
    const auto farthestOf = [](const SurfacePieces& pieces) {
        float farthest = 0;
        for (const SurfacePiece& piece : pieces.finished())
            farthest = std::max(farthest, piece.centroid.norm());
        return double(farthest) - 1e-3;
    };
    EXPECT_LT(farthestOf(pieces_), 30e-6 + 2 * SurfacePieces::kMostSag * 0.3e-3);
    EXPECT_GT(farthestOf(all), 1e-3);
}

TEST_F(Pieces, AreCoarserWhenThereAreTooMany) {
    start(pieces_, 1);
    const uint8_t fine = pieces_.cut(volume_, 60000, 60000);
    const size_t many = pieces_.count();
    EXPECT_EQ(fine, 0);
    start(pieces_, 1);
    const uint8_t coarse = pieces_.cut(volume_, many / 2, many / 2);
    EXPECT_GT(coarse, fine);
    EXPECT_TRUE(pieces_.isCoarse());
    EXPECT_LT(pieces_.count(), 3 * many / 4);
}

// What there is no room for is told.
TEST_F(Pieces, TellThatThereIsNoRoom) {
    SurfacePieces few(4096);
    start(few, 1);
    few.cut(volume_, 60000, 60000);
    EXPECT_TRUE(few.isFull());
    EXPECT_TRUE(few.isCoarse());
    start(pieces_, 1);
    pieces_.cut(volume_, 60000, 60000);
    EXPECT_FALSE(pieces_.isFull());
}

}  // namespace
}  // namespace bonemill
