#include "haptic_server/server/session/resume.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/user_error.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/recorded_session.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using test::JournalMessage;

class Resume : public testing::Test {
  protected:
    // Another journal of session 1 in the folder, newer than those before.
    void write(const std::string& name, const std::vector<JournalMessage>& messages, bool has_end) {
        const std::filesystem::path path = folder_ / name;
        test::writeJournal(path, messages, has_end);
        std::filesystem::last_write_time(
            path, std::filesystem::file_time_type::clock::now() + std::chrono::seconds(++written_));
    }
    std::string found() const {
        const auto unfinished = findUnfinished(folder_.path(), 1);
        return unfinished ? unfinished->path.filename().string() : "";
    }
    ResumedSession resumed() const {
        const SceneSetup simulation = setUpScene(loadScene(session_.scene));
        return ResumeReading(findUnfinished(folder_.path(), 1).value()).take(*simulation.bone);
    }
    // Up to the newest bone that is milled, and that too.
    std::vector<JournalMessage> upToBone() const {
        std::vector<JournalMessage> messages = messages_;
        while (messages.back().topic != JournalTopic::kBone ||
               messages.back().as<journal::Bone>().kind() == journal::Bone::OTHER)
            messages.pop_back();
        return messages;
    }

    test::TemporaryFolder folder_;
    const test::RecordedSession session_ =
        test::recordSession(folder_.path(), {.ticks = 1700, .has_end = false});
    const std::vector<JournalMessage> messages_ = test::journalMessages(session_.journal);
    int written_ = 0;
};

TEST_F(Resume, FindsTheNewestThatHoldsSomething) {
    EXPECT_EQ(found(), "") << "session.mcap is of no session's name";
    write("1_a.mcap", messages_, false);
    EXPECT_EQ(found(), "1_a.mcap");
    EXPECT_FALSE(findUnfinished(folder_.path(), 2));
    const std::vector<JournalMessage> nothing{messages_.front()};
    ASSERT_EQ(nothing.front().topic, JournalTopic::kManifest);
    write("1_b.mcap", nothing, true);
    write("1_c.mcap", nothing, false);
    EXPECT_EQ(found(), "1_a.mcap") << "nobody milled in those since";
    auto goes_on = nothing;
    auto manifest = goes_on.front().as<journal::Manifest>();
    manifest.mutable_resumed_from()->set_tick(1);
    goes_on.front().data = manifest.SerializeAsString();
    write("1_d.mcap", goes_on, true);
    EXPECT_EQ(found(), "") << "it went on, and was ended in order";
    write("1_e.mcap", messages_, false);
    EXPECT_EQ(found(), "1_e.mcap");
    write("1_f.mcap", messages_, true);
    EXPECT_EQ(found(), "") << "what came after was ended in order";
}

TEST_F(Resume, WhatWasDamagedIsKeptSaidAndFoundNoMore) {
    write("1_a.mcap", messages_, false);
    const std::string path = folder_ / "1_a.mcap";
    const auto size = std::filesystem::file_size(path);
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).seekp(3000).put('?').put('!');
    const std::string said = closeResumed(path);
    EXPECT_NE(said.find("it is kept as 1_a.damaged.mcap"), std::string::npos) << said;
    EXPECT_EQ(std::filesystem::file_size(folder_ / "1_a.damaged.mcap"), size);
    EXPECT_EQ(found(), "");
}

TEST_F(Resume, GoesOnWithBoneCheckpointsAndTool) {
    write("1_a.mcap", messages_, false);
    const ResumedSession session = resumed();
    EXPECT_EQ(session.from.tick(), 1500u) << "a state each 500 ticks";
    EXPECT_EQ(session.bone->missing_voxels, session_.missing_voxels[1499]);
    ASSERT_EQ(session.checkpoints.size(), 1u);
    EXPECT_EQ(session.checkpoints[0].state->missing_voxels, session_.missing_voxels[999]);
    EXPECT_EQ(session.tool, 1u);
    EXPECT_EQ(session.from.segment(), 1u);
}

TEST_F(Resume, AnOrderThatNoTickTookUpChangesNothing) {
    std::vector<JournalMessage> messages = messages_;
    journal::PutBack order;
    order.set_bone_order(1000);
    messages.push_back({JournalTopic::kPutBack, messages.back().time_ns, order.SerializeAsString()});
    write("1_a.mcap", messages, false);
    EXPECT_EQ(resumed().bone->missing_voxels, session_.missing_voxels[1499]);
}

TEST_F(Resume, APartOfAKeyReplacesNothing) {
    std::vector<JournalMessage> messages = upToBone();
    auto part = messages.back().as<journal::Bone>();
    part.set_kind(journal::Bone::KEY);
    part.set_goes_on(true);
    part.set_tick(part.tick() + 100);
    messages.push_back({JournalTopic::kBone, messages.back().time_ns, part.SerializeAsString()});
    write("1_a.mcap", messages, false);
    const ResumedSession session = resumed();
    EXPECT_EQ(session.from.tick(), 1500u);
    EXPECT_EQ(session.bone->missing_voxels, session_.missing_voxels[1499]);
}

}  // namespace
}  // namespace bonemill
