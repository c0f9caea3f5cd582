// Security that was asked for and is not in force stops the start of every program.
#include "tests/integration/security/secured_slab.h"

namespace bonemill {
namespace {

void expectRefused(const test::Words& words, const std::string& why) {
    const test::Finished finished = test::run(words);
    EXPECT_EQ(finished.exit_code, 2) << words[0] << ": " << finished.err;
    EXPECT_NE(finished.err.find(why), std::string::npos) << words[0] << ": " << finished.err;
}

TEST(RefusedStart, SaysWhatIsWrongWithTheFolder) {
    const test::TemporaryFolder folder;
    const auto made = [&](const std::string& name, const std::string& from) {
        EXPECT_EQ(test::makeSession(folder / name, {"--server", "--person", "Olga:operator", "--from", from})
                      .exit_code,
                  0);
        return folder / name + "/";
    };
    const std::string old = made("old", "2020-01-01"), coming = made("coming", "2099-01-01");
    expectRefused({"haptic_server", "--scene", "none", "--secure", old + "server"},
                  "server expired on 2020-01-31");
    expectRefused({"device_daemon", "--device", "pointer", "--secure", coming + "device"},
                  "device is not valid before 2099-01-01");
    expectRefused({"render_client", "--command", "pause", "--secure", old + "Olga"}, "Olga expired on");
    expectRefused({"render_client", "--command", "pause", "--secure", folder / "none"},
                  "there is no such folder");
    std::filesystem::remove(coming + "Olga/permissions.p7s");
    expectRefused({"render_client", "--command", "pause", "--secure", coming + "Olga"},
                  "permissions.p7s is missing");
    ASSERT_EQ(test::makeSession(folder / "now", {"--server", "--person", "Olga:operator"}).exit_code, 0);
    expectRefused({"haptic_server", "--scene", "none", "--secure", folder / "now/Olga"},
                  "needs the folder server");
    expectRefused({"render_client", "--command", "pause", "--secure", folder / "now/server"},
                  "needs a person's folder");
    for (const test::Words& program :
         {test::Words{"haptic_server", "--scene", "none", "--secure", folder / "now/server"},
          {"device_daemon", "--secure", folder / "now/device"},
          {"render_client", "--command", "pause", "--secure", folder / "now/Olga"}}) {
        test::Words of_another = program;
        of_another.insert(of_another.end(), {"--session", "8"});
        expectRefused(of_another,
                      "this folder was made for session 7, and this is session 8; give --session 7, or the "
                      "folder of session 8");
    }
}

// What these say to others is not encrypted.
TEST(RefusedStart, AClosedSessionIsNotSaidOpenlyToOtherPcs) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(test::makeSession(folder / "made", {"--server", "--person", "Olga:operator"}).exit_code, 0);
    const std::string olga = folder / "made/Olga";
    expectRefused({"bonemill_igtl", "--port", "0", "--address", "0.0.0.0", "--secure", olga},
                  "readable for everybody");
    for (const char* name : {"ROS_LOCALHOST_ONLY", "ROS_AUTOMATIC_DISCOVERY_RANGE"}) unsetenv(name);
    expectRefused({"bonemill_ros2", "--secure", olga, "--session", "7", "--seconds", "1"},
                  "readable for everybody");
}

}  // namespace
}  // namespace bonemill
