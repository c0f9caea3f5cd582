// Who may start on a link, and what becomes of what lies there.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

constexpr LinkSide kSides[] = {LinkSide::kServer, LinkSide::kDaemon};

void writeHeader(RawMemory& memory, uint64_t magic, uint32_t version, uint32_t size) {
    memory.write(LinkHeader{magic, version, size}, 0);
}

TEST(LinkStart, theLastToLeaveRemovesEverything) {
    for (const LinkSide first : kSides) {
        const TestSession session;
        {
            const DeviceLink one = session.open(first);
            { const DeviceLink other = session.open(peerOf(first)); }
            EXPECT_TRUE(session.hasMemory() && session.hasSemaphores());
        }
        EXPECT_FALSE(session.hasMemory() || session.hasSemaphores());
    }
}

TEST(LinkStart, aMovedLinkLeavesOnce) {
    const TestSession session;
    DeviceLink first = session.open(LinkSide::kServer);
    const DeviceLink second = std::move(first);
    const DeviceLink daemon = session.open(LinkSide::kDaemon);
    EXPECT_TRUE(daemon.peerIsAlive());
}

TEST(LinkStart, oneProcessHoldsManyLinks) {
    const std::vector<TestSession> sessions(8);
    std::vector<DeviceLink> links;
    for (const TestSession& session : sessions) {
        for (const LinkSide side : kSides) links.push_back(session.open(side));
    }
    links.pop_back();
    EXPECT_FALSE(links.back().peerIsAlive());
    links.pop_back();
    for (const DeviceLink& link : links) EXPECT_TRUE(link.peerIsAlive());
}

TEST(LinkStart, aRestartedSideCountsOnAndFindsThePeersContent) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    server.writeCommand({});
    for (uint64_t start = 1; start <= 3; ++start) {
        DeviceLink daemon = session.open(LinkSide::kDaemon);
        EXPECT_EQ(daemon.writeSample({}), start);
        WrenchCommand command{};
        EXPECT_TRUE(daemon.readCommand(command));
        EXPECT_EQ(command.sequence, 1u);
    }
}

TEST(LinkStart, aTakenSideIsRefusedAndGoesOn) {
    for (const LinkSide side : kSides) {
        const TestSession session;
        DeviceLink holder = session.open(side);
        const std::string refusal = session.refusalOf(side);
        EXPECT_TRUE(says(refusal, std::string("another ") + programOf(side))) << refusal;
        EXPECT_TRUE(says(refusal, "process " + std::to_string(getpid()))) << refusal;
        const DeviceLink peer = session.open(peerOf(side));
        EXPECT_TRUE(peer.peerIsAlive());
    }
}

TEST(LinkStart, theDaemonLearnsWhichSceneIsInForce) {
    const TestSession session;
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    SceneNotice notice{};
    EXPECT_FALSE(daemon.readScene(notice));
    {
        DeviceLink server = session.open(LinkSide::kServer);
        EXPECT_EQ(server.announceScene("/scenes/tooth.textproto", 7), 1u);
        ASSERT_TRUE(daemon.readScene(notice));
        EXPECT_EQ(notice.revision, 1u);
        EXPECT_EQ(notice.hash, 7u);
        EXPECT_STREQ(notice.path, "/scenes/tooth.textproto");
        EXPECT_THROW(server.announceScene("/" + std::string(1023, 'a'), 8), UserError);
    }
    DeviceLink again = session.open(LinkSide::kServer);
    EXPECT_EQ(again.announceScene("/s", 7), 2u) << "a server that is started anew counts on";
    ASSERT_TRUE(daemon.readScene(notice));
    EXPECT_STREQ(notice.path, "/s");
}

