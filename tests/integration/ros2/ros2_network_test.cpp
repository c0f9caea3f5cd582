// A session on one PC, nodes of ROS 2 on another: poses and wrenches come at the loop's rate, the bone comes
// late, and the session's own topics stay on their PC.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "tests/integration/ros2/ros_session.h"
#include "tests/support/places.h"
#include "tests/support/virtual_network.h"

namespace bonemill {
namespace {

using Words = std::vector<std::string>;

// The program's name becomes its path, behind what the environment of a node is.
Words inRosNetwork(Words words, const std::string& folder) {
    words[0] = folder + "/" + words[0];
    const std::string domain = "ROS_DOMAIN_ID=" + std::to_string(test::rosTestDomain());
    words.insert(words.begin(), {"/usr/bin/env", "ROS_LOCALHOST_ONLY=0", domain});
    return words;
}

struct Counted {
    unsigned long messages = 0;
    double missing_percent = 100, rate_hz = 0;
};

Counted countOf(const std::string& line, const std::string& topic) {
    Counted counted;
    const size_t at = line.find(topic + ": ");
    if (at == std::string::npos ||
        std::sscanf(line.c_str() + at + topic.size() + 2, "%lu messages, %lf %% missing, %lf Hz",
                    &counted.messages, &counted.missing_percent, &counted.rate_hz) != 3)
        return {};
    return counted;
}

constexpr const char* kTopics[] = {"measured_cp", "measured_cf"};
constexpr unsigned long kMessagesAtLeast = 500;
constexpr double kMissingAtMost = 1;  // %

// What a node heard in 4 s; at most twice more where a busy machine took messages away.
test::Finished heardBy(const test::Host& host, const std::string& kind) {
    const std::string domain = std::to_string(test::rosTestDomain());
    test::Finished node;
    for (int round = 0; round < 3; ++round) {
        node = host.start(inRosNetwork({"ros_listener", kind, domain, "4"}, test::helperDir()))->wait();
        const bool is_enough = std::ranges::all_of(kTopics, [&](const char* topic) {
            const Counted counted = countOf(node.out, topic);
            return counted.messages > kMessagesAtLeast && counted.missing_percent <= kMissingAtMost;
        });
        if (is_enough) break;
        std::printf("round %d: %s", round, node.out.c_str());
    }
    return node;
}

TEST(Ros2Network, NodesOfAnotherPcHearEveryTickAndTheBoneLate) {
    if (const std::string missing = test::VirtualNetwork::enter(); !missing.empty()) GTEST_SKIP() << missing;
    test::VirtualNetwork network;
    const test::Host haptics_pc = network.addHost(), robot_pc = network.addHost();
    const test::RosSession session;
    const auto server = haptics_pc.start(session.serverWords());
    const auto daemon = haptics_pc.start(session.daemonWords("simulated"));
    const auto ros = haptics_pc.start(inRosNetwork(test::RosSession::rosWords(), test::binDir()));
    ASSERT_TRUE(test::waitFor([&] {
        return daemon->errSoFar().find("device is engaged") != std::string::npos;
    })) << daemon->errSoFar();
    for (const char* const kind : {"cyclone", "fast"}) {
        const test::Finished node = heardBy(robot_pc, kind);
        for (const char* const topic : kTopics) {
            const Counted counted = countOf(node.out, topic);
            EXPECT_GT(counted.messages, kMessagesAtLeast) << node.out << node.err << ros->errSoFar();
            EXPECT_LE(counted.missing_percent, kMissingAtMost) << kind << ": " << node.out;
        }
        unsigned long nodes = 0;
        EXPECT_EQ(std::sscanf(node.out.c_str() + std::min(node.out.find("bone: "), node.out.size()),
                              "bone: %lu", &nodes),
                  1);
        EXPECT_GT(nodes, kind == std::string("cyclone") ? 20u : 0u) << node.out;
        std::printf("%s: %s", kind, node.out.c_str());
    }
}

}  // namespace
}  // namespace bonemill
