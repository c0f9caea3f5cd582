#include "haptic_server/recording/journal/journal.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "common/base/user_error.h"
#include "common/mcap/mcap_repair.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/recording/journal/recorded_session.h"

namespace bonemill {
namespace {

std::string bytesOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

class JournalTest : public testing::Test {
  protected:
    JournalConfig config(const std::string& name = "j.mcap") const {
        JournalConfig config;
        config.path = folder_ / name;
        config.manifest.set_session(7);
        config.manifest.set_rate_hz(1000);
        config.manifest.set_scene_text("name: \"ball\"");
        return config;
    }
    DensitiesAsScanned scanned() const { return {ball_.history.scanned(), ball_.bone.lattice}; }
    std::vector<TickRecord> record(const JournalConfig& config) {
        Journal journal(config, scanned());
        auto records = test::recordSession(journal, ball_);
        EXPECT_EQ(journal.problem(), "");
        journal.finish();
        return records;
    }

    test::TemporaryFolder folder_;
    test::MilledBall ball_;
};

TEST_F(JournalTest, HasFarFewerSchemasThanAreRead) {
    record(config());
    const mcap::Reading reading = readJournal(folder_ / "j.mcap", [](JournalTopic, const auto&) {});
    EXPECT_LT(reading.index.recordBytes(), mcap::kMaxRecordBytes / 2);
    RecordProperty("bytes", int(reading.index.recordBytes()));
}

TEST_F(JournalTest, TellsWhatTheSessionTold) {
    const auto records = record(config());
    BoneStateReader bones(scanned());
    int checkpoints = 0;
    const JournalContent content = readJournalContent(
        folder_ / "j.mcap", KeepInputs::kYes, [&](JournalTopic topic, const auto& message) {
            if (topic != JournalTopic::kBone) return;
            journal::Bone bone;
            ASSERT_TRUE(bone.ParseFromArray(message.data.data(), int(message.data.size())));
            ASSERT_TRUE(bones.add(bone));
            checkpoints += bone.checkpoint() == 3;
        });
    EXPECT_EQ(content.problem, "");
    EXPECT_TRUE(content.has_ended);
    EXPECT_EQ(content.incomplete, "");
    EXPECT_EQ(content.manifest.session(), 7u);
    EXPECT_EQ(content.ticks, records.size());
    EXPECT_EQ(content.hashes.size(), 2u);
    EXPECT_EQ(content.put_backs, (std::map<uint64_t, uint32_t>{{1, 3}}));
    EXPECT_EQ(checkpoints, 1);
    std::vector<JournalTick> ticks;
    for (const journal::Inputs& inputs : content.inputs) ASSERT_TRUE(decodeInputs(inputs, ticks));
    TickHash hash;
    for (size_t n = 0; n < records.size(); ++n) {
        hash.add(records[n]);
        ASSERT_EQ(ticks[n].check, hash.check());
        ASSERT_EQ(ticks[n].input.p_WT[0], records[n].input.p_WT[0]);
        ASSERT_EQ(ticks[n].start_ns, records[n].start_ns - records[0].start_ns);
    }
    ASSERT_TRUE(bones.state());
    EXPECT_FALSE(bones.state()->leaves.empty());
}

// Cut anywhere, it is read up to the last whole chunk, and mended.
TEST_F(JournalTest, ATornEndCostsNoMoreThanWhatIsTorn) {
    const auto records = record(config());
    const std::string bytes = bytesOf(folder_ / "j.mcap");
    std::mt19937 random(11);
    uint64_t most = 0;
    for (int cut = 0; cut < 40; ++cut) {
        const std::string torn = folder_ / "torn.mcap";
        const size_t size = 60'000 + random() % (bytes.size() - 60'000);
        std::ofstream(torn, std::ios::binary) << bytes.substr(0, size);
        const JournalContent before = readJournalContent(torn, KeepInputs::kNo);
        EXPECT_NE(before.problem, "");
        EXPECT_FALSE(before.has_ended && before.ticks < records.size());
        mcap::repair(torn);
        const JournalContent mended = readJournalContent(torn, KeepInputs::kNo);
        EXPECT_EQ(mended.problem, "");
        EXPECT_EQ(mended.ticks, before.ticks);
        most = std::max(most, mended.ticks);
    }
    EXPECT_GT(most, 100u);
}

TEST_F(JournalTest, LostTicksAreSaidFromWhichOnOn) {
    {
        Journal journal(config(), scanned());
        for (const TickRecord& record : test::recordedTicks(300))
            if (record.tick < 100 || record.tick >= 120) journal.add(record);
        EXPECT_NE(journal.problem().find("20 ticks"), std::string::npos) << journal.problem();
        journal.finish();
    }
    const JournalContent content = readJournalContent(folder_ / "j.mcap", KeepInputs::kYes);
    EXPECT_EQ(content.ticks, 100u);
    EXPECT_EQ(content.incomplete_from, 100u);
    EXPECT_NE(content.incomplete, "");
    EXPECT_EQ(content.inputs.back().first_tick() + content.inputs.back().count(), 300u);
}

// What comes more is recorded for people; the input of the hand has a budget of 0.15 GB/h at 1 kHz, 41.6
// bytes per tick.
TEST_F(JournalTest, ATicksInputIsSmall) {
    const auto size = [&](size_t ticks) {
        const std::string name = std::to_string(ticks);
        Journal journal(config(name), scanned());
        for (const TickRecord& record : test::recordedTicks(ticks)) {
            journal.add(record);
            if (record.tick % 200 == 199) journal.flush();
        }
        journal.finish();
        return double(bytesOf(folder_ / name).size());
    };
    const double per_tick = (size(12'000) - size(2'000)) / 10'000;
    RecordProperty("bytes_per_tick", std::to_string(per_tick));
    std::cout << per_tick << " bytes per tick\n";
    EXPECT_LT(per_tick, 60) << "with poses and forces for viewers, and their index";
    EXPECT_GT(per_tick, 20);
}

TEST_F(JournalTest, WhatIsNoJournalIsRefused) {
    std::ofstream(folder_ / "no.mcap") << "nothing of the kind";
    EXPECT_THROW(readJournalContent(folder_ / "no.mcap", KeepInputs::kNo), UserError);
    EXPECT_THROW(readJournalContent(folder_ / "missing.mcap", KeepInputs::kNo), UserError);
    mcap::Writer other("another", "tool");
    other.finish();
    std::ofstream(folder_ / "other.mcap", std::ios::binary) << other.take();
    EXPECT_THROW(readJournalContent(folder_ / "other.mcap", KeepInputs::kNo), UserError);
}

TEST_F(JournalTest, ANewerFormatIsRefused) {
    mcap::Writer writer(kJournalProfile, "newer");
    writer.addChannel({uint16_t(JournalTopic::kManifest), 0, "/manifest", "protobuf"});
    journal::Manifest manifest;
    manifest.set_format(kJournalFormat + 1);
    manifest.set_rate_hz(1000);
    writer.addMessage(uint16_t(JournalTopic::kManifest), 1, manifest.SerializeAsString());
    writer.finish();
    std::ofstream(folder_ / "newer.mcap", std::ios::binary) << writer.take();
    try {
        readJournalContent(folder_ / "newer.mcap", KeepInputs::kNo);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("newer"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace bonemill
