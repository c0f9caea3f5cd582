// Chunks with right CRCs and messages of anybody's: what is in a journal is read or refused, whatever it is.
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "common/base/user_error.h"
#include "common/mcap/mcap_writer.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "tests/support/mutated_bytes.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/recording/journal/recorded_ticks.h"

namespace bonemill {
namespace {

std::string goodMessage(JournalTopic topic, uint64_t first_tick) {
    if (topic == JournalTopic::kManifest) {
        journal::Manifest manifest;
        manifest.set_format(kJournalFormat);
        manifest.set_rate_hz(1000);
        return manifest.SerializeAsString();
    }
    if (topic == JournalTopic::kInputs) {
        std::vector<JournalTick> ticks;
        for (const TickRecord& record : test::recordedTicks(20)) ticks.push_back(journalTickOf(record, 0, 0));
        for (JournalTick& tick : ticks) tick.tick += first_tick;
        journal::Inputs inputs;
        encodeInputs(ticks, inputs);
        return inputs.SerializeAsString();
    }
    journal::Event event;
    event.set_tick(first_tick);
    event.mutable_incomplete()->set_why("test");
    return event.SerializeAsString();
}

TEST(JournalFuzz, AnyMessagesAreReadOrRefused) {
    const test::TemporaryFolder folder;
    std::mt19937 random(17);
    int read = 0, refused = 0;
    for (int round = 0; round < 2000; ++round) {
        mcap::Writer writer(kJournalProfile, "bonemill hostile");
        for (const JournalTopicName& topic : kJournalTopics)
            writer.addChannel({uint16_t(topic.topic), 0, std::string(topic.name), "protobuf"});
        const auto bytes = [&](JournalTopic topic, uint64_t tick) {
            const std::string good = goodMessage(topic, tick);
            return random() % 6 == 0 ? test::mutated(good, random) : good;
        };
        writer.addMessage(uint16_t(JournalTopic::kManifest), 1, bytes(JournalTopic::kManifest, 0));
        for (uint64_t n = 0; n < 5; ++n) {
            writer.addMessage(uint16_t(JournalTopic::kInputs), n, bytes(JournalTopic::kInputs, 20 * n));
            const auto topic = uint16_t(1 + random() % kJournalTopics.size());
            writer.addMessage(topic, n, bytes(JournalTopic::kEvent, n));
        }
        writer.finish();
        const std::string path = folder / "j.mcap";
        std::ofstream(path, std::ios::binary) << writer.take();
        try {
            const JournalContent content = readJournalContent(path, KeepInputs::kYes);
            EXPECT_LE(content.ticks, 5 * kMaxTicksPerInputs);
            for (const journal::Inputs& inputs : content.inputs) {
                std::vector<JournalTick> ticks;
                decodeInputs(inputs, ticks);
                EXPECT_LE(ticks.size(), kMaxTicksPerInputs);
            }
            ++read;
        } catch (const UserError&) {
            ++refused;
        }
    }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace bonemill
