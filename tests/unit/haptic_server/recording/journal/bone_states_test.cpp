#include "haptic_server/recording/journal/bone_states.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/mutated_bytes.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill {
namespace {

class BoneStates : public testing::Test {
  protected:
    DensitiesAsScanned scanned() const { return {ball_.history.scanned(), ball_.bone.lattice}; }
    std::shared_ptr<const BoneSnapshot> snapshot() { return ball_.history.snapshot(ball_.bone); }
    static bool addAll(BoneStateReader& reader, const std::vector<journal::Bone>& messages) {
        for (const journal::Bone& message : messages) {
            journal::Bone read;
            if (!read.ParseFromString(message.SerializeAsString()) || !reader.add(read)) return false;
        }
        return true;
    }
    std::vector<Density> densitiesOf(const BoneSnapshot& state) const {
        const VoxelVolume volume = ball_.history.volumeOf(state, ball_.bone.lattice);
        std::vector<Density> all;
        for (int k = 0; k < test::MilledBall::kVoxels; ++k)
            for (int j = 0; j < test::MilledBall::kVoxels; ++j)
                for (int i = 0; i < test::MilledBall::kVoxels; ++i) all.push_back(volume.at(i, j, k));
        return all;
    }

    test::MilledBall ball_;
};

TEST_F(BoneStates, GiveEveryDensityBackOfEachState) {
    BoneStateWriter writer(scanned());
    BoneStateReader reader(scanned());
    ASSERT_TRUE(addAll(reader, writer.add(*snapshot(), journal::Bone::KEY)));
    EXPECT_TRUE(reader.state()->leaves.empty());
    for (int n = 0; n < 8; ++n) {
        ball_.groove(5e-3 + n * 1e-3, 11e-3 + n % 2 * 1e-3, n == 5 ? +1 : -1);
        const auto state = snapshot();
        ASSERT_TRUE(addAll(reader, writer.add(*state, n == 4 ? journal::Bone::KEY : journal::Bone::CURRENT)));
        ASSERT_TRUE(reader.isComplete());
        EXPECT_EQ(densitiesOf(*reader.state()), ball_.densities());
        EXPECT_EQ(reader.state()->missing_voxels, state->missing_voxels);
        EXPECT_EQ(reader.state()->ticks, state->ticks);
    }
}

TEST_F(BoneStates, ALeafThatIsAsScannedAgainIsGone) {
    BoneStateWriter writer(scanned());
    BoneStateReader reader(scanned());
    ball_.groove(10e-3);
    ASSERT_TRUE(addAll(reader, writer.add(*snapshot(), journal::Bone::KEY)));
    EXPECT_FALSE(reader.state()->leaves.empty());
    ball_.history.restore();
    ball_.restoreAll();
    ASSERT_TRUE(addAll(reader, writer.add(*snapshot(), journal::Bone::CURRENT)));
    EXPECT_TRUE(reader.state()->leaves.empty());
    EXPECT_EQ(densitiesOf(*reader.state()), ball_.densities());
}

TEST_F(BoneStates, WhereNothingChangedNothingIsWritten) {
    BoneStateWriter writer(scanned());
    ball_.groove(10e-3);
    EXPECT_FALSE(writer.add(*snapshot(), journal::Bone::KEY).empty());
    EXPECT_TRUE(writer.add(*snapshot(), journal::Bone::CURRENT).empty());
    ball_.groove(16e-3, 8e-3);
    const auto few = writer.add(*snapshot(), journal::Bone::CURRENT);
    const auto all = writer.add(*snapshot(), journal::Bone::KEY);
    EXPECT_LT(few.back().leaf_steps_size(), all.back().leaf_steps_size());
}

// Else what was milled before a checkpoint would be lost if nothing is milled after it.
TEST_F(BoneStates, AfterACheckpointTheBoneIsToldEvenIfItIsTheSame) {
    BoneStateWriter writer(scanned());
    writer.add(*snapshot(), journal::Bone::KEY);
    ball_.groove(10e-3);
    EXPECT_FALSE(writer.add(*snapshot(), journal::Bone::OTHER).empty());
    const auto told = writer.add(*snapshot(), journal::Bone::CURRENT);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told.back().kind(), journal::Bone::CURRENT);
    EXPECT_EQ(told.back().leaf_steps_size(), 0);
    EXPECT_TRUE(writer.add(*snapshot(), journal::Bone::CURRENT).empty());
}

TEST_F(BoneStates, NeedAKeyFirstAndAfterWhatCannotBe) {
    BoneStateWriter writer(scanned());
    BoneStateReader reader(scanned());
    ball_.groove(10e-3);
    const auto key = writer.add(*snapshot(), journal::Bone::KEY);
    ball_.groove(12e-3);
    const auto change = writer.add(*snapshot(), journal::Bone::CURRENT);
    EXPECT_FALSE(addAll(reader, change));
    ASSERT_TRUE(addAll(reader, key));
    const auto whole = reader.state();
    journal::Bone bad = change.back();
    bad.set_leaf_steps(0, ball_.bone.lattice.leafCount());
    EXPECT_FALSE(reader.add(bad));
    EXPECT_EQ(reader.state(), whole) << "what was whole stays";
    EXPECT_FALSE(addAll(reader, change));
    ASSERT_TRUE(addAll(reader, key));
    EXPECT_TRUE(addAll(reader, change));
    EXPECT_EQ(densitiesOf(*reader.state()), ball_.densities());
}

TEST_F(BoneStates, NothingThatGoesOnIsThereBeforeItsEnd) {
    BoneStateWriter writer(scanned());
    BoneStateReader reader(scanned());
    ball_.groove(10e-3);
    auto messages = writer.add(*snapshot(), journal::Bone::KEY);
    messages.back().set_goes_on(true);
    ASSERT_TRUE(addAll(reader, messages));
    EXPECT_FALSE(reader.isComplete());
    EXPECT_EQ(reader.state(), nullptr);
    journal::Bone rest;
    ASSERT_TRUE(reader.add(rest));
    EXPECT_EQ(densitiesOf(*reader.state()), ball_.densities());
}

TEST_F(BoneStates, ASessionThatStartsFromOneHasTheSameBone) {
    ball_.groove(10e-3);
    ball_.groove(12e-3, 12e-3);
    const auto state = snapshot();
    test::MilledBall other;
    other.history.startFrom(other.bone, state);
    EXPECT_EQ(other.densities(), ball_.densities());
    EXPECT_EQ(other.history.missingVoxels(), ball_.history.missingVoxels());
    EXPECT_FALSE(other.history.isRestoring());
    other.history.restore();
    other.restoreAll();
    EXPECT_EQ(other.densities(), test::MilledBall().densities()) << "the way back to the scan is there";
}

TEST_F(BoneStates, NoMessageOfAnybodysDoesHarm) {
    BoneStateWriter writer(scanned());
    ball_.groove(10e-3);
    const std::string bytes = writer.add(*snapshot(), journal::Bone::KEY).back().SerializeAsString();
    std::mt19937 random(5);
    int taken = 0;
    for (int round = 0; round < 2000; ++round) {
        BoneStateReader reader(scanned());
        journal::Bone bone;
        if (!bone.ParseFromString(test::mutated(bytes, random)) || !reader.add(bone)) continue;
        ++taken;
        if (!reader.state()) continue;
        for (const auto& copy : reader.state()->leaves) EXPECT_LT(copy->leaf, ball_.bone.lattice.leafCount());
    }
    EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace bonemill
