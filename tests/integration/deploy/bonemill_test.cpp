// Runs deploy/bonemill with stand-ins for the programs: who is started and ended, when, and what is said?
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

using test::BonemillRig;
using test::expectRefusal;
using test::Finished;
using test::isGone;
using test::Process;
using test::waitFor;

class Bonemill : public testing::Test {
  protected:
    Bonemill() { rig_.useStandIns(); }

    std::vector<std::string> startWords(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words{"start", rig_.scene()};
        words.insert(words.end(), more.begin(), more.end());
        return rig_.words(words);
    }
    bool allHaveStarted() const {
        return rig_.awaitStarts("haptic_server", 1) && rig_.awaitStarts("device_daemon", 1) &&
               rig_.awaitStarts("render_client", 1);
    }
    std::vector<int> allPids() const {
        std::vector<int> all;
        for (const char* name : {"haptic_server", "device_daemon", "render_client"})
            for (const int pid : rig_.pidsOf(name)) all.push_back(pid);
        return all;
    }
    bool allAreGone() const {
        const std::vector<int> pids = allPids();
        return waitFor([&] { return std::all_of(pids.begin(), pids.end(), isGone); });
    }
    // The line of the stand-in's first start.
    std::string startOf(const std::string& name) const {
        const std::string events = rig_.events();
        const size_t begin = events.find("start " + name + " ");
        return events.substr(begin, events.find('\n', begin) - begin) + " ";
    }
    // Device first, lest the hand feels a force that nobody holds; viewer last, so that it sees the end.
    void expectEndInOrder() const {
        const std::string events = rig_.events();
        const std::string order = "end device_daemon\nend haptic_server\nend render_client\n";
        EXPECT_NE(events.find(order), std::string::npos) << events;
    }
    static bool has(const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    }
    static std::string numberIn(const std::string& out) {
        const size_t begin = out.find("session ") + 8;
        return out.substr(begin, out.find(' ', begin) - begin);
    }

    BonemillRig rig_;
};

TEST_F(Bonemill, StartsThreeProgramsAsOneSessionAndEndsThemInOrder) {
    Process session(
        startWords({"--session", std::to_string(getpid()), "--device", "pointer", "--seconds", "7",
                    "--window-size", "640x480", "--instructor-only", "--", "--trace", "t.csv"}));
    ASSERT_TRUE(allHaveStarted()) << session.errSoFar();
    const std::string common = " --session " + std::to_string(getpid()) + " ";
    for (const char* name : {"haptic_server", "device_daemon", "render_client"})
        EXPECT_TRUE(has(startOf(name), common)) << startOf(name);
    EXPECT_TRUE(has(startOf("haptic_server"), " --scene " + rig_.scene() + " "));
    EXPECT_TRUE(has(startOf("haptic_server"), " --instructor-only --trace t.csv "));
    EXPECT_TRUE(has(startOf("device_daemon"), " --device pointer --stop-dir " + rig_.folder() / "logs"));
    EXPECT_TRUE(has(startOf("device_daemon"), " --seconds 7 "));
    EXPECT_TRUE(has(startOf("render_client"), " --size 640x480 "));

    const std::string list = rig_.call({"list"}).out;
    EXPECT_TRUE(has(list, "  " + std::to_string(getpid()) + " ")) << list;
    EXPECT_TRUE(has(list, "own              device pointer, since ")) << list;
    EXPECT_TRUE(has(list, "processes: bonemill " + std::to_string(session.pid()) + ", haptic_server " +
                              std::to_string(rig_.pidsOf("haptic_server")[0]) + ", device_daemon "))
        << list;

    session.signal(SIGINT);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(finished.err, "");
    expectEndInOrder();
    EXPECT_TRUE(allAreGone());
    EXPECT_TRUE(has(rig_.call({"list"}).out, "No session runs."));
}

