#include "haptic_server/teaching/lessons/forget_person.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"
#include "haptic_server/teaching/lessons/class_table.h"
#include "tests/support/process.h"
#include "tests/support/rewritten_journal.h"

namespace bonemill {
namespace {

class ForgetPerson : public testing::Test {
  protected:
    // An attempt with its line, its results and the recording that it is in.
    void attempt(const std::string& pseudonym, uint32_t number, const std::string& journal) {
        topics::Attempt line;
        line.set_number(number);
        line.set_trainee(pseudonym);
        ASSERT_EQ(ClassTable(folder_ / "class.csv").append(line, "scene"), "");
        AttemptResult result;
        result.pseudonym = pseudonym;
        result.number = number;
        result.start_unix_ns = 1'700'000'000'000'000'000;
        result.journal = journal;
        ResultFolder(folder_ / ".").write(result, {}, 0);
        record(journal, pseudonym);
    }
    // An attempt more in a recording.
    void record(const std::string& name, const std::string& pseudonym) {
        journal::Manifest manifest;
        manifest.set_format(kJournalFormat);
        manifest.set_rate_hz(1000);
        journal::Event event;
        event.set_attempt_began(pseudonym);
        auto& messages = recordings_[name];
        if (messages.empty()) messages.push_back({JournalTopic::kManifest, 1, manifest.SerializeAsString()});
        messages.push_back({JournalTopic::kEvent, 2, event.SerializeAsString()});
        test::writeJournal(folder_ / name, messages, true);
    }
    int forget(const std::string& pseudonym) {
        out_.str("");
        return forgetPerson({pseudonym, folder_ / ".", ""}, out_);
    }

    const test::TemporaryFolder folder_;
    std::map<std::string, std::vector<test::JournalMessage>> recordings_;
    std::ostringstream out_;
};

TEST_F(ForgetPerson, AllOfThemIsDeletedAndSaid) {
    attempt("P07", 1, "a.mcap");
    attempt("P08", 2, "b.mcap");
    EXPECT_EQ(forget("P07"), 0);
    for (const char* what :
         {"class.csv: 1 lines", "_P07_1.json", "_P07_1.html", "xapi.jsonl: 1 statements", "a.mcap"})
        EXPECT_NE(out_.str().find(what), std::string::npos) << what << out_.str();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.mcap"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "b.mcap"));
    EXPECT_EQ(forget("P07"), 0);
    EXPECT_EQ(out_.str().rfind("there is nothing of 'P07'", 0), 0u) << out_.str();
}

TEST_F(ForgetPerson, ARecordingOfSeveralPeopleIsLeftAndSaid) {
    attempt("P07", 1, "a.mcap");
    attempt("P08", 2, "a.mcap");
    EXPECT_EQ(forget("P07"), 1);
    EXPECT_NE(out_.str().find("a.mcap: holds other people's attempts"), std::string::npos) << out_.str();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.mcap"));
    EXPECT_EQ(forget("P08"), 1) << "P07's attempt is still in it";
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.mcap"));
}

TEST_F(ForgetPerson, WhatMightHaveBeenGoesWithItsPages) {
    std::filesystem::create_directory(folder_ / "what_if");
    for (const auto& [name, whose] : {std::pair("a", "P07"), std::pair("b", "P08")}) {
        record(std::string("what_if/") + name + ".mcap", whose);
        for (const char* ending : {".html", ".json"})
            std::ofstream(folder_ / (std::string("what_if/") + name + ending)) << "P07";
    }
    forget("P07");
    for (const char* ending : {".mcap", ".html", ".json"}) {
        EXPECT_FALSE(std::filesystem::exists(folder_ / (std::string("what_if/a") + ending)));
        EXPECT_TRUE(std::filesystem::exists(folder_ / (std::string("what_if/b") + ending)));
    }
}

TEST_F(ForgetPerson, ARecordingWithoutAResultIsFoundAndALinkIsNotFollowed) {
    const test::TemporaryFolder elsewhere;
    record("killed.mcap", "P07");
    std::filesystem::copy(folder_ / "killed.mcap", elsewhere / "x.mcap");
    std::filesystem::create_symlink(elsewhere / "x.mcap", folder_ / "link.mcap");
    EXPECT_EQ(forget("P07"), 0) << out_.str();
    EXPECT_FALSE(std::filesystem::exists(folder_ / "killed.mcap"));
    EXPECT_TRUE(std::filesystem::exists(elsewhere / "x.mcap"));
}

TEST_F(ForgetPerson, WhoseARecordingIsMayNotBeReadable) {
    test::writeFile(folder_ / "a.mcap", "damaged");
    EXPECT_EQ(forget("P07"), 1);
    EXPECT_NE(out_.str().find("a.mcap: whose it is cannot be read"), std::string::npos) << out_.str();
}

TEST_F(ForgetPerson, ARecordingThatIsBeingWrittenIsLeftAndSaid) {
    record("a.mcap", "P07");
    const int writer = open((folder_ / "a.mcap").c_str(), O_RDONLY);
    ASSERT_EQ(flock(writer, LOCK_EX), 0);
    EXPECT_EQ(forget("P07"), 1);
    EXPECT_NE(out_.str().find("a.mcap: is being written"), std::string::npos) << out_.str();
    EXPECT_TRUE(std::filesystem::exists(folder_ / "a.mcap"));
    close(writer);
    EXPECT_EQ(forget("P07"), 0);
}

TEST_F(ForgetPerson, ATableThatIsLockedIsAProblemAndAnotherFileNone) {
    attempt("P07", 1, "a.mcap");
    test::writeFile(folder_ / "grades.csv", "grades of 2026\n");
    const int other = open((folder_ / "class.csv").c_str(), O_RDONLY);
    ASSERT_EQ(flock(other, LOCK_EX), 0);
    EXPECT_EQ(forget("P07"), 1);
    EXPECT_NE(out_.str().find("class.csv: cannot be written: another program"), std::string::npos)
        << out_.str();
    close(other);
    EXPECT_EQ(forget("P07"), 0) << out_.str();
}

TEST_F(ForgetPerson, AFolderThatIsNoneIsRefused) {
    EXPECT_THROW(forgetPerson({"P07", folder_ / "nowhere", ""}, out_), UserError);
    EXPECT_THROW(forgetPerson({"P07", folder_ / ".", folder_ / "nowhere"}, out_), UserError);
    EXPECT_THROW(forgetPerson({"", folder_ / ".", ""}, out_), UserError);
}

}  // namespace
}  // namespace bonemill
