#include "haptic_server/surface/density_stream/density_source.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/scanned_bone.h"

namespace bonemill {
namespace {

using Eigen::Vector3i;

constexpr int kEdge = DensitySource::kBrickVoxels;

// Of a bone of 4 × 3 × 3 bricks.
Vector3i firstOf(uint32_t brick) {
    return Vector3i(int(brick) % 4, int(brick) / 4 % 3, int(brick) / 12) * kEdge;
}

TEST(DensitySource, GivesEveryVoxelOnce) {
    test::ScannedBone scan;
    const DensitySource source(scan.bone, scan.history);
    ASSERT_EQ(source.brickCount(), 36u);
    scan.write({{20, 20, 20}, {30, 25, 36}}, 12345);
    for (uint32_t brick = 0; brick < 36; ++brick) {
        const std::vector<Density> scanned = source.scanned(brick);
        const auto present = source.present(brick);
        ASSERT_TRUE(present);
        ASSERT_EQ(scanned.size(), size_t(kEdge * kEdge * kEdge));
        ASSERT_EQ(present->densities.size(), scanned.size());
        size_t n = 0;
        const Vector3i first = firstOf(brick);
        forEachIndex({first, first.array() + (kEdge - 1)}, [&](const Vector3i& v) {
            const bool is_inside = (v.array() < scan.bone.volume.dims().array()).all();
            ASSERT_EQ(scanned[n], is_inside ? scan.scannedAt(v) : 0) << brick << ' ' << v.transpose();
            ASSERT_EQ(present->densities[n], is_inside ? scan.at(v) : 0) << brick << ' ' << v.transpose();
            ++n;
        });
    }
}

TEST(DensitySource, KnowsWhatVoxelsAreMadeOf) {
    test::ScannedBone scan;
    EXPECT_TRUE(DensitySource(scan.bone, scan.history).materials(20).empty()) << "nobody asks";
    const BoneProperties properties = test::randomMaterials(scan);
    const DensitySource source(scan.bone, scan.history, &properties);
    scan.write({{20, 20, 20}, {30, 25, 36}}, 0);
    for (const uint32_t brick : {17u, 21u, 35u}) {
        const std::vector<MaterialId> materials = source.materials(brick);
        ASSERT_EQ(materials.size(), size_t(kEdge * kEdge * kEdge));
        size_t n = 0;
        const Vector3i first = firstOf(brick);
        forEachIndex({first, first.array() + (kEdge - 1)}, [&](const Vector3i& v) {
            const bool is_inside = (v.array() < scan.bone.volume.dims().array()).all();
            ASSERT_EQ(materials[n++], is_inside ? properties.material(v) : kNoMaterial) << v.transpose();
        });
    }
}

TEST(DensitySource, KnowsWhatWasScannedAsAir) {
    test::ScannedBone scan;
    const DensitySource source(scan.bone, scan.history);
    const std::string bits = source.airBits();
    ASSERT_EQ(bits.size(), 5u);
    for (uint32_t brick = 0; brick < 36; ++brick) {
        const std::vector<Density> scanned = source.scanned(brick);
        const bool is_air = std::ranges::all_of(scanned, [](Density density) { return density == 0; });
        EXPECT_EQ(uint8_t(bits[brick / 8]) >> brick % 8 & 1, int(is_air)) << brick;
    }
    EXPECT_EQ(bits[0] & 1, 1) << "the first one is";
}

TEST(DensitySource, CountsRevisionsUpWhereIsWritten) {
    test::ScannedBone scan;
    const DensitySource source(scan.bone, scan.history);
    for (uint32_t brick = 0; brick < 36; ++brick) EXPECT_EQ(source.revision(brick), 0u);
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        const Vector3i v = test::randomVoxel(scan.bone.volume, random);
        const Vector3i at = v / kEdge;
        const auto brick = uint32_t(at.x() + 4 * (at.y() + 3 * at.z()));
        const auto before = source.revision(brick);
        scan.write({v, v}, Density(round));
        EXPECT_GT(source.revision(brick), before) << v.transpose();
    }
    scan.bone.lattice.beginWrite({{20, 20, 20}, {20, 20, 20}});
    EXPECT_FALSE(source.revision(17)) << "it is being written";
    EXPECT_FALSE(source.present(17));
}

// While the tick fills the brick with one density after the other, no copy has two of them. Some of its
// pauses are long enough for a copy on a slow machine, most are not.
TEST(DensitySource, NeverMixesTwoMoments) {
    constexpr int kMoments = 200, kLongestPause = 64;
    constexpr std::chrono::seconds kPatience{60};
    test::ScannedBone scan;
    const DensitySource source(scan.bone, scan.history);
    const IndexBox brick{{16, 16, 16}, {31, 31, 31}};
    scan.write(brick, 1);
    std::atomic<bool> is_over{false};
    Density last = 1;
    std::thread tick([&] {
        for (int pause = 1; !is_over; pause = pause % kLongestPause + 1) {
            scan.write(brick, last = Density(last % 30000 + 1));
            std::this_thread::sleep_for(std::chrono::microseconds(50) * pause);
        }
    });
    uint32_t revision = 0;
    bool is_whole = true;
    int moments = 0;
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (moments < kMoments && is_whole && std::chrono::steady_clock::now() < end) {
        const auto present = source.present(17);
        if (!present) continue;
        EXPECT_GE(present->revision, revision);
        moments += present->revision != revision;
        revision = present->revision;
        const Density first = present->densities[0];
        is_whole = std::ranges::all_of(present->densities, [&](Density d) { return d == first; });
    }
    is_over = true;
    tick.join();
    EXPECT_TRUE(is_whole);
    EXPECT_EQ(moments, kMoments);
    EXPECT_EQ(source.present(17)->densities[5], last);
}

}  // namespace
}  // namespace bonemill
