#include "haptic_server/tick/volume_reset.h"

#include <gtest/gtest.h>

#include "haptic_server/milling/timed_milling.h"
#include "tests/support/test_bodies.h"

namespace bonemill {
namespace {

TEST(VolumeReset, GivesBackTheScannedBoneAndItsShell) {
    const auto make = [] {
        return BoneModel(test::bodyVolume(test::cubeGeometry(40, 0.5e-3),
                                          test::sphereAt(Eigen::Vector3d::Constant(10e-3), 7e-3)),
                         Eigen::Vector3i::Constant(8), {.levels = {{1}, {2}}});
    };
    BoneModel bone = make();
    const BoneModel original = make();
    VolumeReset reset(bone);
    TimedMilling milling({.removal_rate = 1e9}, bone.volume, bone.lattice, 2e-3);
    for (int n = 0; n < 20; ++n)
        milling.apply(bone.volume, bone.lattice, bone.shell, Eigen::Vector3d(3e-3 + n * 0.5e-3, 9e-3, 11e-3),
                      -1, 1e-3);
    ASSERT_NE(bone.volume.at(16, 18, 22), original.volume.at(16, 18, 22));
    EXPECT_FALSE(reset.isRunning());
    reset.request();
    EXPECT_FALSE(reset.isRunning());
    reset.startIfRequested();
    int ticks = 0;
    while (reset.isRunning()) {
        ASSERT_TRUE(reset.restoreSome(bone));
        ASSERT_LT(++ticks, 10'000);
    }
    EXPECT_GT(ticks, 1);  // spread over ticks
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i) ASSERT_EQ(bone.volume.at(i, j, k), original.volume.at(i, j, k));
    EXPECT_GT(bone.shell.staleLeaves(1), 0u);
    EXPECT_TRUE(bone.shell.prepare(bone.volume, bone.lattice, 1, int(bone.lattice.leafCount())).is_ready);
    for (int level = 0; level < 2; ++level)
        EXPECT_EQ(bone.shell.pointCount(level), original.shell.pointCount(level));
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        EXPECT_EQ(bone.lattice.version(leaf) % 2, 0u);
}

}  // namespace
}  // namespace bonemill
