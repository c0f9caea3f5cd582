#include "haptic_server/recording/rerun/rerun.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/user_error.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

// A recording with all that is needed to run it.
struct Loaded {
    explicit Loaded(const std::filesystem::path& journal)
        : recording(journal),
          scene(recording.scene()),
          simulation(setUpScene(scene)),
          bones(recording.readBones(*simulation.bone)),
          rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front()) {}

    Recording recording;
    LoadedScene scene;
    SceneSetup simulation;
    Recording::Bones bones;
    Rerun rerun;
};

class RerunTest : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = new test::TemporaryFolder;
        session_ = new test::RecordedSession(test::recordSession(folder_->path()));
    }
    static void TearDownTestSuite() {
        delete session_;
        delete folder_;
    }
    static inline test::TemporaryFolder* folder_ = nullptr;
    static inline test::RecordedSession* session_ = nullptr;
};

TEST_F(RerunTest, FromTheFirstTickOnAllBitsAreThoseOfTheSession) {
    Loaded loaded(session_->journal);
    const RecordedEffects recorded = recordedEffectsOf(loaded.scene.scene.effects());
    TickHash ticks(recorded);
    StateHash hash;
    RecordedTicks inputs(loaded.recording);
    ASSERT_EQ(loaded.recording.ticks(), session_->x_m.size());
    while (!loaded.rerun.isAtEnd()) {
        const uint64_t tick = loaded.rerun.next();
        const TickRecord& record = loaded.rerun.step();
        ticks.add(record);
        hash.addRecord(record, recorded);
        ASSERT_EQ(ticks.check(), inputs.at(tick).check) << "first in tick " << tick;
        ASSERT_EQ(loaded.rerun.history().missingVoxels(), session_->missing_voxels[tick]) << tick;
    }
    hash.addVolume(loaded.simulation.bone->volume);
    EXPECT_EQ(hash.value(), session_->state_hash);
}

TEST_F(RerunTest, FromAKeyframeOnTheBoneIsTheSameAndTheToolSoonToo) {
    Loaded loaded(session_->journal);
    ASSERT_GE(loaded.bones.keyframes.size(), 2u);
    const Keyframe& keyframe = loaded.bones.keyframes[1];
    loaded.rerun.startAt(keyframe);
    EXPECT_EQ(loaded.rerun.history().missingVoxels(), session_->missing_voxels[keyframe.tick - 1]);
    EXPECT_EQ(loaded.rerun.next(), keyframe.tick);
    double x_m = 0;
    while (loaded.rerun.next() <= keyframe.tick + 300) x_m = loaded.rerun.step().p_WT[0];
    EXPECT_NEAR(x_m, session_->x_m[keyframe.tick + 300], 20e-6);
    const double missing = double(loaded.rerun.history().missingVoxels());
    EXPECT_NEAR(missing, double(session_->missing_voxels[keyframe.tick + 300]), 0.02 * missing);
}

TEST_F(RerunTest, BackToTheFirstKeyframeIsTheSessionsBeginning) {
    Loaded loaded(session_->journal);
    while (loaded.rerun.next() < 1200) loaded.rerun.step();
    loaded.rerun.startAt(loaded.bones.keyframes.front());
    EXPECT_EQ(loaded.rerun.history().missingVoxels(), 0);
    while (loaded.rerun.next() < 700) loaded.rerun.step();
    EXPECT_EQ(loaded.rerun.step().p_WT[0], session_->x_m[700]) << "to the bit";
    EXPECT_EQ(loaded.rerun.history().missingVoxels(), session_->missing_voxels[700]);
}

TEST_F(RerunTest, TicksAndSecondsLeadToEachOther) {
    const Recording recording(session_->journal);
    EXPECT_EQ(recording.secondsOf(0), 0);
    EXPECT_NEAR(recording.lengthS(), 2.999, 1e-4);
    for (const uint64_t tick : {0u, 1u, 999u, 1024u, 1500u, 2999u}) {
        EXPECT_EQ(recording.tickAt(recording.secondsOf(tick) + 1e-9), tick);
        EXPECT_NEAR(recording.secondsOf(tick), double(tick) * 1e-3, 1e-4);
    }
    EXPECT_EQ(recording.tickAt(1e6), 2999u);
    EXPECT_EQ(recording.tickAt(-1), 0u);
}

TEST_F(RerunTest, ATornRecordingIsReadUpToThere) {
    const std::filesystem::path torn = folder_->path() / "torn.mcap";
    const auto whole = std::filesystem::file_size(session_->journal);
    int partly = 0;
    uint64_t last = 0;
    for (int part = 1; part < 20; ++part) {
        std::filesystem::copy_file(session_->journal, torn,
                                   std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(torn, whole * uint64_t(part) / 20);
        try {
            const Recording recording(torn);
            EXPECT_FALSE(recording.content().problem.empty());
            EXPECT_GE(recording.ticks(), last);
            last = recording.ticks();
            partly += recording.ticks() < 3000;
        } catch (const UserError&) {
            EXPECT_EQ(last, 0u) << "no tick is whole yet";
        }
    }
    EXPECT_GT(partly, 0);
}

TEST_F(RerunTest, WhatIsNoRecordingIsRefused) {
    const std::filesystem::path other = folder_->path() / "other.mcap";
    std::ofstream(other) << "no journal";
    EXPECT_THROW(Recording{other}, UserError);
    EXPECT_THROW(Recording{folder_->path() / "missing.mcap"}, UserError);
}

}  // namespace
}  // namespace bonemill
