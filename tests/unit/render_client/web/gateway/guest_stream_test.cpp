// What a guest is sent, over links that are simulated: nothing here waits.
#include "render_client/web/gateway/guest_stream.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>

namespace bonemill::gateway {
namespace {

using namespace std::chrono_literals;
using Clock = GuestStream::Clock;

// Carries so many bytes per second, each way with this delay, as a queue does.
struct Link {
    double bytes_per_s;
    Clock::duration delay;
    struct Packet {
        std::string bytes;
        Clock::time_point arrives;
    };
    std::deque<Packet> packets;
    Clock::time_point free;

    void send(std::string bytes, Clock::time_point now) {
        free = std::max(free, now) + std::chrono::duration_cast<Clock::duration>(
                                         std::chrono::duration<double>(double(bytes.size()) / bytes_per_s));
        packets.push_back({std::move(bytes), free + delay});
    }
};

struct Session {
    SessionState state;
    Clock::time_point now{1h};

    SessionChanges node(uint32_t leaf, uint32_t revision, size_t bytes) {
        state.nodes[leaf] = {std::make_shared<const std::string>(bytes, 'n'), revision,
                             Eigen::Vector3f(float(leaf), 0, 0)};
        SessionChanges changes;
        changes.nodes = {leaf};
        return changes;
    }
    SessionChanges small(Topic topic, uint64_t key, std::string payload) {
        state.small[{topic, key}] = std::make_shared<const std::string>(std::move(payload));
        SessionChanges changes;
        changes.small = {{topic, key}};
        return changes;
    }
    // The stamp says when it was.
    SessionChanges tool(double removed_mm3 = 0, uint32_t events = 0) {
        state.tool_state.emplace();
        state.tool_state->set_stamp_ns(now.time_since_epoch().count());
        SessionChanges changes;
        changes.has_tool_state = true;
        if (removed_mm3 > 0 || events != 0) {
            changes.counted.emplace();
            changes.counted->set_removed_mm3(removed_mm3);
            changes.counted->set_events(events);
            *state.tool_state->mutable_effects() = *changes.counted;
        }
        return changes;
    }
};

Samples samplesOf(const std::string& bytes) {
    ToGuest frame;
    EXPECT_TRUE(frame.ParseFromString(bytes));
    return frame.samples();
}

GuestStream quickStream(const Session& session, const Hello& hello = {}) {
    return {session.state, hello, 1e9, session.now};
}

struct Transfer {
    Clock::duration oldest_tool{};  // on arrival, behind the first two seconds
    double seconds = 0;             // until the model was there
};

// Sends a model of 4 MB, and the tool 100 times per second, over the link.
Transfer transferOver(Link link, double budget_bytes_per_s = 1e9) {
    Session session;
    constexpr uint32_t kNodes = 800;
    for (uint32_t leaf = 0; leaf < kNodes; ++leaf) session.node(leaf, 1, 5000);
    const auto start = session.now;
    GuestStream stream(session.state, {}, budget_bytes_per_s, start);
    Transfer transfer;
    uint64_t received = 0;
    std::deque<std::pair<Clock::time_point, uint64_t>> answers;
    for (uint32_t nodes = 0; nodes < kNodes && session.now - start < 120s; session.now += 5ms) {
        if ((session.now - start).count() % std::chrono::nanoseconds(10ms).count() == 0)
            stream.note(session.tool());
        for (std::string frame; !(frame = stream.next(session.now)).empty();) link.send(frame, session.now);
        for (; !link.packets.empty() && link.packets.front().arrives <= session.now;
             link.packets.pop_front()) {
            received += link.packets.front().bytes.size();
            answers.emplace_back(session.now + link.delay, received);
            const Samples samples = samplesOf(link.packets.front().bytes);
            for (const Sample& sample : samples.samples()) {
                nodes += sample.topic() == Sample::NODE_MESH;
                topics::ToolState tool;
                if (sample.topic() != Sample::TOOL_STATE || session.now - start < 2s) continue;
                EXPECT_TRUE(tool.ParseFromString(sample.payload()));
                const auto age = session.now.time_since_epoch() - std::chrono::nanoseconds(tool.stamp_ns());
                transfer.oldest_tool = std::max<Clock::duration>(transfer.oldest_tool, age);
            }
        }
        for (; !answers.empty() && answers.front().first <= session.now; answers.pop_front())
            EXPECT_TRUE(stream.acknowledge(answers.front().second, session.now));
        transfer.seconds = std::chrono::duration<double>(session.now - start).count();
    }
    return transfer;
}

TEST(GuestStream, OnASlowLinkTheToolStaysFreshWhileAModelComes) {
    const Transfer slow = transferOver({.bytes_per_s = 250e3, .delay = 30ms, .packets = {}, .free = {}});
    EXPECT_LT(slow.oldest_tool, 600ms);
    EXPECT_LT(slow.seconds, 1.15 * 4e6 / 250e3) << "the link is used";
    const Transfer far = transferOver({.bytes_per_s = 2.5e6, .delay = 150ms, .packets = {}, .free = {}});
    EXPECT_LT(far.oldest_tool, 800ms);
    EXPECT_LT(far.seconds, 2 * 4e6 / 2.5e6 + 1);
    const Transfer quick = transferOver({.bytes_per_s = 100e6, .delay = 1ms, .packets = {}, .free = {}});
    EXPECT_LT(quick.seconds, 1);
}

TEST(GuestStream, IsNotSentMoreThanItsShare) {
    const Transfer shared =
        transferOver({.bytes_per_s = 100e6, .delay = 1ms, .packets = {}, .free = {}}, 1e6);
    EXPECT_GT(shared.seconds, 0.8 * 4e6 / 1e6);
    EXPECT_LT(shared.seconds, 1.2 * 4e6 / 1e6);
}

TEST(GuestStream, WhoAcknowledgesNothingIsSentABoundedAmountAndIsStalled) {
    Session session;
    for (uint32_t leaf = 0; leaf < 1000; ++leaf) session.node(leaf, 1, 5000);
    GuestStream stream = quickStream(session);
    size_t sent = 0;
    for (int n = 0; n < 10000; ++n) {
        session.now += 2ms;
        stream.note(session.tool());
        sent += stream.next(session.now).size();
    }
    EXPECT_LE(sent, SendWindow::kFirst + GuestStream::kMaxTogether);
    EXPECT_FALSE(stream.isStalled(session.now));
    session.now += 11s;
    EXPECT_TRUE(stream.isStalled(session.now));
    EXPECT_TRUE(stream.acknowledge(1, session.now));
    EXPECT_FALSE(stream.isStalled(session.now));
    EXPECT_FALSE(stream.acknowledge(sent + 1, session.now)) << "nobody can have received that";
    EXPECT_FALSE(stream.acknowledge(0, session.now));
}

TEST(GuestStream, WhatIsNewestComesOnceAndWhatWasOvertakenNever) {
    Session session;
    GuestStream stream = quickStream(session);
    ASSERT_FALSE(stream.next(session.now).empty()) << "whether there is a server";
    for (int n = 0; n < 5; ++n) {
        stream.note(session.small(Sample::STATUS, 0, "status " + std::to_string(n)));
        stream.note(session.node(7, uint32_t(n), 100));
        stream.note(session.node(8, uint32_t(n), 100));
    }
    session.state.nodes.erase(8);
    const Samples samples = samplesOf(stream.next(session.now));
    std::map<std::pair<int, uint64_t>, std::string> seen;
    for (const Sample& sample : samples.samples()) seen[{sample.topic(), sample.key()}] = sample.payload();
    EXPECT_EQ(samples.samples_size(), 3);
    EXPECT_EQ((seen[{Sample::NODE_MESH, 7}].size()), 100u);
    EXPECT_EQ((seen[{Sample::NODE_MESH, 8}]), "") << "it is gone";
    EXPECT_TRUE(stream.next(session.now).empty());
}

TEST(GuestStream, NodesThatChangedTogetherComeInOneFrameAndManyTheNearestFirst) {
    Session session;
    session.state.tool_V = Eigen::Vector3f(50, 0, 0);
    GuestStream stream = quickStream(session);
    uint64_t sent = stream.next(session.now).size();
    const auto show = [&](uint32_t count) {
        SessionChanges changes;
        for (uint32_t leaf = 0; leaf < count; ++leaf) {
            session.node(leaf, 1, 5000);
            changes.nodes.push_back(leaf);
        }
        stream.note(changes);
        const std::string frame = stream.next(session.now);
        sent += frame.size();
        return samplesOf(frame);
    };
    EXPECT_EQ(show(6).samples_size(), 6);
    EXPECT_TRUE(stream.acknowledge(sent, session.now));
    session.now += 1s;
    const Samples part = show(100);
    EXPECT_LT(part.samples_size(), 30);
    for (const Sample& sample : part.samples()) EXPECT_NEAR(double(sample.key()), 50, 15);
}

TEST(GuestStream, TheBoneComesBeforeStructuresAndPicturesAtFirstAndLaterHoldsUpNothing) {
    Session session;
    session.small(Sample::SCENE_INFO, 0, "scene");
    session.small(Sample::STRUCTURE_MESH, 1, std::string(60'000, 's'));
    session.small(Sample::SCENE_PICTURE, 0, std::string(60'000, 'p'));
    for (uint32_t leaf = 0; leaf < 50; ++leaf) session.node(leaf, 1, 5000);
    GuestStream stream = quickStream(session);
    uint64_t sent = 0;
    const auto next = [&] {
        const std::string frame = stream.next(session.now += 1s);
        EXPECT_TRUE(stream.acknowledge(sent += frame.size(), session.now));
        return samplesOf(frame);
    };
    std::vector<Topic> order;
    for (int frames = 0; frames < 50; ++frames) {
        const Samples samples = next();
        for (const Sample& sample : samples.samples())
            if (order.empty() || order.back() != sample.topic()) order.push_back(sample.topic());
    }
    EXPECT_EQ(order, (std::vector<Topic>{Sample::SCENE_INFO, Sample::NODE_MESH, Sample::STRUCTURE_MESH,
                                         Sample::SCENE_PICTURE}));

    SessionChanges changes = session.small(Sample::LESSON, 0, "lesson");
    for (uint32_t leaf = 0; leaf < 50; ++leaf) {
        session.node(leaf, 2, 5000);
        changes.nodes.push_back(leaf);
    }
    stream.note(changes);
    const Samples mixed = next();
    ASSERT_GE(mixed.samples_size(), 2);
    EXPECT_EQ(mixed.samples(0).topic(), Sample::LESSON);
    EXPECT_EQ(mixed.samples(1).topic(), Sample::NODE_MESH);
}

TEST(GuestStream, WhatHappensBetweenTwoToolStatesIsAddedUp) {
    Session session;
    GuestStream stream = quickStream(session);
    stream.next(session.now);
    stream.note(session.tool(1.5, 1));
    stream.note(session.tool(2.0, 4));
    topics::ToolState tool;
    const Samples samples = samplesOf(stream.next(session.now));
    ASSERT_EQ(samples.samples_size(), 1);
    ASSERT_TRUE(tool.ParseFromString(samples.samples(0).payload()));
    EXPECT_DOUBLE_EQ(tool.effects().removed_mm3(), 3.5);
    EXPECT_EQ(tool.effects().events(), 5u);
    stream.note(session.tool(1.0, 2));
    ASSERT_TRUE(tool.ParseFromString(samplesOf(stream.next(session.now)).samples(0).payload()));
    EXPECT_DOUBLE_EQ(tool.effects().removed_mm3(), 1.0);
    EXPECT_EQ(tool.effects().events(), 2u);
}

TEST(GuestStream, BricksGoOnlyToWhoWishesForThem) {
    Session session;
    GuestStream stream = quickStream(session);
    stream.next(session.now);
    stream.wishBricks({3, 4});
    SessionChanges changes;
    for (const uint32_t number : {2u, 3u, 5u})
        changes.bricks.push_back({number, std::make_shared<const std::string>("brick")});
    stream.note(changes);
    const Samples samples = samplesOf(stream.next(session.now));
    ASSERT_EQ(samples.samples_size(), 1);
    EXPECT_EQ(samples.samples(0).key(), 3u);
}

}  // namespace
}  // namespace bonemill::gateway
