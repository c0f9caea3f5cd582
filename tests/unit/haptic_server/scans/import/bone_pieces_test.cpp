#include "haptic_server/scans/find_bone/bone_pieces.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace bonemill {
namespace {

constexpr Density kPiecesIso = 1000;

VoxelVolume airOf(const Eigen::Vector3i& dims) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    return VoxelVolume(geometry, kPiecesIso);
}

struct PieceCount {
    uint64_t pieces_kept = 0;
    uint64_t pieces_removed = 0;
    uint64_t voxels_removed = 0;
};

PieceCount countRemoved(VoxelVolume& volume, uint32_t smallest) {
    const size_t before = BonePieces(volume).list().size();
    const uint64_t voxels = removeSmallPieces(volume, smallest);
    const size_t kept = BonePieces(volume).list().size();
    return {kept, before - kept, voxels};
}

// The pieces have 1, 2 and 3 voxels; the last touches another only across an edge, which does not connect.
TEST(SmallPieces, goBelowTheSurface) {
    VoxelVolume volume = airOf({6, 5, 4});
    const auto set = [&](int i, int j, int k) { volume.set(i, j, k, kPiecesIso); };
    set(0, 0, 0);
    set(2, 2, 1), set(2, 2, 2);
    set(4, 0, 3), set(5, 0, 3), set(5, 1, 3);
    set(4, 2, 3);  // edge neighbour of (5, 1, 3)
    const PieceCount count = countRemoved(volume, 3);
    EXPECT_EQ(count.pieces_kept, 1u);
    EXPECT_EQ(count.pieces_removed, 3u);
    EXPECT_EQ(count.voxels_removed, 4u);
    EXPECT_EQ(volume.at(0, 0, 0), kPiecesIso - 1);
    EXPECT_EQ(volume.at(2, 2, 2), kPiecesIso - 1);
    EXPECT_EQ(volume.at(4, 2, 3), kPiecesIso - 1);
    EXPECT_EQ(volume.at(5, 0, 3), kPiecesIso);
    EXPECT_EQ(volume.at(1, 1, 1), 0);
}

TEST(BonePieces, AreListedTheLargestFirstWithTheirPlaces) {
    VoxelVolume volume = airOf({8, 6, 5});
    const auto set = [&](int i, int j, int k) { volume.set(i, j, k, kPiecesIso); };
    set(0, 0, 0);
    set(4, 2, 1), set(5, 2, 1), set(5, 3, 1), set(5, 3, 2);
    set(7, 5, 4), set(6, 5, 4);
    set(0, 5, 4);
    const BonePieces pieces(volume);
    ASSERT_EQ(pieces.list().size(), 4u);
    EXPECT_EQ(pieces.list()[0].voxels, 4u);
    EXPECT_EQ(pieces.list()[0].box.min, Eigen::Vector3i(4, 2, 1));
    EXPECT_EQ(pieces.list()[0].box.max, Eigen::Vector3i(5, 3, 2));
    EXPECT_TRUE(pieces.list()[0].middle.isApprox(Eigen::Vector3d(4.75, 2.5, 1.25)));
    EXPECT_EQ(pieces.list()[1].voxels, 2u);
    EXPECT_EQ(pieces.list()[2].box.min, Eigen::Vector3i(0, 0, 0)) << "of two alike the lower one";
    EXPECT_EQ(pieces.list()[3].box.min, Eigen::Vector3i(0, 5, 4));
    EXPECT_EQ(pieces.touching({{5, 0, 0}, {7, 3, 1}}), (std::vector<bool>{true, false, false, false}));
    EXPECT_EQ(pieces.touching({{7, 5, 0}, {7, 5, 4}}), (std::vector<bool>{false, true, false, false}));
    std::vector<Eigen::Vector3i> seen;
    EXPECT_EQ(
        pieces.drop(volume, {false, true, false, true}, [&](const Eigen::Vector3i& v) { seen.push_back(v); }),
        3u);
    EXPECT_EQ(seen, (std::vector<Eigen::Vector3i>{{0, 5, 4}, {6, 5, 4}, {7, 5, 4}}));
    EXPECT_EQ(volume.at(6, 5, 4), kPiecesIso - 1);
    EXPECT_EQ(volume.at(4, 2, 1), kPiecesIso);
}

