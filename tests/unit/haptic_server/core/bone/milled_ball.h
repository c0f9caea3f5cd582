// Makes a ball of bone that a burr can cut grooves into, with the history that puts it back.
#pragma once

#include <gtest/gtest.h>

#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/core/milling/timed_milling.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {

struct MilledBall {
    static constexpr int kVoxels = 40;

    MilledBall() : bone(makeBone()), history(bone), checkpoints(history, bone) {}

    static BoneModel makeBone() {
        return BoneModel(
            bodyVolume(cubeGeometry(kVoxels, 0.5e-3), sphereAt(Eigen::Vector3d::Constant(10e-3), 7e-3)),
            Eigen::Vector3i::Constant(8), {.levels = {{1}, {2}}});
    }

    // Mills along x at this height, as the tick does it; direction -1 removes, +1 adds.
    void groove(double y, double z = 11e-3, int direction = -1) {
        TimedMilling milling({.removal_rate = 1e9, .addition_rate = 1e9}, bone.volume, bone.lattice, 2e-3);
        for (int n = 0; n < 20; ++n) {
            EXPECT_TRUE(history.beginWrite(0));
            const MillingResult milled = milling.apply(bone.volume, bone.lattice, bone.shell,
                                                       {3e-3 + n * 0.5e-3, y, z}, direction, 1e-3);
            history.endWrite(milled.removed_voxels, milled.added_voxels);
        }
    }
    // Does one tick's part. False means that nothing was on its way.
    bool restoreSome() {
        EXPECT_TRUE(history.beginWrite(0));
        bool shell_is_complete = true;
        const bool is_restoring = history.restoreSome(bone, shell_is_complete);
        EXPECT_TRUE(shell_is_complete);
        history.endWrite(0, 0);
        return is_restoring;
    }
    // Returns the ticks that it took.
    int restoreAll() {
        int ticks = 0;
        while (restoreSome() && ticks < 10'000) ++ticks;
        EXPECT_LT(ticks, 10'000);
        EXPECT_FALSE(history.isRestoring());
        return ticks;
    }
    std::vector<Density> densities() const { return densitiesOf(bone); }
    static std::vector<Density> densitiesOf(const BoneModel& of) {
        std::vector<Density> all;
        for (int k = 0; k < kVoxels; ++k)
            for (int j = 0; j < kVoxels; ++j)
                for (int i = 0; i < kVoxels; ++i) all.push_back(of.volume.at(i, j, k));
        return all;
    }
    int64_t voxelsOfBone() const {
        int64_t count = 0;
        for (const Density density : densities()) count += density >= bone.volume.iso();
        return count;
    }

    BoneModel bone;
    BoneHistory history;
    Checkpoints checkpoints;
};

}  // namespace bonemill::test
