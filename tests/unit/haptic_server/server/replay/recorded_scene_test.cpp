#include <gtest/gtest.h>

#include <fstream>

#include "common/base/user_error.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "tests/support/recorded_session.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

class RecordedScene : public testing::Test {
  protected:
    std::string refusal() const {
        try {
            const Recording recording(session_.journal);
            const SceneSetup simulation = setUpScene(recording.scene());
            recording.readBones(*simulation.bone);
        } catch (const UserError& error) {
            return error.what();
        }
        return "";
    }
    template <class Message>
    void change(JournalTopic topic, const std::function<void(Message&)>& how) {
        std::vector<test::JournalMessage> messages = test::journalMessages(session_.journal);
        for (test::JournalMessage& message : messages) {
            if (message.topic != topic) continue;
            auto parsed = message.as<Message>();
            how(parsed);
            message.data = parsed.SerializeAsString();
        }
        test::writeJournal(session_.journal, messages, true);
    }

    test::TemporaryFolder folder_;
    const test::RecordedSession session_ = test::recordSession(folder_.path());
};

TEST_F(RecordedScene, IsTakenWhereItsFilesAreTheSame) {
    EXPECT_EQ(refusal(), "");
    std::ofstream(folder_ / "slab.nrrd", std::ios::app) << 'x';
    EXPECT_NE(refusal().find("slab.nrrd is another file now"), std::string::npos) << refusal();
}

TEST_F(RecordedScene, AJournalReadsNothingThatItsSessionDidNotRead) {
    std::filesystem::copy_file(folder_ / "slab.nrrd", folder_ / "secret.nrrd");
    change<journal::Manifest>(JournalTopic::kManifest, [](journal::Manifest& manifest) {
        std::string& text = *manifest.mutable_scene_text();
        text.replace(text.find("slab.nrrd"), 4, "secret");
    });
    EXPECT_NE(refusal().find("secret.nrrd, which the session did not read"), std::string::npos) << refusal();
}

TEST_F(RecordedScene, ABoneThatIsNotThereIsNotTheScans) {
    change<journal::Bone>(JournalTopic::kBone, [](journal::Bone& bone) { bone.clear_checkpoint(); });
    EXPECT_NE(refusal().find("puts the bone back to checkpoint 1, which is not in the journal"),
              std::string::npos)
        << refusal();
    change<journal::PutBack>(JournalTopic::kPutBack,
                             [](journal::PutBack& order) { order.set_bone_order(order.bone_order() + 99); });
    EXPECT_NE(refusal().find("what the journal does not say"), std::string::npos) << refusal();
}

TEST_F(RecordedScene, ItsBonesTakeNoMoreMemoryThanTheyMay) {
    const Recording recording(session_.journal);
    const SceneSetup simulation = setUpScene(recording.scene());
    EXPECT_NO_THROW(recording.readBones(*simulation.bone, 1'000'000));
    EXPECT_THROW(recording.readBones(*simulation.bone, 1'000), UserError);
}

TEST_F(RecordedScene, NobodyGoesOnWithAnotherVolume) {
    const Recording recording(session_.journal);
    const LoadedScene scene = recording.scene();
    const SceneSetup simulation = setUpScene(scene);
    EXPECT_NO_THROW(momentOf(recording, simulation, scene, 0.5));
    std::ofstream(folder_ / "slab.nrrd", std::ios::app) << 'x';
    EXPECT_THROW(momentOf(recording, simulation, scene, 0.5), UserError);
}

}  // namespace
}  // namespace bonemill
