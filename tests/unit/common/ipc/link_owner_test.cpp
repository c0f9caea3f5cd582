// Nobody is believed who is another user, or lets others in.
#include <gtest/gtest.h>

#include <sstream>

#include "tests/unit/common/ipc/child.h"
#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

constexpr uid_t kNobody = 65534;
constexpr char kNobodyText[] = "(uid 65534)";

// Does something as the user nobody, in a process that has ended when it returns.
int asNobody(const std::function<int()>& body) {
    Child child([&] { return setgid(kNobody) == 0 && setuid(kNobody) == 0 ? body() : 98; });
    return child.exitCode();
}

// Only root can become another user.
class LinkOfOthers : public testing::Test {
  protected:
    void SetUp() override {
        if (geteuid() != 0) GTEST_SKIP() << "needs root, to become another user";
    }
    const TestSession session_;
};

TEST_F(LinkOfOthers, MemoryOfAnotherUserIsRefused) {
    const int result = asNobody([&] {
        RawMemory memory(session_, sizeof(LinkMemory), 0666);
        memory.write(LinkHeader{kLinkMagic, kLinkLayoutVersion, sizeof(LinkMemory)}, 0);
        return kSuccess;
    });
    ASSERT_EQ(result, kSuccess);
    const std::string refusal = session_.refusalOf(LinkSide::kServer);
    EXPECT_TRUE(says(refusal, "memory belongs to") && says(refusal, kNobodyText)) << refusal;
    EXPECT_TRUE(says(refusal, "ipcrm -M 0x")) << refusal;
    EXPECT_TRUE(session_.hasMemory());
    EXPECT_FALSE(session_.hasSemaphores());
}

TEST_F(LinkOfOthers, MemoryThatAnotherUserGaveAwayIsRefused) {
    const int result = asNobody([&] {
        const int id = shmget(session_.key(), sizeof(LinkMemory), IPC_CREAT | 0600);
        shmid_ds status{};
        status.shm_perm.mode = 0600;  // and owner 0
        return shmctl(id, IPC_SET, &status);
    });
    ASSERT_EQ(result, kSuccess);
    const std::string refusal = session_.refusalOf(LinkSide::kServer);
    EXPECT_TRUE(says(refusal, kNobodyText)) << refusal;
}

TEST_F(LinkOfOthers, SemaphoresOfAnotherUserAreRefused) {
    const int result = asNobody(
        [&] { return semget(session_.key(), kLinkSemaphoreCount, IPC_CREAT | 0666) >= 0 ? kSuccess : 1; });
    ASSERT_EQ(result, kSuccess);
    const std::string refusal = session_.refusalOf(LinkSide::kServer);
    EXPECT_TRUE(says(refusal, "semaphores belongs to") && says(refusal, kNobodyText)) << refusal;
    EXPECT_TRUE(says(refusal, "ipcrm -S 0x")) << refusal;
    EXPECT_FALSE(session_.hasMemory());
}

TEST_F(LinkOfOthers, AnotherUserIsToldWhoseTheLinkIs) {
    const auto isToldOfRoot = [&] {
        const std::string refusal = session_.refusalOf(LinkSide::kDaemon);
        return says(refusal, "belongs to root (uid 0)") ? kSuccess : 1;
    };
    const DeviceLink server = session_.open(LinkSide::kServer);
    EXPECT_EQ(asNobody(isToldOfRoot), kSuccess);
    EXPECT_FALSE(server.peerIsAlive());
    // What another user's processes have left when they died.
    const TestSession left;
    const RawMemory memory(left);
    EXPECT_EQ(asNobody([&] {
                  return says(left.refusalOf(LinkSide::kDaemon), "memory belongs to root (uid 0)") ? kSuccess
                                                                                                   : 1;
              }),
              kSuccess);
}

TEST(LinkOwner, WhatIsOpenToOthersIsRefused) {
    for (const int mode : {0666, 0640, 0602}) {
        std::ostringstream mode_text;
        mode_text << "mode 0" << std::oct << mode;
        const TestSession with_memory, with_semaphores;
        const RawMemory memory(with_memory, sizeof(LinkMemory), mode);
        const HeldSemaphore held(with_semaphores, kDaemonSemaphore, mode);
        for (const TestSession* session : {&with_memory, &with_semaphores}) {
            const std::string refusal = session->refusalOf(LinkSide::kServer);
            EXPECT_TRUE(says(refusal, "open to other users") && says(refusal, mode_text.str())) << refusal;
        }
    }
}

}  // namespace
}  // namespace bonemill