TEST(LinkStart, theDaemonLearnsWhenAttemptsBeginAndEnd) {
    const TestSession session;
    const DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceLink server = session.open(LinkSide::kServer);
    server.announceAttempt(true);
    SceneNotice notice{};
    EXPECT_FALSE(daemon.readScene(notice)) << "there is no scene to attempt";
    server.announceScene("/scenes/tooth.textproto", 7, 99);
    const auto changesAfter = [&](bool begins) {
        server.announceAttempt(begins);
        EXPECT_TRUE(daemon.readScene(notice));
        EXPECT_EQ(notice.hash, 7u);
        EXPECT_EQ(notice.revision, 1u);
        EXPECT_EQ(notice.epoch, 99u);
        return notice.attempt_changes;
    };
    EXPECT_EQ(changesAfter(false), 0u) << "none is under way";
    EXPECT_EQ(changesAfter(true), 1u);
    EXPECT_EQ(changesAfter(true), 3u) << "one after the other";
    EXPECT_EQ(changesAfter(false), 4u);
    EXPECT_EQ(changesAfter(true), 5u);
    server.announceScene("/scenes/skull.textproto", 8);
    ASSERT_TRUE(daemon.readScene(notice));
    EXPECT_EQ(notice.attempt_changes, 6u) << "another scene ends it";
}

TEST(LinkStart, theDaemonLearnsWhichHandIsWantedAndWhenItsScriptBeginsAnew) {
    const TestSession session;
    const DeviceLink daemon = session.open(LinkSide::kDaemon);
    DeviceLink server = session.open(LinkSide::kServer);
    server.announceHand(HandChoice::kPointer);
    SceneNotice notice{};
    EXPECT_FALSE(daemon.readScene(notice)) << "there is no scene to be the hand of";
    server.announceScene("/scenes/tooth.textproto", 7, 99);
    const auto wanted = [&] {
        EXPECT_TRUE(daemon.readScene(notice));
        EXPECT_EQ(notice.revision, 1u);
        EXPECT_EQ(notice.epoch, 99u);
        return std::pair(HandChoice(notice.hand), notice.hand_repeats);
    };
    EXPECT_EQ(wanted(), std::pair(HandChoice::kOwn, 0u));
    server.announceHand(HandChoice::kOwn);
    EXPECT_EQ(wanted(), std::pair(HandChoice::kOwn, 1u));
    server.announceHand(HandChoice::kPointer);
    server.announceAttempt(true);
    EXPECT_EQ(wanted(), std::pair(HandChoice::kPointer, 1u));
    server.announceHand(HandChoice::kOwn);
    EXPECT_EQ(wanted(), std::pair(HandChoice::kOwn, 2u));
    server.announceHand(HandChoice::kPointer);
    server.announceScene("/scenes/skull.textproto", 8);
    ASSERT_TRUE(daemon.readScene(notice));
    EXPECT_EQ(HandChoice(notice.hand), HandChoice::kOwn) << "another scene has a hand of its own";
    EXPECT_EQ(notice.hand_repeats, 2u);
    notice.hand = 2;
    EXPECT_FALSE(isPlausible(notice)) << "there is no such hand";
}

TEST(LinkStart, aSceneThatNobodyCanMeanIsNotBelieved) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    const DeviceLink daemon = session.open(LinkSide::kDaemon);
    server.announceScene("/scenes/tooth.textproto", 7);
    SceneNotice notice{};
    ASSERT_TRUE(daemon.readScene(notice));
    const RawMemory memory(session);
    unsigned char* path =
        std::search(memory.bytes(), memory.bytes() + sizeof(LinkMemory), notice.path, notice.path + 7);
    for (const char bad : {'s', '\x1b', '\n'}) {
        path[bad == 's' ? 0 : 1] = (unsigned char)bad;
        EXPECT_FALSE(daemon.readScene(notice)) << int(bad);
        std::memcpy(path, "/scenes", 7);
    }
    ASSERT_TRUE(daemon.readScene(notice));
    std::memset(path, 'a', sizeof notice.path);
    path[0] = '/';
    EXPECT_FALSE(daemon.readScene(notice)) << "it does not end";
}

TEST(LinkStart, memoryOfTheDeadIsTakenOverEmpty) {
    const TestSession session;
    RawMemory dead(session, 64);  // left behind by another release
    writeHeader(dead, kLinkMagic, kLinkLayoutVersion + 1, 64);
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceSample sample{};
    EXPECT_FALSE(server.readSample(sample));
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    EXPECT_EQ(daemon.writeSample({}), 1u);
    EXPECT_TRUE(server.readSample(sample));
}

