// What deploy/bonemill makes of the PC on which it is: its network, and what is installed there.
#include <gtest/gtest.h>

#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

using test::BonemillRig;
using test::expectRefusal;
using test::Finished;
using test::Process;

class BonemillPc : public testing::Test {
  protected:
    BonemillPc() { rig_.useStandIns(); }

    BonemillRig rig_;
};

TEST_F(BonemillPc, EveryCommandThatReachesASessionTakesItsDomain) {
    for (const char* command : {"start", "host", "watch", "invite", "replay", "doctor", "window"}) {
        expectRefusal(rig_.call({command, "--domain", "231"}), "--domain 231: give a number from 0 to 230");
        const std::string help = rig_.call({command, "--help"}).out;
        EXPECT_NE(help.find("--domain D"), std::string::npos) << command;
    }
    const std::string doctor = rig_.call({"doctor", "--interface", "lo", "--domain", "2"}).out;
    EXPECT_NE(doctor.find("UDP 7900 to 8039"), std::string::npos) << doctor;
}

TEST_F(BonemillPc, APcThatOnlyWatchesNeedsTheViewerAlone) {
    for (const char* program : {"bonemill_lab", "haptic_server", "device_daemon"})
        std::filesystem::remove(rig_.programFile(program));
    const std::filesystem::path share = rig_.folder() / "share/bonemill";
    const std::filesystem::path deploy = std::filesystem::read_symlink(share);
    std::filesystem::remove(share);
    std::filesystem::create_directory(share);
    std::filesystem::create_directory_symlink(deploy / "bonemill.d", share / "bonemill.d");
    expectRefusal(rig_.call({"start"}), "install the package bonemill");
    expectRefusal(rig_.call({"replay", rig_.scene()}), "install the package bonemill");
    const Finished list = rig_.call({"list"});
    EXPECT_EQ(list.exit_code, 0) << list.err;
    EXPECT_EQ(list.err, "");
    Process viewer(rig_.words({"watch", "192.0.2.7", "--interface", "eth7"}));
    EXPECT_TRUE(rig_.awaitStarts("render_client", 1)) << viewer.errSoFar();
}

TEST_F(BonemillPc, ItsVersionIsThatOfItsPrograms) {
    rig_.putProgram("render_client", "#!/bin/sh\necho \"render_client 1.2.3 ($1)\"\n");
    EXPECT_EQ(rig_.call({"--version"}).out, "bonemill 1.2.3 (--version)\n");
}

TEST_F(BonemillPc, TheHandbookOpensAtThePageThatAMessageNames) {
    expectRefusal(rig_.call({"handbook"}), "install the package bonemill-doc");
    const std::filesystem::path pages = rig_.folder() / "share/doc/bonemill/handbook";
    std::filesystem::create_directories(pages / "howto");
    test::writeFile(pages / "index.html", "first");
    test::writeFile(pages / "howto/security.html", "who may come in");
    const std::string opened = rig_.folder() / "opened";
    rig_.putProgram("xdg-open", "#!/bin/sh\necho \"$1\" >\"" + opened + "\"\n");
    const auto open = [&](const std::vector<std::string>& words) {
        std::vector<std::string> all{"/usr/bin/env", "PATH=" + rig_.folder() / "bin:" + std::getenv("PATH")};
        for (const std::string& word : rig_.words(words)) all.push_back(word);
        return test::run(all);
    };
    const std::string page = std::filesystem::canonical(pages / "howto/security.html");
    const auto isOpened = [&](const std::string& file) {
        return test::waitFor([&] { return test::readFile(opened) == file + "\n"; });
    };
    for (const char* name : {"docs/howto/security.md", "howto/security", "security"}) {
        test::writeFile(opened, "");
        EXPECT_EQ(open({"handbook", name}).out, page + "\n") << name;
        EXPECT_TRUE(isOpened(page)) << name;
    }
    const std::string first = std::filesystem::canonical(pages / "index.html");
    EXPECT_EQ(open({"handbook"}).out, first + "\n");
    EXPECT_TRUE(isOpened(first));
    test::writeFile(opened, "");
    rig_.setDisplay(false);
    EXPECT_EQ(open({"handbook", "security"}).out, page + "\n");
    EXPECT_EQ(test::readFile(opened), "");
    expectRefusal(open({"handbook", "May Come"}), "these have that word: howto/security");
    std::filesystem::create_directory(pages / "reference");
    test::writeFile(pages / "reference/security.html", "its words");
    expectRefusal(open({"handbook", "security"}), "are called security: howto/security reference/security");
    expectRefusal(open({"handbook", "xyzzy"}), "has no page xyzzy, and none with that word");
}

}  // namespace
}  // namespace bonemill
