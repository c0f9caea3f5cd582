#include "common/dds/network.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "common/base/user_error.h"
#include "common/dds/participant.h"
#include "tests/support/dds_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::dds {
namespace {

// Returns what is said when these options make no network.
std::string refusalOf(const NetworkOptions& options) {
    try {
        networkConfiguration(options);
        return "accepted";
    } catch (const UserError& error) {
        return error.what();
    }
}

void expectSays(const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
}

class Network : public testing::Test {
  protected:
    Network() { unsetenv("CYCLONEDDS_URI"); }
    ~Network() override {
        unsetenv("CYCLONEDDS_URI");
        setNetwork({});
    }
};

TEST_F(Network, OnePcIsTheDefault) {
    EXPECT_EQ(networkConfiguration({}), networkConfiguration({.profile = "one-pc"}));
    expectSays(networkConfiguration({}), {"name=\"lo\""});
}

TEST_F(Network, LanProfilesTakeTheAddressOfTheInterface) {
    const std::vector<NetworkInterface> interfaces = networkInterfaces();
    if (interfaces.empty()) GTEST_SKIP() << "this PC has no network interface";
    for (const std::string profile : {"lab", "classroom"}) {
        const std::string text = networkConfiguration({profile, interfaces.front().name, {}});
        expectSays(text, {"address=\"" + interfaces.front().address + "\""});
        EXPECT_EQ(text.find("address=\"$"), std::string::npos) << text;
        EXPECT_TRUE(isLanProfile(profile));
    }
    EXPECT_FALSE(isLanProfile("one-pc"));
}

TEST_F(Network, PeersSwitchMulticastOff) {
    const std::vector<NetworkInterface> interfaces = networkInterfaces();
    if (interfaces.empty()) GTEST_SKIP() << "this PC has no network interface";
    const std::string text =
        networkConfiguration({"lab", interfaces.front().name, {"10.77.0.1", "127.0.0.1"}});
    expectSays(text, {"<AllowMulticast>false<", "<Peer Address=\"10.77.0.1\"/><Peer Address=\"127.0.0.1\"/>",
                      "priority=\"3\""});
}

TEST_F(Network, AMissingOrWrongInterfaceIsNamedBesideThoseThatAreThere) {
    const std::string there = textOf(networkInterfaces());
    for (const std::string profile : {"lab", "classroom"}) {
        expectSays(refusalOf({profile, "", {}}), {"--profile " + profile, "--interface", there});
        expectSays(refusalOf({profile, "no7", {}}), {"--interface no7", there});
    }
    EXPECT_EQ(textOf({}), "none with an IPv4 address");
    EXPECT_EQ(textOf({{"eth0", "10.0.0.1", true}, {"wlan0", "10.0.0.2", false}}),
              "eth0 (10.0.0.1), wlan0 (10.0.0.2, down)");
}

TEST_F(Network, OptionsThatDoNotGoTogetherAreRefused) {
    expectSays(refusalOf({"labb", "", {}}), {"--profile labb", "one-pc, lab, classroom"});
    expectSays(refusalOf({"", "eth0", {}}), {"--interface eth0", "--profile lab"});
    expectSays(refusalOf({"one-pc", "", {"10.0.0.1"}}), {"--peer 10.0.0.1", "--profile lab"});
    expectSays(refusalOf({"./no_such.xml", "", {}}), {"./no_such.xml", "cannot be read"});
    const std::vector<NetworkInterface> interfaces = networkInterfaces();
    if (!interfaces.empty())
        expectSays(refusalOf({"lab", interfaces.front().name, {"no such pc"}}), {"--peer no such pc"});
}

TEST_F(Network, CyclonesOwnVariableReplacesTheProfile) {
    setenv("CYCLONEDDS_URI", "<CycloneDDS/>", 1);
    EXPECT_EQ(networkConfiguration({}), "");
    expectSays(refusalOf({"lab", "eth0", {}}), {"--profile lab", "CYCLONEDDS_URI"});
    expectSays(refusalOf({"", "eth0", {}}), {"--interface", "CYCLONEDDS_URI"});
    expectSays(refusalOf({"", "", {"10.0.0.1"}}), {"--peer", "CYCLONEDDS_URI"});
}

TEST_F(Network, AFileIsAProfileToo) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "own.xml";
    const auto write = [&](const std::string& text) {
        std::FILE* file = std::fopen(path.c_str(), "w");
        std::fputs(text.c_str(), file);
        std::fclose(file);
    };
    write(networkConfiguration({}));
    setNetwork({.profile = path});
    EXPECT_NO_THROW(Participant{testDomain() + 2});
    write("<CycloneDDS><Domain><NoSuchElement/></Domain></CycloneDDS>");
    setNetwork({.profile = path});
    EXPECT_THROW(Participant{testDomain() + 2}, UserError);
}

}  // namespace
}  // namespace bonemill::dds
