// Reads the launcher's list of attempts, and waits for the end of one.
#include "render_client/hand/controls/past_attempts.h"

#include <gtest/gtest.h>

#include "tests/support/process.h"

namespace bonemill {
namespace {

TEST(PastAttempts, AreReadFromTheLaunchersLines) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "b.png", "picture");
    const std::string stem = folder / "b";
    const auto attempts = pastAttemptsOf("/a.json\t\t2026-11-20 11:36\tPedicle\tP07\texamination\n" + stem +
                                         ".json\t/r.mcap\t2026-11-19 10:00\tTooth\tP08\tscore 81 of 100\n"
                                         "no fields\n\t\t\t\t\t\n.json\t\t\t\t\t\n");
    ASSERT_EQ(attempts.size(), 2u);
    EXPECT_EQ(attempts[0].stem, "/a");
    EXPECT_EQ(attempts[0].recording, "");
    EXPECT_EQ(attempts[0].score, "examination");
    EXPECT_EQ(attempts[0].picture, "");
    EXPECT_EQ(attempts[1].stem, stem);
    EXPECT_EQ(attempts[1].recording, "/r.mcap");
    EXPECT_EQ(attempts[1].start, "2026-11-19 10:00");
    EXPECT_EQ(attempts[1].scene, "Tooth");
    EXPECT_EQ(attempts[1].trainee, "P08");
    EXPECT_EQ(attempts[1].picture, "picture");
    EXPECT_TRUE(pastAttemptsOf("").empty());
}

TEST(PastAttempts, CanBeComparedWhereTheyAreOthers) {
    const auto attempt = [](const std::string& recording) {
        PastAttempt made;
        made.recording = recording;
        return made;
    };
    std::vector<PastAttempt> listed{attempt("/r/b.mcap"), attempt(""), attempt("/r/a.mcap")};
    SessionView session;
    EXPECT_TRUE(comparableAttempts(session).empty());
    session.same_scene = &listed;
    session.recording = "/linked/a.mcap";
    ASSERT_EQ(comparableAttempts(session).size(), 1u);
    EXPECT_EQ(comparableAttempts(session)[0], &listed[0]);
    listed.push_back(attempt("/r/a.mcap"));
    EXPECT_EQ(comparableAttempts(session).size(), 3u) << "the recording holds two";
}

class AttemptEnding : public testing::Test {
  protected:
    AttemptEnding() {
        session_.lesson = &lesson_;
        session_.class_folder = "/class";
        session_.is_complete = true;
    }
    void add(const std::string& results) { lesson_.add_attempts()->mutable_verdict()->set_results(results); }

    topics::Lesson lesson_;
    SessionView session_;
    AttemptEnds ends_;
};

TEST_F(AttemptEnding, IsToldOnce) {
    add("before");
    EXPECT_EQ(ends_.take(session_), "") << "it was there before this viewer";
    lesson_.set_is_running(true);
    EXPECT_EQ(ends_.take(session_), "");
    lesson_.set_is_running(false);
    EXPECT_EQ(ends_.take(session_), "");
    add("new");
    session_.is_complete = false;
    EXPECT_EQ(ends_.take(session_), "") << "the bone is not on the screen yet";
    session_.is_complete = true;
    EXPECT_EQ(ends_.take(session_), "/class/results/new");
    EXPECT_EQ(ends_.take(session_), "");
}

TEST_F(AttemptEnding, IsOfNoUseOnceTheNextOneRuns) {
    EXPECT_EQ(ends_.take(session_), "");
    add("first");
    lesson_.set_is_running(true);
    EXPECT_EQ(ends_.take(session_), "") << "the bone has been put back";
    lesson_.set_is_running(false);
    add("second");
    EXPECT_EQ(ends_.take(session_), "/class/results/second");
}

TEST_F(AttemptEnding, LeavesNothingElsewhere) {
    EXPECT_EQ(ends_.take(session_), "");
    add("../../elsewhere");
    EXPECT_EQ(ends_.take(session_), "");
    session_.class_folder.clear();
    add("new");
    EXPECT_EQ(ends_.take(session_), "");
}

}  // namespace
}  // namespace bonemill
