// Asks tests/support/room_tests which tests belong to a room or to a changed file of a small tree.
#include <gtest/gtest.h>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;

// The rooms are a ground of headers, one with tests of two kinds, one that only others' tests link,
// and a schema.
constexpr const char* kRooms =
    "room ground common\n"
    "room rt common/rt\n"
    "room milling haptic_server/core/milling\n"
    "room telemetry haptic_server/core/telemetry\n"
    "room topics_proto proto/topics.proto topics_tests\n"
    "test rt_tests tests/unit/common/rt unit bonemill::rt,bonemill::ground\n"
    "test milling_tests tests/unit/haptic_server/core/milling unit bonemill::milling,bonemill::telemetry\n"
    "test milling_properties tests/property/milling property bonemill::milling\n"
    "test milling_integration tests/integration/milling integration bonemill::milling\n"
    "test topics_tests tests/integration/dds integration bonemill::topics_proto\n";

class RoomTests : public testing::Test {
  protected:
    RoomTests() { test::writeFile(build_ / "rooms.txt", kRooms); }
    Finished ask(std::vector<std::string> words) {
        words.insert(words.begin(), {test::sourceDir() + "/tests/support/room_tests", build_.path()});
        return test::run(words);
    }
    void expectTests(const std::vector<std::string>& words, const std::string& tests) {
        const Finished answer = ask(words);
        EXPECT_EQ(answer.exit_code, 0) << words.back();
        EXPECT_EQ(answer.out, tests) << words.back();
    }

    test::TemporaryFolder build_;
};

TEST_F(RoomTests, ARoomHasItsQuickTests) {
    expectTests({"milling"}, "milling_properties\nmilling_tests\n");
    expectTests({"haptic_server/core/milling/"}, "milling_properties\nmilling_tests\n");
    expectTests({"telemetry"}, "milling_tests\n");
    expectTests({"rt", "topics_proto"}, "rt_tests\ntopics_tests\n");
}

TEST_F(RoomTests, AChangedFileHasTheTestsOfItsRoom) {
    expectTests({"--changed", "haptic_server/core/milling/burr_limit.cpp"},
                "milling_properties\nmilling_tests\n");
    expectTests({"--changed", "common/base/units.h"}, "rt_tests\n");
    expectTests({"--changed", "proto/topics.proto", "README.md"}, "topics_tests\n");
}

TEST_F(RoomTests, AChangedTestIsRunWhateverItsLabel) {
    expectTests({"--changed", "tests/integration/milling/milling_test.cpp"}, "milling_integration\n");
}

TEST_F(RoomTests, CodeWithoutATestIsAFailureAndDocumentsAreNot) {
    const Finished code = ask({"--changed", "render_client/apps/render_client/main.cpp"});
    EXPECT_EQ(code.exit_code, 1);
    EXPECT_NE(code.err.find("no room has render_client/apps/render_client/main.cpp"), std::string::npos)
        << code.err;
    EXPECT_EQ(code.out, "");
    EXPECT_EQ(ask({"--changed", "docs/reference/tool.md"}).exit_code, 0);
}

TEST_F(RoomTests, AnUnknownRoomIsAnsweredWithTheList) {
    const Finished answer = ask({"drilling"});
    EXPECT_EQ(answer.exit_code, 1);
    EXPECT_NE(answer.err.find("there is no room drilling; the rooms are: "), std::string::npos);
    EXPECT_NE(answer.err.find("milling"), std::string::npos) << answer.err;
}

}  // namespace
}  // namespace bonemill
