#include "haptic_server/lab/assess/assess_journal.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/user_error.h"
#include "haptic_server/recording/journal/input_columns.h"
#include "tests/support/recorded_session.h"
#include "tests/support/rewritten_journal.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

using test::JournalMessage;

// So long a tick is on the way to the bone that it was ordered, s.
constexpr double kRestoring = 0.02;

class AssessJournal : public testing::Test {
  protected:
    // An attempt by ada, from this tick on, whose bone is put back by the order.
    void addAttempt(uint64_t begin, uint64_t end, uint64_t bone_order, bool is_dropped = false) {
        journal::Event began, ended;
        began.set_tick(begin), began.set_attempt_began("ada"), began.set_bone_order(bone_order);
        ended.set_tick(end), ended.mutable_attempt_ended()->set_time_s(double(end - begin) * 1e-3);
        if (is_dropped) ended.mutable_attempt_dropped();
        const auto isEnd = [](const JournalMessage& message) {
            return message.topic == JournalTopic::kEvent && message.as<journal::Event>().has_end();
        };
        for (const journal::Event& event : {began, ended})
            messages_.insert(std::ranges::find_if(messages_, isEnd),
                             {JournalTopic::kEvent, 0, event.SerializeAsString()});
    }
    // Every order has twice its number: as if each were merged with one that no tick took up.
    void doubleOrders() {
        for (JournalMessage& message : messages_) {
            if (message.topic == JournalTopic::kPutBack) {
                auto order = message.as<journal::PutBack>();
                order.set_bone_order(2 * order.bone_order());
                message.data = order.SerializeAsString();
            }
            if (message.topic != JournalTopic::kInputs) continue;
            auto inputs = message.as<journal::Inputs>();
            for (auto& value : *inputs.mutable_bone_order()->mutable_values()) value *= 2;
            message.data = inputs.SerializeAsString();
        }
    }
    // Of the ticks that were judged.
    static double secondsOf(const nlohmann::json& result) {
        double seconds = 0;
        const nlohmann::json& columns = result.at("series").at(0).at("columns");
        for (const nlohmann::json& value : columns.at(0).at("values")) seconds += value.get<double>();
        return seconds;
    }
    // The results, by attempt.
    std::vector<nlohmann::json> assessed() {
        const std::string out = folder_ / "out";
        std::filesystem::remove_all(out);
        test::writeJournal(folder_ / "attempts.mcap", messages_, true);
        std::ostringstream said;
        EXPECT_EQ(assessJournal({.journal = folder_ / "attempts.mcap", .out = out}, said), 0) << said.str();
        std::vector<nlohmann::json> results;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(out))
            if (entry.path().extension() == ".json") {
                std::ifstream file(entry.path());
                results.push_back(nlohmann::json::parse(file));
            }
        std::ranges::sort(results, {},
                          [](const auto& json) { return json.at("attempt").template get<int>(); });
        return results;
    }

    test::TemporaryFolder folder_;
    const test::RecordedSession session_ = test::recordSession(folder_.path());
    std::vector<JournalMessage> messages_ = test::journalMessages(session_.journal);
};

TEST_F(AssessJournal, WithoutAttemptsIsRefused) {
    std::ostringstream said;
    EXPECT_THROW(assessJournal({.journal = session_.journal, .out = folder_ / "out"}, said), UserError);
}

TEST_F(AssessJournal, AnAttemptBeginsWhenATickTookItsOrderUp) {
    addAttempt(test::kTickOfReset - 100, 2600, 1);
    const auto results = assessed();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].at("pseudonym"), "ada");
    EXPECT_NEAR(secondsOf(results[0]), 0.8, kRestoring) << "not from the tick of the event on";
}

TEST_F(AssessJournal, AnOrderThatWasMergedWithALaterOneBeginsWithThat) {
    doubleOrders();
    addAttempt(test::kTickOfReset - 100, 2600, 1);
    const auto results = assessed();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_NEAR(secondsOf(results[0]), 0.8, kRestoring);
}

TEST_F(AssessJournal, AnOrderThatNoTickTookUpIsAnAttemptOfNothing) {
    addAttempt(test::kTickOfReset - 100, 2600, 99);
    addAttempt(test::kTickOfRestore - 50, 2900, 2);
    const auto results = assessed();
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(secondsOf(results[0]), 0);
    EXPECT_NEAR(secondsOf(results[1]), 0.2, kRestoring) << "the next one is whole";
}

TEST_F(AssessJournal, AnAttemptThatWasDroppedHasNoResultAndNoNumber) {
    addAttempt(test::kTickOfReset - 100, 2600, 1);
    addAttempt(test::kTickOfRestore - 50, 2700, 2, true);
    auto results = assessed();
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].at("attempt"), 1);
    addAttempt(2750, 2900, 2);
    results = assessed();
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[1].at("attempt"), 2);
}

}  // namespace
}  // namespace bonemill
