// What deploy/bonemill tells its window, and other programs: lines with a tab between the fields; and how it
// opens windows.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

using test::BonemillRig;
using test::expectRefusal;
using test::Finished;

class BonemillWindow : public testing::Test {
  protected:
    BonemillWindow() {
        rig_.useStandIns();
        rig_.putProgram("start_window", "#!/bin/sh\necho \"window $*\"\n");
        rig_.putProgram("case_window", "#!/bin/sh\n");
        rig_.putProgram("bonemill-make-case", "#!/bin/sh\necho \"case $*\"\n");
    }
    std::string tell(std::vector<std::string> words) const {
        words.push_back("--tab-separated");
        const Finished finished = rig_.call(words);
        EXPECT_EQ(finished.err, "");
        return "\n" + finished.out;
    }
    static bool has(const std::string& text, const std::string& line) {
        return text.find("\n" + line) != std::string::npos;
    }

    BonemillRig rig_;
};

TEST_F(BonemillWindow, WithoutAWordItOpensWhereThereIsADisplay) {
    const std::string self = rig_.programFile("bonemill");
    EXPECT_EQ(rig_.call({}).out, "window --launcher " + self + " --\n");
    EXPECT_EQ(rig_.call({"window", "--domain", "4"}).out, "window --launcher " + self + " -- --domain 4\n");
    expectRefusal(rig_.call({"window", "tooth"}), "window takes no word");
    rig_.setDisplay(false);
    const Finished help = rig_.call({});
    EXPECT_EQ(help.exit_code, 2);
    EXPECT_EQ(help.err.rfind("Usage: bonemill", 0), 0u) << help.err;
    expectRefusal(rig_.call({"window"}), "there is no display here");
    rig_.setDisplay(true);
    std::filesystem::remove(rig_.programFile("start_window"));
    EXPECT_EQ(rig_.call({}).exit_code, 2) << "the viewer was not built";
    expectRefusal(rig_.call({"window"}), "start_window is missing");
}

TEST_F(BonemillWindow, ScenesCasesAndSessionsAreListed) {
    const std::string cases = rig_.folder() / "data/bonemill/cases",
                      scenes = rig_.folder() / "data/bonemill/deploy/scenes";
    std::filesystem::create_directories(cases + "/jaw");
    test::writeFile(cases + "/jaw/jaw.textproto", "volume {\n  path: \"/no/such.nrrd\"\n}\n");
    test::writeFile(cases + "/jaw/jaw.png", "");
    test::Process session(rig_.words({"start", rig_.scene()}));
    ASSERT_TRUE(rig_.awaitStarts("render_client", 1));
    const std::string list = tell({"list"});
    EXPECT_TRUE(has(list, "scene\ttooth_corridor\t" + scenes + "/tooth_corridor.textproto\t" + scenes +
                              "/tooth_corridor.png\ttooth\t\n"))
        << list;
    EXPECT_TRUE(has(list, "scene\ttooth_wall\t" + scenes + "/tooth_wall.textproto\t\t\ttooth_milled.nrrd\n"))
        << list;
    EXPECT_TRUE(
        has(list, "case\tjaw\t" + cases + "/jaw/jaw.textproto\t" + cases + "/jaw/jaw.png\t\t/no/such.nrrd\n"))
        << list;
    EXPECT_TRUE(has(list, "session\t")) << list;
    EXPECT_NE(list.find("\town\tauto\t"), std::string::npos) << list;
}

TEST_F(BonemillWindow, TheDoctorTellsWhatItHasLookedAt) {
    test::writeFile(rig_.folder() / "device_daemon.help",
                    "gamepad          not ready  you may not read it\n"
                    "                            Pad  /dev/input/event3\n"
                    "                 type       sudo udevadm trigger\n"
                    "mouse            ready      in a viewer's window\n"
                    "                 type       device_daemon --scene FILE --device pointer\n");
    const std::string doctor = tell({"doctor"});
    EXPECT_TRUE(has(doctor, "Programs\tok\tbuilt, in ")) << doctor;
    EXPECT_TRUE(has(doctor, "Network\tok\ton this PC alone, nothing is needed\n")) << doctor;
    EXPECT_TRUE(has(doctor, "Real time\t")) << doctor;
    EXPECT_TRUE(
        has(doctor,
            "hand\tgamepad\tnot ready\tyou may not read it: Pad  /dev/input/event3\tsudo udevadm trigger\n"))
        << doctor;
    EXPECT_TRUE(has(doctor, "hand\tmouse\tready\tin a viewer's window\tbonemill start --device pointer\n"))
        << doctor;
    std::filesystem::remove(rig_.programFile("haptic_server"));
    EXPECT_TRUE(has(tell({"doctor"}), "Programs\tMISSING\t"));
}

TEST_F(BonemillWindow, SessionsOfOtherPCsAreTold) {
    const std::string own = test::run({"/bin/uname", "-n"}).out;
    rig_.putProgram("render_client",
                    "#!/bin/sh\necho \"session 3: tooth corridor since 14:05:09 on lab-pc-2\"\n"
                    "echo \"session 4: skull since 14:05:09 on " +
                        own.substr(0, own.size() - 1) + "\"\necho noise\n");
    EXPECT_EQ(tell({"watch", "--list", "--interface", "eth7"}),
              "\n3\ttooth corridor\t14:05:09\tlab-pc-2\tlab\teth7\n");
    EXPECT_EQ(rig_.call({"watch", "--list", "--interface", "eth7"}).out,
              "session 3: tooth corridor since 14:05:09 on lab-pc-2\n");
}

TEST_F(BonemillWindow, ACaseOfAScanLiesWithTheOthers) {
    const std::string cases = rig_.folder() / "data/bonemill/cases";
    EXPECT_EQ(rig_.call({"scan"}).out, "case --window --out " + cases + "/case_1\n");
    std::filesystem::create_directories(cases + "/case_1");
    EXPECT_EQ(rig_.call({"scan", "/a/scan"}).out, "case --window --out " + cases + "/case_2 /a/scan\n");
    rig_.setDisplay(false);
    expectRefusal(rig_.call({"scan"}), "there is no display here");
}

}  // namespace
}  // namespace bonemill
