#include "haptic_server/server/session/surroundings_feed.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <set>
#include <thread>

#include "common/rt/clock.h"
#include "haptic_server/surface/mesh/surroundings_mesher.h"

namespace bonemill {
namespace {

constexpr uint32_t kFirstLeaf = 5000;

// Many balls of bone, so that many nodes have a surface.
std::shared_ptr<const Surroundings> balls() {
    VolumeGeometry geometry;
    geometry.dims.setConstant(100);
    geometry.spacing.setConstant(1e-3);
    VoxelVolume volume(geometry, 32768);
    for (int k = 0; k < 100; ++k)
        for (int j = 0; j < 100; ++j)
            for (int i = 0; i < 100; ++i) {
                const Eigen::Vector3i in(i % 20 - 10, j % 20 - 10, k % 20 - 10);
                volume.set(i, j, k, in.squaredNorm() < 36 ? kMaxDensity : Density(0));
            }
    geometry.dims.setConstant(10);
    RegionRim rim(VoxelVolume(geometry, 32768), [](const Eigen::Vector3i&) { return Density(0); });
    return std::make_shared<const Surroundings>(
        Surroundings{std::move(volume), {}, Eigen::AlignedBox3d(), std::move(rim)});
}

TEST(SurroundingsFeed, PutsNodesBehindThoseOfTheBone) {
    MeshOutbox outbox;
    const auto surroundings = balls();
    const SurroundingsFeed feed(surroundings, kFirstLeaf, {}, outbox);
    while (!feed.isDone()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::set<uint32_t> leaves;
    for (const NodeGroup& group :
         outbox.takeNearest(Eigen::Vector3f::Zero(), std::numeric_limits<int64_t>::max(), monotonicNowNs()))
        for (const NodeMesh& mesh : group.meshes) EXPECT_TRUE(leaves.insert(mesh.leaf).second);
    EXPECT_TRUE(outbox.isEmpty());
    ASSERT_FALSE(leaves.empty());
    EXPECT_GE(*leaves.begin(), kFirstLeaf);
    EXPECT_LT(*leaves.rbegin(), kFirstLeaf + surroundingsLeafCount(*surroundings));
    EXPECT_GT(leaves.size(), 20u);
}

TEST(SurroundingsFeed, HasNothingToDoWithoutSurroundings) {
    MeshOutbox outbox;
    const SurroundingsFeed feed(nullptr, kFirstLeaf, {}, outbox);
    EXPECT_TRUE(feed.isDone());
    EXPECT_TRUE(outbox.isEmpty());
}

TEST(SurroundingsFeed, EndsWithItsOwner) {
    const auto surroundings = balls();
    for (int round = 0; round < 5; ++round) {
        MeshOutbox outbox;
        const SurroundingsFeed feed(surroundings, kFirstLeaf, {}, outbox);
        std::this_thread::sleep_for(std::chrono::microseconds(200 * round));
    }
}

}  // namespace
}  // namespace bonemill