TEST(LinkStart, foreignMemoryIsRefusedAndLeftAlone) {
    const TestSession session;
    const RawMemory foreign(session);
    const char text[] = "somebody else's data, long enough for a header";
    std::memcpy(foreign.bytes(), text, sizeof(text));
    const std::string refusal = session.refusalOf(LinkSide::kDaemon);
    EXPECT_TRUE(says(refusal, "not a bonemill device link") && says(refusal, "ipcrm -M 0x")) << refusal;
    const RawMemory again(session);
    EXPECT_STREQ(reinterpret_cast<const char*>(again.bytes()), text);
    EXPECT_FALSE(session.hasSemaphores());
}

TEST(LinkStart, foreignSemaphoresAreRefused) {
    for (const int count : {1, kLinkSemaphoreCount + 1}) {
        const TestSession session;
        ASSERT_GE(semget(session.key(), count, IPC_CREAT | 0600), 0);
        const std::string refusal = session.refusalOf(LinkSide::kDaemon);
        EXPECT_TRUE(says(refusal, "another program") && says(refusal, "ipcrm -S 0x")) << refusal;
        EXPECT_TRUE(session.hasSemaphores());
    }
}

TEST(LinkStart, aLivingPeerOfAnotherVersionIsNamed) {
    const TestSession session;
    const HeldSemaphore living(session, kServerSemaphore);
    RawMemory memory(session);
    writeHeader(memory, kLinkMagic, kLinkLayoutVersion + 1, sizeof(LinkMemory));
    const std::string refusal = session.refusalOf(LinkSide::kDaemon);
    const std::string versions = "layout version " + std::to_string(kLinkLayoutVersion + 1) +
                                 ", this device_daemon needs " + std::to_string(kLinkLayoutVersion);
    EXPECT_TRUE(says(refusal, versions)) << refusal;
    EXPECT_TRUE(says(refusal, "haptic_server of the same release")) << refusal;
}

TEST(LinkStart, aLivingPeerWithAnotherSizeOrMagicIsRefused) {
    const TestSession session;
    const HeldSemaphore living(session, kDaemonSemaphore);
    EXPECT_TRUE(says(session.refusalOf(LinkSide::kServer), "removed its memory"));
    RawMemory memory(session, 32);
    writeHeader(memory, kLinkMagic, kLinkLayoutVersion, sizeof(LinkMemory) + 8);
    EXPECT_TRUE(says(session.refusalOf(LinkSide::kServer), "wrong size"));
    writeHeader(memory, kLinkMagic, kLinkLayoutVersion, sizeof(LinkMemory));  // says so, but it is shorter
    EXPECT_TRUE(says(session.refusalOf(LinkSide::kServer), "wrong size"));
    writeHeader(memory, ~kLinkMagic, kLinkLayoutVersion, sizeof(LinkMemory));
    EXPECT_TRUE(says(session.refusalOf(LinkSide::kServer), "wrong magic"));
}

// Somebody removes the memory under the two, as far as anybody can.
TEST(LinkStart, removedMemoryServesWhoHasIt) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    RawMemory(session).remove();
    daemon.writeSample({});
    DeviceSample sample{};
    EXPECT_TRUE(server.readSample(sample));
}

TEST(LinkStart, whoIsStuckInTheSetUpHoldsNobodyForEver) {
    const TestSession session;
    const HeldSemaphore stuck(session, kSetupSemaphore);
    const std::string refusal = session.refusalOf(LinkSide::kServer);
    EXPECT_TRUE(says(refusal, "process " + std::to_string(getpid()) + " is stuck")) << refusal;
}

TEST(LinkStart, whoIsStuckInTheSetUpKeepsNobodyFromLeaving) {
    const TestSession session;
    std::optional<HeldSemaphore> stuck;
    {
        const DeviceLink server = session.open(LinkSide::kServer);
        stuck.emplace(session, kSetupSemaphore);
    }
    EXPECT_TRUE(session.hasMemory());
    stuck.reset();
    EXPECT_EQ(session.refusalOf(LinkSide::kServer), "");
    EXPECT_FALSE(session.hasMemory() || session.hasSemaphores());
}

TEST(LinkStart, theSessionWithoutAKeyIsRefused) {
    const uint32_t session = uint32_t(linkKeyOf(0));
    ASSERT_EQ(linkKeyOf(session), IPC_PRIVATE);
    EXPECT_THROW(DeviceLink::create(session, LinkSide::kServer), UserError);
}

}  // namespace
}  // namespace bonemill
