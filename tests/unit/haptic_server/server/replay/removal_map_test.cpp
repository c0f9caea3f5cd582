#include <gtest/gtest.h>

#include "haptic_server/server/replay/survey.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

class RemovalMapTest : public testing::Test {
  protected:
    static constexpr double kSpacing = 0.5e-3;
    static VoxelVolume full() {
        return test::bodyVolume(test::cubeGeometry(40, kSpacing),
                                [](const Eigen::Vector3d&) { return -1.0; });
    }
    void set(const Eigen::Vector3i& v, Density density) { bone_.set(v.x(), v.y(), v.z(), density); }
    static Eigen::Vector3d placeOf(const Eigen::Vector3i& v) { return kSpacing * v.cast<double>(); }
    // The tick that is told for the voxel itself.
    std::optional<uint64_t> at(const Eigen::Vector3i& v, uint64_t now) const {
        const auto found = map_.nearest(placeOf(v), 0.1 * kSpacing, now);
        return found ? std::optional(found->tick) : std::nullopt;
    }

    const VoxelVolume start_ = full();
    VoxelVolume bone_ = full();
    RemovalMap map_{start_, bone_};
};

TEST_F(RemovalMapTest, TellsTheTickThatTookTheVoxelBelowTheIsoValue) {
    const Eigen::Vector3i first(3, 4, 5), second(20, 21, 39);
    set(first, test::kTestIso);  // still bone
    map_.add(7, {first, first});
    EXPECT_EQ(at(first, 100), std::nullopt);
    set(first, test::kTestIso - 1);
    map_.add(8, {first, first});
    set(second, 0);
    map_.add(9, {first, second});
    map_.add(10, {first, second});  // nothing has changed
    EXPECT_EQ(at(first, 100), 8u);
    EXPECT_EQ(at(second, 100), 9u);
    EXPECT_EQ(at({3, 4, 6}, 100), std::nullopt);
}

TEST_F(RemovalMapTest, AVoxelThatWasPutBackMayGoAgain) {
    const Eigen::Vector3i voxel(16, 16, 16);
    set(voxel, 0);
    map_.add(5, {voxel, voxel});
    set(voxel, kMaxDensity);
    map_.lookAnew();
    set(voxel, 0);
    map_.add(50, {voxel, voxel});
    EXPECT_EQ(at(voxel, 20), 5u);
    EXPECT_EQ(at(voxel, 50), 50u);
    EXPECT_EQ(at(voxel, 1000), 50u);
    EXPECT_EQ(at(voxel, 2), 5u) << "before the first one: that one";
}

TEST_F(RemovalMapTest, MaterialThatIsAddedIsBoneAgain) {
    const Eigen::Vector3i voxel(1, 1, 1);
    for (const uint64_t tick : {10u, 20u, 30u}) {
        set(voxel, tick == 20 ? kMaxDensity : 0);
        map_.add(tick, {voxel, voxel});
    }
    EXPECT_EQ(at(voxel, 15), 10u);
    EXPECT_EQ(at(voxel, 35), 30u);
}

TEST_F(RemovalMapTest, TheNearestCountsAndOfThoseFirstWhatIsGoneNow) {
    const Eigen::Vector3i near(10, 10, 10), far(12, 10, 10);
    set(far, 0);
    map_.add(1, {far, far});
    set(near, 0);
    map_.add(2, {near, near});
    const Eigen::Vector3d place = placeOf({9, 10, 10});
    EXPECT_EQ(map_.nearest(place, 2e-3, 2)->voxel, near);
    EXPECT_EQ(map_.nearest(place, 2e-3, 1)->voxel, far) << "the nearer one is still there";
    EXPECT_EQ(map_.nearest(place, 2e-3, 0)->voxel, near);
    EXPECT_FALSE(map_.nearest(place, 0.4e-3, 9));
}

TEST_F(RemovalMapTest, PlacesOutsideFindWhatIsInReach) {
    set({0, 0, 0}, 0);
    map_.add(3, {{-1, -1, -1}, {0, 0, 0}});
    EXPECT_EQ(map_.nearest({-1e-3, 0, 0}, 2e-3, 9)->tick, 3u);
    EXPECT_FALSE(map_.nearest({-1e3, 1e3, 1e9}, 2e-3, 9));
}

}  // namespace
}  // namespace bonemill
