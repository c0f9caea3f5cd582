// Runs deploy/check-network on machines that are only files: what does it say of each lack, and what is its
// exit code?
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;

const std::string kNet = "sys/class/net/eth3/";

// The PC is set up as well as can be for its interface eth3.
class CheckNetwork : public testing::Test {
  protected:
    CheckNetwork() {
        set("sys/class/net/lo/flags", "0x9\n");
        set(kNet + "flags", "0x1003\n");
        set(kNet + "carrier", "1\n");
        set(kNet + "speed", "1000\n");
        set(kNet + "mtu", "1500\n");
        set("proc/sys/net/core/rmem_max", "4194304\n");
        set("proc/sys/net/core/wmem_max", "4194304\n");
    }
    void set(const std::string& file, const std::string& content) {
        const std::filesystem::path path = root_ / file;
        std::filesystem::create_directories(path.parent_path());
        test::writeFile(path, content);
    }
    Finished check(const std::vector<std::string>& more = {"--interface", "eth3"}) {
        std::vector<std::string> arguments{test::sourceDir() + "/deploy/check-network", "--root",
                                           root_.path()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run(arguments);
    }
    // Nothing but this is found wanting: "MISSING  what: why", "better   what: why".
    void expectOnly(const std::string& line, const std::string& command) {
        const Finished finished = check();
        const bool is_needed = line.rfind("MISSING", 0) == 0;
        EXPECT_EQ(finished.exit_code, is_needed ? 1 : 0) << finished.out;
        EXPECT_NE(finished.out.find("  " + line), std::string::npos) << finished.out;
        EXPECT_NE(finished.out.find("\n             " + command), std::string::npos) << finished.out;
        EXPECT_EQ(lacks(finished), 1) << finished.out;
        EXPECT_EQ(finished.err, "");
    }
    static long lacks(const Finished& finished) {
        const std::regex lack("  (MISSING|better)  ");
        return std::distance(std::sregex_iterator(finished.out.begin(), finished.out.end(), lack), {});
    }

    test::TemporaryFolder root_;
};

TEST_F(CheckNetwork, AWellSetUpMachineLacksNothing) {
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(lacks(finished), 0) << finished.out;
    EXPECT_NE(finished.out.find("Nothing that is needed is missing; 0 to improve."), std::string::npos);
    EXPECT_NE(finished.out.find("UDP 7400 to 7539"), std::string::npos) << finished.out;
    EXPECT_NE(check({"--interface", "eth3", "--domain", "08"}).out.find("UDP 9400 to 9539"),
              std::string::npos);
}

TEST_F(CheckNetwork, AnUnpluggedCableIsMissing) {
    set(kNet + "carrier", "0\n");
    expectOnly("MISSING  link: no cable", "plug it in");
    set(kNet + "carrier", "1\n");
    set(kNet + "flags", "0x1002\n");
    expectOnly("MISSING  link: no cable", "plug it in");
}

TEST_F(CheckNetwork, AnInterfaceWithoutMulticastIsMissing) {
    set(kNet + "flags", "0x3\n");
    expectOnly("MISSING  multicast: the interface does not pass it",
               "sudo ip link set eth3 multicast on; or name the haptics PC with --peer ADDRESS");
}

TEST_F(CheckNetwork, WifiCouldBeBetter) {
    std::filesystem::create_directories(root_ / (kNet + "wireless"));
    expectOnly("better   a cable: multicast over Wi-Fi", "use a wired interface");
}

TEST_F(CheckNetwork, ASlowLinkCouldBeBetter) {
    set(kNet + "speed", "100\n");
    expectOnly("better   1000 Mbit/s: the link runs at 100",
               "check cable and switch; or give haptic_server --stream-mbit-per-s 50");
    set(kNet + "speed", "-1\n");
    EXPECT_EQ(lacks(check()), 0) << "a virtual interface has no speed";
}

TEST_F(CheckNetwork, SmallPacketsCouldBeBetter) {
    set(kNet + "mtu", "1400\n");
    expectOnly("better   packets of 1500 bytes: they are cut to 1400", "sudo ip link set eth3 mtu 1500");
}

TEST_F(CheckNetwork, SmallBuffersCouldBeBetter) {
    set("proc/sys/net/core/rmem_max", "212992\n");
    expectOnly("better   receive buffers: ", "echo 'net.core.rmem_max = 4194304'");
    set("proc/sys/net/core/rmem_max", "8388608\n");
    set("proc/sys/net/core/wmem_max", "212992\n");
    expectOnly("better   send buffers: ", "echo 'net.core.wmem_max = 4194304'");
}

TEST_F(CheckNetwork, WrongUseIsRefused) {
    const std::vector<std::vector<std::string>> wrong{{},
                                                      {"--interface"},
                                                      {"--interface", "eth4"},
                                                      {"--interface", "../net/eth3"},
                                                      {"--domain", "231"},
                                                      {"--domain", "one"},
                                                      {"--domain"},
                                                      {"--root", "/no/such"},
                                                      {"--root"},
                                                      {"--interfaces", "eth3"}};
    for (const auto& arguments : wrong) {
        const Finished finished = check(arguments);
        EXPECT_EQ(finished.exit_code, 2) << finished.out;
        EXPECT_EQ(finished.err.rfind("check-network: ", 0), 0u) << finished.err;
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
    }
    EXPECT_NE(check({}).err.find("this PC has: eth3\n"), std::string::npos);
    EXPECT_NE(check({"--interface", "eth4"}).err.find("no interface eth4; it has: eth3\n"),
              std::string::npos);
}

}  // namespace
}  // namespace bonemill
