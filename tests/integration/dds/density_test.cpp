// Server and viewers in one process: what a viewer wants of the densities comes over DDS, exactly, and
// nothing else does.
#include <gtest/gtest.h>

#include <numeric>
#include <thread>

#include "common/rt/clock.h"
#include "haptic_server/server/publish/publisher.h"
#include "haptic_server/surface/density_stream/density_publisher.h"
#include "tests/integration/dds/child_process.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/scanned_bone.h"
#include "tests/support/stored_density.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill {
namespace {

using Eigen::Vector3i;

constexpr DensityScale kCtScale{-200, 1800, 300};

struct DensityServer {
    Publisher publisher{{.domain = testDomain(), .session = testSession(), .epoch = 0}};
    test::ScannedBone scan;
    BoneProperties properties = test::randomMaterials(scan);
    DensitySource source{scan.bone, scan.history, &properties};
    DensityPublisher densities{publisher.participant(), testSession(), publisher.epoch(), source, kCtScale};

    DensityServer() {
        topics::SceneInfo info = syntheticSceneInfo();
        *info.mutable_densities() = densityGridOf(source, kCtScale);
        EXPECT_TRUE(publisher.publishSceneInfo(info));
        EXPECT_TRUE(publisher.publishStatus({}));
    }
};

struct DensityClient : ClientProbe {
    DensityStore store;

    void step() {
        poll();
        subscriber.followDensities(store);
    }
};

// Server and clients make rounds until the condition holds; false after 30 s.
template <class Condition>
bool runUntil(DensityServer& server, std::vector<DensityClient*> clients, Condition&& condition) {
    const int64_t end_ns = monotonicNowNs() + 30 * kNsPerSecond;
    while (!condition()) {
        if (monotonicNowNs() > end_ns) return false;
        server.densities.round(monotonicNowNs(), 100'000);
        for (DensityClient* client : clients) client->step();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

void wantAll(DensityStore& store) {
    std::vector<uint32_t> all(size_t(brickCount(*store.grid())));
    std::iota(all.begin(), all.end(), 0u);
    store.want(all);
}

// Each brick that is here is made of what the volume says; air is not sent.
bool hasMaterials(const DensityServer& server, const DensityStore& store) {
    return std::ranges::all_of(store.wanted(), [&](uint32_t number) {
        const std::vector<Density> scanned = server.source.scanned(number);
        const bool is_air = std::ranges::all_of(scanned, [](Density density) { return density == 0; });
        return is_air || store.find(number)->materials == server.source.materials(number);
    });
}

bool hasWanted(const DensityStore& store) {
    return !store.wanted().empty() &&
           std::ranges::all_of(store.wanted(), [&](uint32_t brick) { return store.find(brick); });
}

// 10,000 random voxels are what the volume says.
bool isExact(const DensityServer& server, const DensityStore& store) {
    std::mt19937 random(10000);
    for (int n = 0; n < 10000; ++n) {
        const Vector3i v = test::randomVoxel(server.scan.bone.volume, random);
        if (scannedAt(store, v) != server.scan.scannedAt(v) || presentAt(store, v) != server.scan.at(v))
            return false;
    }
    return true;
}

void mill(DensityServer& server, uint32_t seed) {
    std::mt19937 random(seed);
    for (int cut = 0; cut < 60; ++cut) {
        const Vector3i a = test::randomVoxel(server.scan.bone.volume, random),
                       last = server.scan.bone.volume.dims().array() - 1;
        server.scan.write({a, (a.array() + 4).matrix().cwiseMin(last)}, cut % 3 ? 0 : Density(random()));
    }
}

TEST(Densities, ComeExactlyAndAgainWhenTheyChange) {
    DensityServer server;
    DensityClient client;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return client.store.grid().has_value(); }));
    EXPECT_EQ(client.store.grid()->voxels, server.scan.bone.volume.dims());
    EXPECT_EQ(client.store.grid()->value_at_65535, 1800);
    mill(server, 1);
    wantAll(client.store);
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return isExact(server, client.store); }));
    EXPECT_TRUE(hasWanted(client.store));
    EXPECT_LE(server.densities.writtenBricks(), 36u) << "nothing is written twice";

    mill(server, 2);
    EXPECT_FALSE(isExact(server, client.store));
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return isExact(server, client.store); }));
    DensityClient late;
    ASSERT_TRUE(runUntil(server, {&client, &late}, [&] { return late.store.grid().has_value(); }));
    wantAll(late.store);
    ASSERT_TRUE(runUntil(server, {&client, &late}, [&] { return isExact(server, late.store); }))
        << "who comes late gets both";
    EXPECT_TRUE(hasMaterials(server, client.store)) << "also of bricks that changed since";
    EXPECT_TRUE(hasMaterials(server, late.store));
    EXPECT_EQ(client.subscriber.malformedSamples() + late.subscriber.malformedSamples(), 0u);
}

// What changed while a viewer looked elsewhere comes when it looks there again.
TEST(Densities, ComeAgainForBricksThatWereNotShownMeanwhile) {
    DensityServer server;
    DensityClient client;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return client.store.grid().has_value(); }));
    wantAll(client.store);
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return hasWanted(client.store); }));
    client.store.want({35});
    const int64_t later_ns = monotonicNowNs() + kNsPerSecond / 4;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return monotonicNowNs() > later_ns; }));
    mill(server, 3);
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return monotonicNowNs() > later_ns + kNsPerSecond / 2; }));
    EXPECT_FALSE(isExact(server, client.store));
    wantAll(client.store);
    EXPECT_TRUE(runUntil(server, {&client}, [&] { return isExact(server, client.store); }));
}

