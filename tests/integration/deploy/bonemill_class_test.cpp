// Runs deploy/bonemill with stand-ins: where a class' results go, replays, and guests.
#include <gtest/gtest.h>
#include <unistd.h>

#include <regex>

#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

using test::BonemillRig;
using test::Finished;
using test::Process;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

class BonemillClass : public testing::Test {
  protected:
    BonemillClass() { rig_.useStandIns(); }

    // What the stand-ins were told in a session that was started with these words.
    std::string eventsOf(const std::vector<std::string>& words) {
        Process session(rig_.words(words));
        EXPECT_TRUE(rig_.awaitStarts("render_client", 1)) << session.errSoFar();
        list_ = rig_.call({"list"}).out;
        session.signal(SIGTERM);
        out_ = session.wait().out;
        return rig_.events();
    }

    BonemillRig rig_;
    std::string list_, out_;
};

TEST_F(BonemillClass, EverySessionLeavesItsResultsInTheClassFolder) {
    const std::string events = eventsOf({"start", rig_.scene(), "--class", "Group 3"});
    const std::string folder = rig_.folder() / "data/bonemill/classes/Group 3";
    EXPECT_TRUE(std::filesystem::is_directory(folder));
    EXPECT_EQ(std::filesystem::status(folder).permissions(), std::filesystem::perms::owner_all);
    EXPECT_TRUE(has(events, "--export-dir " + folder)) << events;
    EXPECT_TRUE(has(events, "--class-folder " + folder)) << events;
    EXPECT_TRUE(has(out_, folder)) << out_;
    EXPECT_TRUE(has(list_, "class in " + folder)) << list_;
}

TEST_F(BonemillClass, WithoutANameItIsTheDay) {
    const std::string events = eventsOf({"start", rig_.scene()});
    EXPECT_TRUE(
        std::regex_search(events, std::regex("--export-dir \\S*/classes/20[0-9]{2}-[01][0-9]-[0-3][0-9]\\s")))
        << events;
}

TEST_F(BonemillClass, WhoSaysWhereHasNoFolderOfOurs) {
    const std::string events = eventsOf({"start", rig_.scene(), "--", "--export-dir", rig_.folder().path()});
    EXPECT_FALSE(has(events, "/classes/")) << events;
    EXPECT_FALSE(has(events, "--class-folder")) << events;
    EXPECT_TRUE(has(list_, "class in no folder")) << list_;
}

TEST_F(BonemillClass, ANameIsNoPath) {
    for (const char* name : {"../x", "a/b", ".hidden", "a\nb"}) {
        const Finished finished = rig_.call({"start", rig_.scene(), "--class", name});
        EXPECT_EQ(finished.exit_code, 2) << name;
        EXPECT_TRUE(has(finished.err, "give letters, digits")) << finished.err;
    }
}

// In which viewers may choose another attempt to compare with.
const std::string kFolders = "--classes [^ ]+/data/bonemill/classes --recordings [^ ]+/bonemill/recordings";

TEST_F(BonemillClass, ReplaysTheLastSessionWithoutAHand) {
    const std::string recordings = rig_.folder() / "logs/bonemill/recordings";
    EXPECT_TRUE(has(rig_.call({"replay"}).err, "no session has been recorded"));
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/1_old.mcap", "old");
    test::writeFile(recordings + "/2_new.mcap", "new");
    std::filesystem::last_write_time(recordings + "/1_old.mcap",
                                     std::filesystem::file_time_type::clock::now() - std::chrono::hours(2));
    const std::string events = eventsOf({"replay", "--at", "41.5", "--", "--speed", "2"});
    EXPECT_TRUE(std::regex_search(
        events, std::regex("start bonemill_lab [0-9]+ replay " + recordings +
                           "/2_new.mcap --session [0-9]+ --at 41.5 " + kFolders + " --speed 2\n")))
        << events;
    EXPECT_FALSE(has(events, "device_daemon")) << events;
    EXPECT_FALSE(has(events, "haptic_server")) << events;
    EXPECT_LT(list_.find("2_new.mcap"), list_.find("1_old.mcap")) << list_;
    EXPECT_TRUE(has(rig_.call({"replay", "nothing.mcap"}).err, "there is no recording nothing.mcap"));
    EXPECT_TRUE(has(eventsOf({"replay", "1_old.mcap"}), recordings + "/1_old.mcap")) << "a name will do";
    EXPECT_TRUE(has(rig_.call({"replay", "--at", "x"}).err, "--at x: give seconds"));
}

