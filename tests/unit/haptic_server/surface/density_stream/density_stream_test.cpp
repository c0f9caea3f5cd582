#include "haptic_server/surface/density_stream/density_stream.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "proto/topics.pb.h"
#include "tests/support/scanned_bone.h"

namespace bonemill {
namespace {

constexpr uint64_t kRun = 42;
constexpr int64_t kMs = 1'000'000;

// A server's stream, and what it wrote.
struct StreamRig {
    test::ScannedBone scan;
    BoneProperties properties = test::randomMaterials(scan);
    DensitySource source{scan.bone, scan.history, &properties};
    DensityStream stream{source, kRun, test::kCtWindow};
    int64_t now_ns = 1000 * kMs;
    std::vector<std::pair<uint32_t, topics::DensityBrick>> written;

    void wish(uint64_t sender, const std::vector<uint32_t>& lacking,
              const std::map<uint32_t, uint32_t>& held = {}) {
        topics::DensityWish wish;
        wish.set_epoch(kRun);
        wish.set_sender(sender);
        wish.mutable_lacking()->Add(lacking.begin(), lacking.end());
        uint32_t end = 0;
        for (const auto& [brick, revision] : held) {
            wish.add_held(brick - end);
            wish.add_held(1);
            end = brick + 1;
            if (revision == 0) continue;
            wish.add_revisions(brick);
            wish.add_revisions(revision);
        }
        const std::string bytes = wish.SerializeAsString();
        stream.receive(sender, sender, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()},
                       now_ns);
    }
    // Rounds of at most so many bricks follow, one per 5 ms; returns how many bricks they wrote.
    size_t run(int rounds, size_t most = 1000) {
        const size_t before = written.size();
        for (; rounds > 0; --rounds, now_ns += 5 * kMs) {
            size_t count = 0;
            stream.round(now_ns, [&](uint32_t brick, const std::string& payload) {
                written.emplace_back(brick, topics::DensityBrick());
                EXPECT_TRUE(written.back().second.ParseFromString(payload));
                return ++count < most;
            });
        }
        return written.size() - before;
    }
};

TEST(DensityStream, WritesWhatIsLackingOnceAndInOrder) {
    StreamRig rig;
    EXPECT_EQ(rig.run(10), 0u) << "nobody wishes anything";
    rig.wish(1, {20, 3, 35});
    EXPECT_EQ(rig.run(100), 3u);
    EXPECT_EQ(rig.written[0].first, 20u);
    EXPECT_EQ(rig.written[1].first, 3u);
    EXPECT_FALSE(rig.written[0].second.scanned().empty());
    EXPECT_TRUE(rig.written[0].second.change().empty());
    rig.wish(2, {20});
    EXPECT_EQ(rig.run(50), 0u) << "it is on its way to all";
    rig.wish(2, {20});
    EXPECT_EQ(rig.run(100), 1u) << "it did not arrive there";
    rig.now_ns += DensityWishes::kSilence_ns;
    EXPECT_EQ(rig.run(10), 0u);
    EXPECT_FALSE(rig.stream.isWished(rig.now_ns));
}

TEST(DensityStream, SaysOnceWhatABrickIsMadeOf) {
    StreamRig rig;
    rig.wish(1, {17});
    ASSERT_EQ(rig.run(40), 1u);
    DensityDecoder decoder;
    EXPECT_EQ(decoder.materials(rig.written[0].second.materials(), 4096), rig.source.materials(17));
    rig.scan.write({{20, 20, 20}, {24, 22, 22}}, 0);
    rig.wish(1, {}, {{17, 0}});
    ASSERT_EQ(rig.run(100), 1u);
    EXPECT_TRUE(rig.written[1].second.materials().empty());
}

TEST(DensityStream, WritesWhatChangedAgainButNotTooOften) {
    StreamRig rig;
    rig.wish(1, {}, {{17, 0}, {20, 0}});
    EXPECT_EQ(rig.run(40), 0u) << "it has all";
    for (int i = 0; i < 100; ++i) {  // half a second of milling
        rig.scan.write({{20, 20, 20}, {20 + i % 8, 22, 22}}, Density(i));
        rig.run(1);
    }
    const size_t while_milling = rig.written.size();
    EXPECT_GE(while_milling, 4u);
    EXPECT_LE(while_milling, 6u) << "ten per second";
    rig.run(40);
    const auto& [brick, last] = rig.written.back();
    EXPECT_EQ(brick, 17u);
    EXPECT_TRUE(last.scanned().empty()) << "it has that";
    EXPECT_LT(last.ByteSizeLong(), 300u);
    EXPECT_EQ(last.revision(), rig.source.revision(17));
    rig.wish(1, {}, {{17, last.revision()}, {20, 0}});
    EXPECT_EQ(rig.run(400), 0u);
    rig.wish(2, {17});
    EXPECT_EQ(rig.run(400), 1u) << "who comes later gets both";
    EXPECT_FALSE(rig.written.back().second.scanned().empty());
    EXPECT_FALSE(rig.written.back().second.change().empty());
}

// Thirty viewers change what they want ten times per second: nothing is written twice within a second, all
// get their turn, and a round is no longer for it.
TEST(DensityStream, ServesThirtyViewersThatChangeTheirPlanes) {
    StreamRig rig;
    std::mt19937 random(30);
    std::map<uint32_t, int64_t> last_ns;
    std::set<uint32_t> seen;
    for (int step = 0; step < 20; ++step) {
        for (uint64_t viewer = 1; viewer <= 30; ++viewer) {
            std::vector<uint32_t> plane;
            for (int i = 0; i < 12; ++i) plane.push_back(random() % 36);
            rig.wish(viewer, plane);
        }
        for (int round = 0; round < 20; ++round) {
            const size_t before = rig.written.size();
            const int64_t at_ns = rig.now_ns;
            EXPECT_LE(rig.run(1, 3), 3u) << "the budget";
            for (size_t n = before; n < rig.written.size(); ++n) {
                const uint32_t brick = rig.written[n].first;
                EXPECT_TRUE(!last_ns.contains(brick) || at_ns - last_ns[brick] >= DensityStream::kRepeat_ns);
                last_ns[brick] = at_ns;
                seen.insert(brick);
            }
        }
    }
    EXPECT_EQ(seen.size(), 36u);
}

TEST(DensityStream, LetsNobodyPushOthersAside) {
    StreamRig rig;
    std::vector<uint32_t> all;
    for (uint32_t brick = 0; brick < 36; ++brick) all.push_back(brick);
    rig.wish(1, all);
    rig.wish(2, {35});
    rig.run(2, 1);
    EXPECT_TRUE(rig.written[0].first == 35 || rig.written[1].first == 35) << "they take turns";
}

}  // namespace
}  // namespace bonemill