TEST(Densities, CostNothingUnlessTheyAreWanted) {
    DensityServer server;
    DensityClient client, other;
    ASSERT_TRUE(
        runUntil(server, {&client, &other}, [&] { return client.store.grid() && other.store.grid(); }));
    const int64_t later_ns = monotonicNowNs() + kNsPerSecond / 2;
    ASSERT_TRUE(runUntil(server, {&client, &other}, [&] { return monotonicNowNs() > later_ns; }));
    EXPECT_FALSE(client.subscriber.densityFeed().isListening());
    EXPECT_EQ(server.densities.writtenBricks(), 0u);
    EXPECT_EQ(client.store.bytes(), 0u);
    other.store.want({20, 21});
    ASSERT_TRUE(runUntil(server, {&client, &other}, [&] { return hasWanted(other.store); }));
    EXPECT_EQ(server.densities.writtenBricks(), 2u);
    EXPECT_FALSE(client.subscriber.densityFeed().isListening());
    EXPECT_EQ(client.store.bytes(), 0u);
}

TEST(Densities, AreThoseOfTheNewestRun) {
    auto server = std::make_unique<DensityServer>();
    DensityClient client;
    ASSERT_TRUE(runUntil(*server, {&client}, [&] { return client.store.grid().has_value(); }));
    mill(*server, 4);
    wantAll(client.store);
    ASSERT_TRUE(runUntil(*server, {&client}, [&] { return hasWanted(client.store); }));
    server.reset();
    server = std::make_unique<DensityServer>();
    ASSERT_TRUE(runUntil(*server, {&client}, [&] { return !hasWanted(client.store); })) << "emptied";
    ASSERT_TRUE(runUntil(*server, {&client}, [&] { return client.store.grid().has_value(); }));
    wantAll(client.store);
    ASSERT_TRUE(runUntil(*server, {&client}, [&] { return hasWanted(client.store); }));
    EXPECT_TRUE(isExact(*server, client.store));
}

TEST(Densities, SurviveHostileWishesAndBricks) {
    DensityServer server;
    DensityClient client;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return client.store.grid().has_value(); }));
    client.store.want({20});
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return hasWanted(client.store); }));
    const uint64_t written = server.densities.writtenBricks();

    dds::Participant intruder(testDomain());
    dds::Writer<dds::DensityWishSample> wishes(intruder);
    dds::Writer<dds::DensityBrickSample> bricks(server.publisher.participant());
    topics::DensityWish beyond;
    beyond.set_epoch(server.publisher.epoch());
    beyond.add_lacking(36);
    topics::DensityWish stale;
    stale.set_epoch(server.publisher.epoch() - 1);
    stale.add_lacking(1);
    topics::DensityBrick no_brick;
    no_brick.set_epoch(server.publisher.epoch());
    no_brick.set_revision(1000);
    no_brick.set_change("this is no change");
    const std::string damaged = no_brick.SerializeAsString();
    uint64_t sender = 0;
    EXPECT_TRUE(runUntil(server, {&client}, [&] {
        for (int i = 0; i < 50; ++i) {
            dds::DensityWishSample wish{};
            wish.session = testSession();
            wish.sender = ++sender;
            beyond.set_sender(sender);
            stale.set_sender(sender);
            const std::string bytes = i % 3 == 0   ? std::string(60000, '\xff')
                                      : i % 3 == 1 ? beyond.SerializeAsString()
                                                   : stale.SerializeAsString();
            dds::setPayload(wish, bytes);
            wishes.write(wish);
        }
        dds::DensityBrickSample brick{};
        brick.session = testSession();
        brick.brick = 20;
        dds::setPayload(brick, damaged);
        bricks.write(brick);
        return client.subscriber.malformedSamples() > 3 && sender > 5000;
    }));
    EXPECT_EQ(server.densities.writtenBricks(), written) << "none of these was answered";
    EXPECT_EQ(client.store.find(20)->revision, 0u);
    client.store.want({20, 21});
    EXPECT_TRUE(runUntil(server, {&client}, [&] { return hasWanted(client.store); })) << "it goes on";
}

TEST(Densities, ComeToWhoeverWishesBesideStrangersWhoInventSenders) {
    DensityServer server;
    DensityClient client;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return client.store.grid().has_value(); }));
    ChildProcess intruder("synthetic_intruder", "wishes");
    EXPECT_EQ(intruder.ask("5000"), "done");
    wantAll(client.store);
    EXPECT_TRUE(runUntil(server, {&client}, [&] { return hasWanted(client.store); }));
}

// Bricks of a stranger who says that it is the server: they make sense, and would hide what was milled.
TEST(Densities, OfSomebodyElseAreNotShown) {
    DensityServer server;
    DensityClient client;
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return client.store.grid().has_value(); }));
    wantAll(client.store);
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return hasWanted(client.store); }));
    const dds::Participant intruder(testDomain());
    dds::Writer<dds::DensityBrickSample> bricks(intruder);
    topics::DensityBrick forged;
    forged.set_epoch(server.publisher.epoch());
    forged.set_revision(UINT32_MAX - 1);
    const std::string bytes = forged.SerializeAsString();
    dds::DensityBrickSample brick{};
    brick.session = testSession();
    dds::setPayload(brick, bytes);
    ASSERT_TRUE(runUntil(server, {&client}, [&] { return bricks.matchedReaders() > 0; }));
    int rounds = 0;
    ASSERT_TRUE(runUntil(server, {&client}, [&] {
        for (const uint32_t wanted : client.store.wanted()) {
            brick.brick = wanted;
            EXPECT_TRUE(bricks.write(brick));
        }
        return ++rounds > 50;
    }));
    mill(server, 5);
    EXPECT_TRUE(runUntil(server, {&client}, [&] { return isExact(server, client.store); }));
    EXPECT_EQ(client.subscriber.malformedSamples(), 0u);
}

}  // namespace
}  // namespace bonemill
