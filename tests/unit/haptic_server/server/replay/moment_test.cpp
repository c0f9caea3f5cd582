#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

TEST(MomentName, IsAFileAndSeconds) {
    const MomentName name = momentNameOf("a/b@c.mcap@95.5");
    EXPECT_EQ(name.journal, "a/b@c.mcap");
    EXPECT_EQ(name.seconds, 95.5);
    for (const char* text :
         {"", "a.mcap", "a.mcap@", "@5", "a.mcap@soon", "a.mcap@-1", "a.mcap@5s", "a.mcap@nan"})
        EXPECT_THROW(momentNameOf(text), UserError) << text;
}

uint64_t hashOf(const BoneModel& bone) {
    StateHash hash;
    hash.addVolume(bone.volume);
    return hash.value();
}

TEST(Moment, IsTheBoneOfThatTickAndTheScansBoneStaysAsItIs) {
    const test::TemporaryFolder folder;
    const test::RecordedSession session = test::recordSession(folder.path());
    const Recording recording(session.journal);
    const LoadedScene scene = recording.scene();
    const SceneSetup simulation = setUpScene(scene);
    const uint64_t scanned = hashOf(*simulation.bone);
    const RecordedMoment moment = momentOf(recording, simulation, scene, 0.9);
    const uint64_t tick = recording.tickAt(0.9);
    EXPECT_EQ(moment.from.tick(), tick + 1);
    EXPECT_EQ(moment.from.journal_id(), recording.manifest().journal_id());
    EXPECT_EQ(moment.bone->missing_voxels, session.missing_voxels[tick]);
    EXPECT_EQ(moment.tool, 0u);
    const RecordedMoment later = momentOf(recording, simulation, scene, 1.7);
    EXPECT_EQ(later.tool, 1u) << "another tool was in the hand then";
    EXPECT_NEAR(double(later.bone->missing_voxels), double(session.missing_voxels[recording.tickAt(1.7)]),
                0.02 * double(later.bone->missing_voxels));
    EXPECT_EQ(hashOf(*simulation.bone), scanned);
    EXPECT_THROW(momentOf(recording, simulation, scene, 100), UserError) << "it ends before";
    LoadedScene other = scene;
    other.scene.mutable_loop()->set_rate_hz(500);
    EXPECT_THROW(momentOf(recording, simulation, other, 0.9), UserError);
}

}  // namespace
}  // namespace bonemill