TEST_F(BonemillClass, ReplaysTheWorstMomentOfAnAttempt) {
    const std::string recordings = rig_.folder() / "logs/bonemill/recordings",
                      result = rig_.folder() / "r.json";
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/1_a.mcap", "a");
    test::writeFile(result, R"({"journal": "1_a.mcap", "moments": [{"t_s": 12, "severity": 0.5},
        {"t_s": 40.5, "severity": 10}, {"t_s": 50, "severity": 1}]})");
    const std::string events = eventsOf({"replay", result});
    EXPECT_TRUE(has(events, " replay " + recordings + "/1_a.mcap ")) << events;
    EXPECT_TRUE(has(events, " --at 37.5 ")) << events;
    for (const char* text :
         {"{}", "[1]", "no JSON", R"({"journal": ""})", R"({"journal": "../../etc/passwd"})"}) {
        test::writeFile(result, text);
        const Finished finished = rig_.call({"replay", result});
        EXPECT_EQ(finished.exit_code, 2) << text;
        EXPECT_EQ(test::linesOf(finished.err), 1) << finished.err;
    }
}

TEST_F(BonemillClass, GoesOnOtherwiseFromTheWorstMomentAndReplaysBoth) {
    const std::string recordings = rig_.folder() / "logs/bonemill/recordings",
                      result = rig_.folder() / "r.json", other = recordings + "/what_if/1_a_at_37.5_1.mcap";
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/1_a.mcap", "a");
    test::writeFile(result, R"({"journal": "1_a.mcap", "moments": [{"t_s": 40.5, "severity": 10}]})");
    const std::string told = " session what-if " + recordings + "/1_a.mcap --at 37.5 --out " + other +
                             " --expert --shift-mm 0,0,-0.5 --tool fine\n";
    const auto whatIf = [&](std::vector<std::string> words) {
        words.insert(words.begin(), "what-if");
        words.emplace_back("--no-viewer");
        return rig_.call(words);
    };
    rig_.letLeave("bonemill_lab", 0);
    EXPECT_EQ(whatIf({result, "--shift-mm", "0,0,-0.5", "--tool", "fine", "--expert"}).exit_code, 0);
    EXPECT_TRUE(has(rig_.events(), told)) << rig_.events();
    EXPECT_FALSE(has(rig_.events(), " replay ")) << rig_.events();
    test::writeFile(other, "taken");
    whatIf({result, "--pace", "2"});
    EXPECT_TRUE(has(rig_.events(), "1_a_at_37.5_2.mcap --pace 2\n")) << rig_.events();
    test::expectRefusal(whatIf({"1_a.mcap", "--pace", "2"}), "say with --at");
    rig_.letLeave("bonemill_lab", 2);
    EXPECT_EQ(whatIf({result, "--tool", "none"}).exit_code, 2);
}

TEST_F(BonemillClass, ReplaysAnAttemptBesideAnother) {
    const std::string recordings = rig_.folder() / "logs/bonemill/recordings",
                      result = rig_.folder() / "r.json";
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/1_a.mcap", "a");
    test::writeFile(recordings + "/2_b.mcap", "b");
    test::writeFile(result, "{}");
    const std::string by_name = eventsOf({"replay", "1_a.mcap", "--against", "2_b.mcap"});
    EXPECT_TRUE(std::regex_search(by_name, std::regex("/1_a.mcap --session [0-9]+ " + kFolders +
                                                      " --against " + recordings + "/2_b.mcap\n")))
        << by_name;
    EXPECT_TRUE(has(eventsOf({"replay", "1_a.mcap", "--against", result}), " --against " + result + "\n"));
    for (const char* other : {"none.mcap", "/nowhere/r.json"})
        test::expectRefusal(rig_.call({"replay", "1_a.mcap", "--against", other}),
                            std::string(other) + " to compare with: bonemill sessions lists");
    rig_.letSay("bonemill_lab", "2026-11-28 bonemill_lab error: --against: /b.mcap: is of another scene\n");
    rig_.letLeave("bonemill_lab", 2);
    const Finished foreign = rig_.call({"replay", "1_a.mcap", "--against", "2_b.mcap"});
    EXPECT_EQ(foreign.exit_code, 2);
    EXPECT_EQ(foreign.err, "bonemill: bonemill_lab: --against: /b.mcap: is of another scene\n");
}