TEST(SmallPieces, nothingIsTooSmallForSizesOfZeroAndOne) {
    VoxelVolume volume = airOf({3, 3, 3});
    volume.set(1, 1, 1, kPiecesIso);
    for (const uint32_t size : {0u, 1u}) EXPECT_EQ(countRemoved(volume, size).pieces_removed, 0u);
    EXPECT_EQ(volume.at(1, 1, 1), kPiecesIso);
}

// This is the slow and obvious way: voxel by voxel, one piece after the other.
class FloodFill {
  public:
    FloodFill(VoxelVolume& volume, uint32_t smallest)
        : volume_(volume), seen_(volume.geometry().voxelCount()) {
        const Eigen::Vector3i n = volume.dims();
        for (int k = 0; k < n.z(); ++k)
            for (int j = 0; j < n.y(); ++j)
                for (int i = 0; i < n.x(); ++i) {
                    const std::vector<Eigen::Vector3i> piece = pieceAt({i, j, k});
                    if (piece.empty()) continue;
                    ++(piece.size() < smallest ? count.pieces_removed : count.pieces_kept);
                    if (piece.size() >= smallest) continue;
                    count.voxels_removed += piece.size();
                    for (const auto& v : piece) volume.set(v.x(), v.y(), v.z(), Density(volume.iso() - 1));
                }
    }
    PieceCount count;

  private:
    bool isNew(const Eigen::Vector3i& v) {
        const Eigen::Vector3i n = volume_.dims();
        if (volume_.at(v.x(), v.y(), v.z()) < volume_.iso()) return false;  // the border of air, too
        const size_t index = size_t(v.x() + n.x() * (v.y() + n.y() * v.z()));
        if (seen_[index]) return false;
        return seen_[index] = true;
    }
    std::vector<Eigen::Vector3i> pieceAt(const Eigen::Vector3i& seed) {
        std::vector<Eigen::Vector3i> piece;
        if (isNew(seed)) piece.push_back(seed);
        for (size_t next = 0; next < piece.size(); ++next)
            for (int side = 0; side < 6; ++side) {
                Eigen::Vector3i v = piece[next];
                v[side / 2] += side % 2 ? 1 : -1;
                if (isNew(v)) piece.push_back(v);
            }
        return piece;
    }

    VoxelVolume& volume_;
    std::vector<bool> seen_;
};

VoxelVolume noise(const Eigen::Vector3i& dims, double share_of_bone, unsigned seed) {
    std::mt19937 random(seed);
    std::bernoulli_distribution is_bone(share_of_bone);
    VoxelVolume volume = airOf(dims);
    for (int k = 0; k < dims.z(); ++k)
        for (int j = 0; j < dims.y(); ++j)
            for (int i = 0; i < dims.x(); ++i)
                volume.set(i, j, k,
                           Density(is_bone(random) ? kPiecesIso + random() % 2 : random() % kPiecesIso));
    return volume;
}

// Near 0.31 pieces of noise join into one, with windings of every kind.
TEST(SmallPieces, areThoseOfAFloodFill) {
    unsigned seed = 0;
    for (const Eigen::Vector3i& dims :
         {Eigen::Vector3i(23, 19, 17), Eigen::Vector3i(2, 40, 3), Eigen::Vector3i(64, 2, 2)})
        for (const double share : {0.0, 0.1, 0.25, 0.31, 0.4, 0.7, 1.0})
            for (const uint32_t smallest : {2u, 5u, 40u, 1000000u}) {
                SCOPED_TRACE(testing::Message()
                             << dims.transpose() << ", share " << share << ", " << smallest);
                VoxelVolume volume = noise(dims, share, ++seed), expected = noise(dims, share, seed);
                const PieceCount count = countRemoved(volume, smallest);
                const PieceCount oracle = FloodFill(expected, smallest).count;
                EXPECT_EQ(count.pieces_kept, oracle.pieces_kept);
                EXPECT_EQ(count.pieces_removed, oracle.pieces_removed);
                EXPECT_EQ(count.voxels_removed, oracle.voxels_removed);
                for (int k = 0; k < dims.z(); ++k)
                    for (int j = 0; j < dims.y(); ++j)
                        for (int i = 0; i < dims.x(); ++i)
                            ASSERT_EQ(volume.at(i, j, k), expected.at(i, j, k));
            }
}

}  // namespace
}  // namespace bonemill