TEST_F(Bonemill, AClosedWindowEndsTheSession) {
    Process session(startWords());
    ASSERT_TRUE(allHaveStarted());
    rig_.letLeave("render_client", 0);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(has(finished.out, "the window was closed")) << finished.out;
    EXPECT_TRUE(has(rig_.events(), "end device_daemon\nend haptic_server\n")) << rig_.events();
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, AHandThatHasFinishedEndsTheSession) {
    Process session(startWords({"--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1));
    rig_.letLeave("device_daemon", 0);
    EXPECT_EQ(session.wait().exit_code, 0);
    EXPECT_FALSE(has(rig_.events(), "render_client"));
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, AScriptedHandRestsAtItsEndWhereThereIsAWindowToSayWhatComesNext) {
    for (const bool has_window : {true, false}) {
        BonemillRig rig;
        rig.useStandIns();
        std::vector<std::string> words{"start", rig.scene(), "--device", "simulated"};
        if (!has_window) words.push_back("--no-viewer");
        Process session(rig.words(words));
        ASSERT_TRUE(rig.awaitStarts("device_daemon", 1)) << session.errSoFar();
        EXPECT_EQ(has(rig.events(), " --hold"), has_window) << rig.events();
        session.signal(SIGTERM);
        EXPECT_EQ(session.wait().exit_code, 0);
    }
}

TEST_F(Bonemill, WithoutADisplayThereIsNoWindow) {
    rig_.setDisplay(false);
    Process session(startWords());
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1));
    session.signal(SIGTERM);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(has(finished.out, "there is no display here")) << finished.out;
    EXPECT_FALSE(has(rig_.events(), "render_client"));
}

TEST_F(Bonemill, TwoSessionsRunSideBySideAndStopEndsAll) {
    Process first(startWords()), second(startWords());
    ASSERT_TRUE(rig_.awaitStarts("render_client", 2))
        << first.outSoFar() << first.errSoFar() << second.outSoFar() << second.errSoFar() << rig_.events();
    const std::string one = numberIn(first.outSoFar()), two = numberIn(second.outSoFar());
    EXPECT_NE(one, two);
    expectRefusal(rig_.call({"stop"}), "several sessions run");
    expectRefusal(rig_.call({"stop", "999999"}), "there is no session 999999");
    expectRefusal(rig_.call({"watch"}), "several sessions run");
    expectRefusal(rig_.call({"start", rig_.scene(), "--session", one}), "session " + one + " runs already");
    EXPECT_EQ(rig_.call({"stop", one}).out, "bonemill: session " + one + " has ended\n");
    EXPECT_EQ(first.wait().exit_code, 0);
    EXPECT_TRUE(second.isRunning());
    EXPECT_EQ(rig_.call({"stop", "all"}).exit_code, 0);
    EXPECT_EQ(second.wait().exit_code, 0);
    EXPECT_TRUE(allAreGone());
    EXPECT_EQ(rig_.call({"stop"}).out, "bonemill: no session of yours runs on this PC\n");
}

TEST_F(Bonemill, AKilledScriptLeavesNothingBehind) {
    Process session(startWords());
    ASSERT_TRUE(allHaveStarted());
    const std::string number = numberIn(session.outSoFar());
    session.signal(SIGKILL);
    EXPECT_EQ(session.wait().exit_code, 128 + SIGKILL);
    EXPECT_TRUE(allAreGone());
    EXPECT_TRUE(has(rig_.call({"list"}).out, "No session runs."));
    Process next(startWords({"--session", number}));  // Its number is free again.
    EXPECT_TRUE(rig_.awaitStarts("haptic_server", 2));
    next.signal(SIGTERM);
    EXPECT_EQ(next.wait().exit_code, 0);
}

// A process number is given anew, and what a killed script has left names one that is somebody else's.
TEST_F(Bonemill, StopDuringAStartEndsNobodyElse) {
    Process bystander({"/bin/sleep", "60"});
    const std::string number = "8123", state = rig_.folder() / ("run/bonemill-" + std::to_string(getuid()));
    std::filesystem::create_directory(state);
    std::filesystem::permissions(state, std::filesystem::perms::owner_all);
    test::writeFile(state + "/" + number + ".session", "script=" + std::to_string(bystander.pid()) + "\n");
    // It takes as long as the rig's folder is there.
    rig_.putProgram("make_phantom", "#!/bin/bash\nwhile [[ -e $0 ]]; do sleep 0.02; done\n");
    Process session(rig_.words({"start", "tooth_caries", "--no-viewer", "--session", number}));
    ASSERT_TRUE(waitFor([&] { return has(session.outSoFar(), "making the phantom"); }));
    EXPECT_TRUE(has(rig_.call({"stop"}).out, "no session of yours runs"));
    EXPECT_FALSE(isGone(bystander.pid()));
    session.signal(SIGKILL);
    bystander.signal(SIGKILL);
}

TEST_F(Bonemill, AKilledProgramIsStartedAgainAndTheOthersStay) {
    Process session(startWords());
    ASSERT_TRUE(allHaveStarted());
    for (const std::string name : {"haptic_server", "device_daemon", "render_client"}) {
        kill(rig_.pidsOf(name)[0], SIGKILL);
        ASSERT_TRUE(rig_.awaitStarts(name, 2)) << name;
        EXPECT_TRUE(has(session.outSoFar(), name + " was ended by signal 9: it is started again (1 of 3)"))
            << session.outSoFar();
    }
    EXPECT_EQ(allPids().size(), 6u);
    const std::string list = rig_.call({"list"}).out;
    EXPECT_TRUE(has(list, "haptic_server " + std::to_string(rig_.pidsOf("haptic_server")[1]))) << list;
    session.signal(SIGTERM);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_EQ(finished.err, "");
    expectEndInOrder();
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, AProgramThatDiesAgainAndAgainEndsTheSession) {
    rig_.letLeave("haptic_server", 1);
    const Finished finished = test::run(startWords());
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(rig_.pidsOf("haptic_server").size(), 4u);
    EXPECT_EQ(rig_.pidsOf("device_daemon").size(), 1u);
    EXPECT_TRUE(has(finished.err, "haptic_server left with code 1 again, after 3 restarts")) << finished.err;
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, WrongInputOfAProgramIsSaidOnceAndNotTriedAgain) {
    test::writeFile(rig_.folder() / "device_daemon.end", "2");  // It would have said the same.
    rig_.letSay("haptic_server", "error: own.textproto: there is no volume\n");
    rig_.letLeave("haptic_server", 2);
    const Finished finished = test::run(startWords());
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_EQ(finished.err, "bonemill: haptic_server: own.textproto: there is no volume\n");
    EXPECT_EQ(rig_.pidsOf("haptic_server").size(), 1u);
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, WhatTheDeviceWarnsOfIsSaid) {
    rig_.letSay(
        "device_daemon",
        "12:00:00.000 device_daemon info the hand is pointer\n12:00:00.000 device_daemon info phase mill\n"
        "12:00:01.000 device_daemon warn the hand slips\n12:00:02.000 device_daemon info haptic_server "
        "answers\n");
    Process session(startWords({"--no-viewer"}));
    EXPECT_TRUE(waitFor([&] {
        return has(session.outSoFar(),
                   "bonemill: device: the hand is pointer\nbonemill: device: the hand slips\n"
                   "bonemill: device: haptic_server answers\n");
    })) << session.outSoFar();
    EXPECT_FALSE(has(session.outSoFar(), "phase mill"));
}

TEST_F(Bonemill, AServerThatFailsAtItsEndIsTold) {
    test::writeFile(rig_.folder() / "haptic_server.end", "1");
    Process session(startWords({"--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1));
    session.signal(SIGTERM);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_EQ(finished.err.rfind("bonemill: haptic_server left with code 1, see ", 0), 0u) << finished.err;
}

TEST_F(Bonemill, AProgramThatDoesNotEndIsKilled) {
    rig_.putProgram("render_client", "#!/bin/bash\ntrap '' TERM\necho \"start render_client $$\" >>" +
                                         rig_.folder() / "events" + "\nwhile :; do sleep 0.1; done\n");
    Process session(startWords());
    ASSERT_TRUE(allHaveStarted());
    session.signal(SIGTERM);
    const Finished finished = session.wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_TRUE(has(finished.out, "render_client did not end within 5 s: it is killed")) << finished.out;
    EXPECT_TRUE(allAreGone());
}

TEST_F(Bonemill, AMissingPhantomIsMade) {
    rig_.putProgram(
        "make_phantom",
        "#!/bin/bash\nwhile [[ $1 != --out ]]; do shift; done\necho made >\"$2\"\necho made >\"$4\"\n");
    Process session(rig_.words({"start", "tooth_caries", "--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1)) << session.errSoFar();
    session.signal(SIGTERM);
    const Finished finished = session.wait();
    EXPECT_TRUE(has(finished.out, "making the phantom tooth, once")) << finished.out;
    EXPECT_EQ(test::readFile(rig_.folder() / "data/bonemill/build/data/tooth_labels.nrrd"), "made\n");
    EXPECT_TRUE(
        has(startOf("haptic_server"), rig_.folder() / "data/bonemill/deploy/scenes/tooth_caries.textproto"));
    expectRefusal(rig_.call({"start", "tooth_wall"}), "which is no phantom");
    const std::string server = startOf("haptic_server");
    EXPECT_TRUE(has(server, " --launcher " + rig_.programFile("bonemill") + " --makes=")) << server;
    EXPECT_TRUE(has(server, " --makes=third_molar ")) << server;
    for (const char* other : {"tooth_wall", "tooth_cavity", "skull "})
        EXPECT_FALSE(has(server, std::string("--makes=") + other)) << "no phantom, or there: " << server;
    EXPECT_TRUE(has(rig_.call({"prepare", "third_molar"}).out, "what third_molar reads is there"));
    EXPECT_EQ(test::readFile(rig_.folder() / "data/bonemill/build/data/third_molar.nrrd"), "made\n");
    expectRefusal(rig_.call({"prepare", "tooth_wall"}), "which is no phantom");
}

TEST_F(Bonemill, AWrongSceneIsAnsweredWithThoseThatExist) {
    const Finished finished = rig_.call({"start", "toth"});
    expectRefusal(finished, "there is no scene 'toth'");
    EXPECT_TRUE(has(finished.err, " minimal ") && has(finished.err, " tooth_corridor")) << finished.err;
    EXPECT_TRUE(has(rig_.call({"list"}).out, "  minimal          There is nothing but contact"));
}

TEST_F(Bonemill, WrongUseIsRefused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"begin"},
                                                  {"start", "--sesion", "3"},
                                                  {"start", "--session", "0"},
                                                  {"start", "--session"},
                                                  {"start", "a", "b"},
                                                  {"start", "--window-size", "big"},
                                                  {"stop", "--device", "x"},
                                                  {"host", "minimal"},
                                                  {"list", "all"}})
        expectRefusal(rig_.call(words), "");
    for (const std::string seconds : {"abc", "0.0", "-1", "1.5.2", "nan"})
        expectRefusal(rig_.call({"start", "--seconds", seconds}),
                      "--seconds " + seconds + ": give a number above 0");
    EXPECT_EQ(rig_.call({}).exit_code, 2);
    for (const char* command : {"start", "host", "list", "stop", "watch", "scan", "doctor", "handbook"}) {
        const Finished help = rig_.call({command, "--help"});
        EXPECT_EQ(help.exit_code, 0);
        EXPECT_EQ(help.out.rfind(std::string("Usage: bonemill ") + command, 0), 0u) << help.out;
    }
}

TEST_F(Bonemill, MissingProgramsAreSaidWithWhatToType) {
    std::filesystem::remove(rig_.programFile("render_client"));
    expectRefusal(rig_.call({"start"}), "render_client is missing");
    const Finished doctor = rig_.call({"doctor"});
    EXPECT_EQ(doctor.exit_code, 1);
    EXPECT_TRUE(has(doctor.out, "  MISSING  the programs are not there")) << doctor.out;
}

TEST_F(Bonemill, TheDoctorLooksAtEverything) {
    rig_.setDisplay(false);
    rig_.putProgram(
        "device_daemon",
        "#!/bin/bash\n[[ $1 != --list ]] || echo 'mouse  device_daemon --scene FILE --device pointer'\n"
        "echo ' --list'\n");
    const Finished doctor = rig_.call({"doctor"});
    EXPECT_EQ(doctor.exit_code, 0) << doctor.err;
    EXPECT_EQ(doctor.err, "");
    for (const char* heading :
         {"Programs:\n", "Real time:\n", "Network:\n", "Display:\n", "Devices:\n", "Sessions:\n"})
        EXPECT_TRUE(has(doctor.out, heading)) << doctor.out;
    EXPECT_TRUE(has(doctor.out, "there is none (DISPLAY is not set)")) << doctor.out;
    EXPECT_TRUE(has(doctor.out, "  mouse  bonemill start --device pointer\n")) << doctor.out;
}

TEST_F(Bonemill, TheDoctorFindsWhatRunsWithoutASession) {
    Process left_over({rig_.programFile("haptic_server"), "--session", "77"});
    ASSERT_TRUE(rig_.awaitStarts("haptic_server", 1));
    const std::string doctor = rig_.call({"doctor"}).out;
    EXPECT_TRUE(has(doctor, "haptic_server of session 77 runs without bonemill")) << doctor;
    EXPECT_TRUE(has(doctor, "kill " + std::to_string(left_over.pid()) + "\n")) << doctor;
    expectRefusal(rig_.call({"start", rig_.scene(), "--session", "77"}), "session 77 runs already");
}

TEST_F(Bonemill, WatchFindsTheSessionAndItsNetwork) {
    expectRefusal(rig_.call({"watch"}),
                  "start one with: bonemill start; or name the PC: bonemill watch HOST");
    Process session(rig_.words({"host", rig_.scene(), "--profile", "classroom", "--interface", "eth7",
                                "--domain", "9", "--no-viewer"}));
    ASSERT_TRUE(rig_.awaitStarts("device_daemon", 1)) << session.errSoFar();
    for (const char* name : {"haptic_server", "device_daemon"})
        EXPECT_TRUE(has(startOf(name), " --profile classroom --interface eth7 --domain 9 ")) << startOf(name);
    Process viewer(rig_.words({"watch", "--role", "viewer", "--", "--no-hud"}));
    ASSERT_TRUE(rig_.awaitStarts("render_client", 1)) << viewer.errSoFar();
    EXPECT_TRUE(has(startOf("render_client"),
                    " --session " + numberIn(session.outSoFar()) +
                        " --role viewer --profile classroom --interface eth7 --domain 9 --no-hud "))
        << startOf("render_client");
    EXPECT_TRUE(has(session.outSoFar(), "viewers on other PCs: bonemill watch --profile classroom"));
    session.signal(SIGTERM);
    EXPECT_EQ(session.wait().exit_code, 0);
    EXPECT_TRUE(viewer.isRunning());
}

TEST_F(Bonemill, WatchLooksAtAnotherPC) {
    Process viewer(rig_.words({"watch", "192.0.2.7", "--interface", "eth7", "--session", "3"}));
    ASSERT_TRUE(rig_.awaitStarts("render_client", 1)) << viewer.errSoFar();
    EXPECT_TRUE(
        has(startOf("render_client"), " --session 3 --profile lab --interface eth7 --peer 192.0.2.7 "))
        << startOf("render_client");
}

// In /tmp anyone could have made the folder, or a link of its name, before.
TEST_F(Bonemill, AStateFolderThatOthersCouldUseIsRefused) {
    const std::string folder = rig_.folder() / ("run/bonemill-" + std::to_string(getuid()));
    std::filesystem::create_directory(folder);
    std::filesystem::permissions(folder, std::filesystem::perms(0777));
    expectRefusal(rig_.call({"start", rig_.scene()}), "is not a folder that only you can use");
    std::filesystem::remove(folder);
    std::filesystem::create_directory(rig_.folder() / "elsewhere");
    std::filesystem::permissions(rig_.folder() / "elsewhere", std::filesystem::perms(0700));
    std::filesystem::create_directory_symlink(rig_.folder() / "elsewhere", folder);
    expectRefusal(rig_.call({"list"}), "is not a folder that only you can use");
    EXPECT_TRUE(std::filesystem::is_empty(rig_.folder() / "elsewhere"));
    EXPECT_EQ(rig_.events(), "");
}

}  // namespace
}  // namespace bonemill
