#include <gtest/gtest.h>

#include "render_client/link/subscribe/heard_peers.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

const ViewerList::Clock::time_point kHeard{100s};

topics::Viewer viewer(uint64_t sender, const std::string& name = "") {
    topics::Viewer viewer;
    viewer.set_sender(sender);
    viewer.set_name(name);
    return viewer;
}

TEST(ViewerList, ForgetsWhoIsSilent) {
    ViewerList list;
    list.hear(viewer(1), 7, kHeard);
    list.hear(viewer(2), 8, kHeard + 3s);
    list.forgetSilent(kHeard + 5s);
    ASSERT_EQ(list.viewers().size(), 1u);
    EXPECT_EQ(list.viewers()[0].sender(), 2u);
}

TEST(ViewerList, AParticipantSpeaksForFewAndForNoneOfAnothers) {
    ViewerList list;
    list.hear(viewer(1, "Anna"), 7, kHeard);
    for (uint64_t sender = 1; sender < 5000; ++sender)
        list.hear(viewer(sender, "forged"), 8, kHeard + sender * 1us);
    ASSERT_EQ(list.viewers().size(), 1 + ViewerList::kMaxOfParticipant);
    EXPECT_EQ(list.viewers()[0].name(), "Anna");
    EXPECT_EQ(list.viewers().back().sender(), 4999u) << "the last that it speaks for";
    list.hear(viewer(6000), 9, kHeard);
    EXPECT_EQ(list.viewers().back().sender(), 6000u) << "there is room for others";
}

TEST(ViewerList, ManyWhoInventViewersKeepOutNobody) {
    ViewerList list;
    for (uint64_t sender = 100; sender < 2000; ++sender)
        list.hear(viewer(sender, "forged"), 8 + sender % 32, kHeard + sender * 1us);
    EXPECT_EQ(list.viewers().size(), ViewerList::kMaxViewers);
    list.hear(viewer(1, "Anna"), 7, kHeard);
    for (uint64_t sender = 2000; sender < 4000; ++sender)
        list.hear(viewer(sender, "forged"), 8 + sender % 32, kHeard + sender * 1us);
    EXPECT_EQ(list.viewers().size(), ViewerList::kMaxViewers);
    EXPECT_EQ(list.viewers()[0].name(), "Anna");
}

}  // namespace
}  // namespace bonemill