// The words' ends are the stand-ins' to say: the viewer leaves when the clip is written.
TEST_F(BonemillClass, AClipIsAVideoOfAReplayThatWaitsForIt) {
    const std::string recordings = rig_.folder() / "logs/bonemill/recordings",
                      result = rig_.folder() / "r.json", clip = rig_.folder() / "c.mp4";
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/1_a.mcap", "a");
    test::writeFile(result, R"({"journal": "1_a.mcap", "moments": [{"t_s": 40.5, "severity": 10}]})");
    rig_.letLeave("render_client", 0);
    const Finished finished =
        rig_.call({"replay", result, "--clip", clip, "--seconds", "6", "--view", "10,-20,30,1,2.5,-3"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(has(finished.out, "the clip is written: " + clip)) << finished.out;
    const std::string events = rig_.events();
    EXPECT_TRUE(std::regex_search(events, std::regex(" replay " + recordings +
                                                     "/1_a.mcap --session [0-9]+ "
                                                     "--at 37.5 " +
                                                     kFolders + " --paused\n")))
        << events;
    EXPECT_TRUE(has(events, " --offscreen --video " + clip +
                                " --seconds 6 --wait-complete --lead-replay 37.5"
                                " --camera-azimuth-deg 10 --camera-elevation-deg -20 --camera-distance-mm 30"
                                " --camera-target-mm 1 2.5 -3\n"))
        << events;
    EXPECT_TRUE(has(rig_.call({"replay", "--clip", "c.avi"}).err, "ends in .mp4"));
    EXPECT_TRUE(has(rig_.call({"replay", "--clip", clip, "--view", "1,2"}).err, "give six numbers"));
    rig_.letLeave("render_client", 1);
    EXPECT_NE(rig_.call({"replay", result, "--clip", clip, "--at", "2"}).exit_code, 0);
    EXPECT_EQ(rig_.pidsOf("render_client").size(), 2u) << "it is not begun anew";
    EXPECT_TRUE(std::regex_search(rig_.events(), std::regex(" --at 0 " + kFolders + " --paused")))
        << rig_.events();
}

// Classes lie side by side; the newest attempt is the first one, whatever its class.
TEST_F(BonemillClass, ListsTheLastAttemptsOfAllClasses) {
    EXPECT_TRUE(has(rig_.call({"sessions"}).out, "No attempt has left a result"));
    const std::string classes = rig_.folder() / "data/bonemill/classes/",
                      recordings = rig_.folder() / "logs/bonemill/recordings";
    std::filesystem::create_directories(recordings);
    test::writeFile(recordings + "/7_a.mcap", "a");
    const auto leave = [&](const std::string& of_class, const std::string& name, const std::string& text) {
        std::filesystem::create_directories(classes + of_class + "/results");
        test::writeFile(classes + of_class + "/results/" + name, text);
    };
    const auto result = [](const std::string& who, const std::string& more) {
        return R"({"pseudonym": ")" + who + R"(", "scene": {"id": "pedicle", "title": "A\tpedicle"},)" +
               R"("start_unix_ns": 1795000000000000000, )" + more + "}";
    };
    leave("Group 3", "20261118T100000Z_P07_1.json",
          result("P07", R"("exam": false, "journal": "7_a.mcap", "total": {"score": 0.814})"));
    leave("Group 3", "20261120T100000Z_P08_1.json", result("P08", R"("exam": true, "journal": "")"));
    leave("2026-11-19", "20261119T100000Z_P09_1.json",
          result("P09", R"("exam": false, "journal": "gone.mcap", "passed": false)"));
    leave("2026-11-19", "20261121T100000Z_P10_1.json", "no JSON");
    leave("2026-11-19", "20261122T100000Z_P10_1.json", "[1]");
    const std::string out = rig_.call({"sessions"}).out;
    EXPECT_EQ(test::linesOf(out), 3) << out;
    EXPECT_TRUE(std::regex_search(out, std::regex("A pedicle +P08 +examination [^\n]*\n[^\n]*P09 +not passed"
                                                  "[^\n]*recording\\)\n[^\n]*P07 +score 81 of 100 +/")))
        << out;
    const std::string last =
        classes + "Group 3/results/20261118T100000Z_P07_1.json\t" + recordings + "/7_a.mcap\t";
    EXPECT_TRUE(has(rig_.call({"sessions", "--tab-separated"}).out, last)) << out;
}

TEST_F(BonemillClass, ListsTheAttemptsAtOneScene) {
    const std::string of_class = rig_.folder() / "data/bonemill/classes/2026-11-19/";
    const auto leave = [&](const std::string& place, const std::string& who, const std::string& hash) {
        std::filesystem::create_directories(std::filesystem::path(of_class + place).parent_path());
        test::writeFile(of_class + place, R"({"pseudonym": ")" + who +
                                              R"(", "scene": {"id": "s", "title": "S", "hash": ")" + hash +
                                              R"("}, "start_unix_ns": 1795000000000000000, "exam": false,)" +
                                              R"("journal": ""})");
    };
    leave("results/20261118T100000Z_P07_1.json", "P07", "0123456789abcdef");
    leave("results/20261119T100000Z_P08_1.json", "P08", "fedcba9876543210");
    leave("experts/20261001T100000Z_E1_1.json", "E1", "0123456789abcdef");
    const std::string out = rig_.call({"sessions", "--scene", "0123456789abcdef"}).out;
    EXPECT_EQ(test::linesOf(out), 2) << out;
    EXPECT_TRUE(has(out, "P07") && has(out, "E1")) << out;
    EXPECT_FALSE(has(rig_.call({"sessions"}).out, "E1")) << "experts are no class";
    EXPECT_TRUE(has(rig_.call({"sessions", "--scene", "tooth"}).err, "--scene tooth: give the hash"));
}

