// Two servers of one session, as when two halves of a network find each other: who is shown, and is it told?
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <memory>
#include <thread>

#include "haptic_server/server/publish/publisher.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/link/subscribe/session_list.h"
#include "tests/support/dds_session.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr uint64_t kFirstEpoch = 1'700'000'000'000'000'000, kSecondEpoch = kFirstEpoch + 1;

topics::Status statusOf(const std::string& scene) {
    topics::Status status;
    status.set_scene(scene);
    return status;
}

bool pollUntil(
    SceneSubscriber& viewer, const std::function<bool()>& condition,
    const std::function<void()>& meanwhile = [] {}) {
    const auto end = std::chrono::steady_clock::now() + 30s;
    while (std::chrono::steady_clock::now() < end) {
        meanwhile();
        viewer.poll();
        if (condition()) return true;
        viewer.waitForData(20ms);
    }
    return false;
}

TEST(TwoServers, TheViewerStaysWithTheOneItHasAndTellsOfTheOther) {
    SceneSubscriber viewer({.domain = testDomain(), .session = testSession(), .name = "viewer"});
    auto first = std::make_unique<Publisher>(
        PublisherOptions{.domain = testDomain(), .session = testSession(), .epoch = kFirstEpoch});
    const auto shows = [&](const std::string& scene) {
        return viewer.status() && viewer.status()->scene() == scene;
    };
    ASSERT_TRUE(pollUntil(
        viewer, [&] { return shows("first"); }, [&] { first->publishStatus(statusOf("first")); }));
    EXPECT_FALSE(viewer.otherServer());

    Publisher second({.domain = testDomain(), .session = testSession(), .epoch = kSecondEpoch});
    bool has_stayed = true;
    const auto both = [&] {
        first->publishStatus(statusOf("first"));
        second.publishStatus(statusOf("second"));
        has_stayed = has_stayed && shows("first") && viewer.epoch() == kFirstEpoch;
    };
    ASSERT_TRUE(pollUntil(
        viewer, [&] { return viewer.otherServer().has_value(); }, both));
    EXPECT_EQ(viewer.otherServer(), "second");
    EXPECT_TRUE(has_stayed);

    // What the second has shown meanwhile was refused, and comes from its history.
    first.reset();
    ASSERT_TRUE(pollUntil(viewer, [&] { return shows("second"); }));
    EXPECT_EQ(viewer.epoch(), kSecondEpoch);
}

TEST(TwoServers, AnOlderOneThatLivesFollowsANewerThatHasGone) {
    SceneSubscriber viewer({.domain = testDomain(), .session = testSession(), .name = "viewer"});
    auto newer = std::make_unique<Publisher>(
        PublisherOptions{.domain = testDomain(), .session = testSession(), .epoch = kSecondEpoch});
    const auto shows = [&](const std::string& scene) {
        return viewer.status() && viewer.status()->scene() == scene;
    };
    ASSERT_TRUE(pollUntil(
        viewer, [&] { return shows("newer"); }, [&] { newer->publishStatus(statusOf("newer")); }));
    Publisher older({.domain = testDomain(), .session = testSession(), .epoch = kFirstEpoch});
    ASSERT_TRUE(pollUntil(
        viewer, [&] { return viewer.otherServer().has_value(); },
        [&] {
            newer->publishStatus(statusOf("newer"));
            older.publishStatus(statusOf("older"));
        }));
    EXPECT_EQ(viewer.epoch(), kSecondEpoch);
    newer.reset();
    ASSERT_TRUE(pollUntil(viewer, [&] { return shows("older"); }));
    EXPECT_EQ(viewer.epoch(), kFirstEpoch);
}

TEST(TwoServers, AViewerThatSleptKeepsItsServer) {
    SceneSubscriber viewer({.domain = testDomain(), .session = testSession(), .name = "viewer"});
    Publisher first({.domain = testDomain(), .session = testSession(), .epoch = kFirstEpoch});
    ASSERT_TRUE(pollUntil(
        viewer, [&] { return viewer.status().has_value(); },
        [&] { first.publishStatus(statusOf("first")); }));
    Publisher second({.domain = testDomain(), .session = testSession(), .epoch = kSecondEpoch});
    for (int n = 0; n < 10; ++n) {  // the second one is refused
        second.publishStatus(statusOf("second"));
        viewer.poll();
        std::this_thread::sleep_for(20ms);
    }
    std::this_thread::sleep_for(SceneSubscriber::kServerTimeout + 100ms);
    first.publishStatus(statusOf("first"));
    second.publishStatus(statusOf("second"));
    std::this_thread::sleep_for(50ms);
    for (int n = 0; n < 5; ++n) {
        viewer.poll();
        ASSERT_EQ(viewer.epoch(), kFirstEpoch);
        std::this_thread::sleep_for(20ms);
    }
    EXPECT_TRUE(viewer.hasServer());
}

TEST(SessionList, NamesEverySessionWithSceneStartAndHost) {
    SessionList list(testDomain());
    Publisher one({.domain = testDomain(), .session = testSession(), .epoch = kFirstEpoch});
    Publisher other({.domain = testDomain(), .session = testSession() + 1, .epoch = kSecondEpoch});
    std::vector<ListedSession> sessions;
    for (int n = 0; n < 1000 && sessions.size() < 2; ++n) {
        one.publishStatus(statusOf("tooth"));
        other.publishStatus(statusOf("skull"));
        std::this_thread::sleep_for(10ms);
        list.poll();
        sessions = list.sessions();
    }
    ASSERT_EQ(sessions.size(), 2u);
    EXPECT_EQ(sessions[0].session, testSession());
    EXPECT_EQ(sessions[0].scene, "tooth");
    EXPECT_EQ(sessions[0].epoch_ns, kFirstEpoch);
    EXPECT_EQ(sessions[1].scene, "skull");
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    EXPECT_EQ(sessions[0].host, host);
    const std::string text = sessionText(sessions[0]);
    EXPECT_EQ(text.rfind("session " + std::to_string(testSession()) + ": tooth since ", 0), 0u) << text;
    EXPECT_NE(text.find(std::string(" on ") + host), std::string::npos) << text;
}

}  // namespace
}  // namespace bonemill
