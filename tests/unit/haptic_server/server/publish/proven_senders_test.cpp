#include <gtest/gtest.h>

#include "haptic_server/server/publish/command_inbox.h"

namespace bonemill {
namespace {

constexpr GuidPrefix kAnna{1}, kOtto{2}, kGate{3}, kStranger{4};

std::optional<Identity> personOf(const GuidPrefix& prefix) {
    if (prefix == kAnna) return Identity{"Anna", "instructor", prefix};
    if (prefix == kOtto) return Identity{"Otto", "observer", prefix};
    if (prefix == kGate) return Identity{"door", "gateway", prefix};
    return std::nullopt;
}

topics::Command claimOf(uint64_t sender) {
    topics::Command command;
    command.set_sender(sender);
    command.set_role(topics::Viewer::INSTRUCTOR);
    command.set_name("Boss");
    return command;
}

class ProvenSendersTest : public testing::Test {
  protected:
    topics::Command identified(uint64_t sender, const GuidPrefix& participant) {
        EXPECT_TRUE(senders_.mayUse(sender, participant));
        topics::Command command = claimOf(sender);
        senders_.identify(command, participant);
        return command;
    }
    ProvenSenders senders_{personOf};
};

TEST_F(ProvenSendersTest, TheCertificateCountsAndNotWhatTheCommandSays) {
    const topics::Command command = identified(7, kOtto);
    EXPECT_EQ(command.role(), topics::Viewer::VIEWER);
    EXPECT_EQ(command.name(), "Otto");
    EXPECT_EQ(senders_.proofOf(command), "proven");
    EXPECT_EQ(identified(8, kAnna).role(), topics::Viewer::INSTRUCTOR);
}

TEST_F(ProvenSendersTest, AGatewaySpeaksForItsGuests) {
    const topics::Command command = identified(7, kGate);
    EXPECT_EQ(command.role(), topics::Viewer::INSTRUCTOR);
    EXPECT_EQ(command.name(), "Boss");
    EXPECT_EQ(senders_.proofOf(command), "says gateway door");
}

TEST_F(ProvenSendersTest, WhoIsNotKnownOnlyLooks) {
    const topics::Command command = identified(7, kStranger);
    EXPECT_EQ(command.role(), topics::Viewer::VIEWER);
    EXPECT_EQ(command.name(), "");
}

TEST_F(ProvenSendersTest, NobodySendsWithTheNumberOfAnother) {
    identified(7, kAnna);
    EXPECT_FALSE(senders_.mayUse(7, kOtto));
    EXPECT_TRUE(senders_.mayUse(7, kAnna));
}

TEST_F(ProvenSendersTest, InventedNumbersFillOnlySoMuchMemory) {
    identified(7, kAnna);
    for (uint64_t sender = 100; sender < 10'000; ++sender) senders_.mayUse(sender, kOtto);
    EXPECT_FALSE(senders_.mayUse(20'000, kOtto));
    EXPECT_TRUE(senders_.mayUse(7, kAnna)) << "who was there is not driven out";
}

}  // namespace
}  // namespace bonemill