TEST_F(BonemillClass, InvitesAGuestToTheSessionThatRuns) {
    EXPECT_TRUE(has(rig_.call({"invite", "Anna"}).err, "no session of yours runs"));
    Process session(
        rig_.words({"start", rig_.scene(), "--session", std::to_string(getpid()), "--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1));
    std::vector<std::string> words = rig_.words({"invite", "Anna", "--port", "8999", "--address", "lab-pc"});
    words.insert(words.begin() + 1, "XDG_CONFIG_HOME=" + rig_.folder() / "config");
    Process guests(words);
    ASSERT_TRUE(rig_.awaitStarts("render_client", 1)) << guests.errSoFar();
    EXPECT_TRUE(std::regex_search(guests.outSoFar(), std::regex("https://lab-pc:8999/#[0-9a-f]{32}\n")))
        << guests.outSoFar();
    EXPECT_TRUE(has(rig_.events(), " --serve 0.0.0.0:8999 --session " + std::to_string(getpid())))
        << rig_.events();
    EXPECT_TRUE(has(test::readFile(rig_.folder() / "config/bonemill/guests.textproto"),
                    "name: \"Anna\" role: VIEWER"));
    guests.signal(SIGTERM);
    guests.wait();
    const Finished again = test::run(words);
    EXPECT_EQ(again.exit_code, 2);
    EXPECT_TRUE(has(again.err, "is invited already")) << again.err;
    session.signal(SIGTERM);
    session.wait();
}

// The gateway of an invitation from the window ends with the session, however that ends.
TEST_F(BonemillClass, AGatewayBehindTheWindowEndsWithTheSession) {
    const std::string port = std::to_string(20000 + getpid() % 20000);
    rig_.putProgram("render_client",
                    "#!/bin/bash\necho \"start render_client $$ $*\" >>\"${0%/*}/../events\"\n"
                    "exec python3 -m http.server --bind 127.0.0.1 " +
                        port + "\n");
    Process session(
        rig_.words({"start", rig_.scene(), "--session", std::to_string(getpid()), "--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1));
    std::vector<std::string> words = rig_.words({"invite", "Anna", "--port", port, "--in-background"});
    words.insert(words.begin() + 1, "XDG_CONFIG_HOME=" + rig_.folder() / "config");
    const Finished finished = test::run(words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_TRUE(std::regex_search(finished.out, std::regex("https://\\S+:" + port + "/#[0-9a-f]{32}\n")))
        << finished.out;
    const int gateway = rig_.pidsOf("render_client").at(0);
    EXPECT_FALSE(test::isGone(gateway));
    session.signal(SIGKILL);
    session.wait();
    EXPECT_TRUE(test::waitFor([&] { return test::isGone(gateway); }));
}

}  // namespace
}  // namespace bonemill
