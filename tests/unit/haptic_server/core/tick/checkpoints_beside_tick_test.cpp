// Checkpoints are saved and restored while the tick mills: ThreadSanitizer finds nothing, and each is the
// bone between two ticks.
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "haptic_server/core/tick/fixed_tick.h"
#include "tests/support/milling_config.h"
#include "tests/unit/haptic_server/core/bone/milled_ball.h"

namespace bonemill {
namespace {

using test::MilledBall;

constexpr int kTicksBetween = 6, kSaved = 14;

// Mills to and fro through the ball until it is told to stop; keeps what the bone was after each tick.
class MillingIo final : public TickIo {
  public:
    MillingIo(const BoneModel& bone, const std::atomic<bool>& stop) : bone_(bone), stop_(stop) {}
    // The bone is looked at here, between two ticks, where memory may be had.
    bool read(DeviceInput& input) noexcept override {
        remember();
        if (stop_) return false;
        const double phase = double(n_++) / 20;
        input = {};
        input.X_WT_device.position = {10e-3 + 5e-3 * std::sin(phase), 10e-3 + 4e-3 * std::sin(0.37 * phase),
                                      16e-3 - 8e-3 * std::min(1.0, double(n_) / 150)};
        input.buttons = kButtonRemove;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return 0; }
    int64_t now() noexcept override { return 0; }
    void take(const TickRecord& record) noexcept {
        removed += record.removed_voxels;
        ++ticks;
    }

    std::vector<uint64_t> states;  // hashes
    uint64_t removed = 0;
    std::atomic<int> ticks{0};

    static uint64_t hashOf(const std::vector<Density>& densities) {
        uint64_t hash = 14695981039346656037ull;
        for (const Density density : densities) hash = (hash ^ density) * 1099511628211ull;
        return hash;
    }

  private:
    void remember() { states.push_back(hashOf(MilledBall::densitiesOf(bone_))); }

    const BoneModel& bone_;
    const std::atomic<bool>& stop_;
    int n_ = 0;
};

struct Threads {
    Threads() : io(ball.bone, stop), tool(test::sphereToolModel(1.5e-3, 0.2e-3)) {
        config.tool = {&tool, {.radius = 1.5e-3}};
        config.accuracy.iterations = 1;  // ThreadSanitizer slows each a hundred times
        tick = std::make_unique<FixedTick>(config, ball.bone, &ball.history);
    }
    // Calls keeper(n), n = 0 .. kSaved - 1, with some ticks between; the tick goes on meanwhile.
    void run(const std::function<void(int)>& keeper) {
        std::thread tick_thread([&] { tick->run(io, [&](const TickRecord& record) { io.take(record); }); });
        for (int n = 0; n < kSaved; ++n) {
            waitForTicks();
            keeper(n);
        }
        waitForTicks();
        stop = true;
        tick_thread.join();
    }
    void waitForTicks() const {
        const int until = io.ticks + kTicksBetween;
        while (io.ticks < until) std::this_thread::yield();
    }
    void waitUntilRestored() const {
        while (ball.history.isRestoring()) std::this_thread::yield();
        waitForTicks();
    }
    // It is called after the last tick.
    std::vector<Density> restored(uint32_t id) {
        EXPECT_TRUE(ball.checkpoints.restore(id));
        ball.restoreAll();
        return ball.densities();
    }

    MilledBall ball;
    std::atomic<bool> stop{false};
    MillingIo io;
    ToolModel tool;
    FixedTickConfig config = test::millingConfig();
    std::unique_ptr<FixedTick> tick;
};

TEST(CheckpointsBesideTick, EachIsTheBoneBetweenTwoTicks) {
    Threads threads;
    threads.run([&](int n) { threads.ball.checkpoints.save(n); });
    EXPECT_GT(threads.io.removed, 100u);
    ASSERT_EQ(threads.ball.checkpoints.kept().size(), Checkpoints::kMax);
    const std::set<uint64_t> states(threads.io.states.begin(), threads.io.states.end());
    std::set<uint64_t> found;
    for (const Checkpoints::Checkpoint& checkpoint : threads.ball.checkpoints.kept()) {
        const uint64_t hash = MillingIo::hashOf(threads.restored(checkpoint.id));
        EXPECT_TRUE(states.contains(hash)) << checkpoint.id;
        EXPECT_EQ(threads.ball.history.missingVoxels(), checkpoint.snapshot->missing_voxels);
        found.insert(hash);
    }
    EXPECT_GT(found.size(), 3u);
}

TEST(CheckpointsBesideTick, RestoringAgainAndAgainLosesNothing) {
    Threads threads;
    const int64_t scanned = threads.ball.voxelsOfBone();
    threads.run([&](int n) {
        const uint32_t id = threads.ball.checkpoints.save(n);
        if (n % 3 != 2) return;
        threads.ball.checkpoints.restore(n % 2 ? id - 1 : Checkpoints::kScannedBone);
        if (n % 4 == 0) threads.ball.checkpoints.restore(id);
        threads.waitUntilRestored();
    });
    EXPECT_GT(threads.io.removed, 100u);
    threads.ball.restoreAll();
    EXPECT_EQ(threads.ball.history.missingVoxels(), scanned - threads.ball.voxelsOfBone());
    EXPECT_EQ(threads.restored(Checkpoints::kScannedBone), MilledBall::densitiesOf(MilledBall::makeBone()));
    EXPECT_EQ(threads.ball.history.missingVoxels(), 0);
}

TEST(CheckpointsBesideTick, OrdersFasterThanTheTickTakesThemUpLeadToTheLast) {
    Threads threads;
    threads.run([&](int n) {
        const uint32_t id = threads.ball.checkpoints.save(n);
        if (n % 5 != 3) return;
        for (int order = 0; order < 300; ++order) {
            const auto snapshot = std::make_shared<const BoneSnapshot>();
            threads.ball.history.restore(snapshot);
            if (order % 7 == 0) std::this_thread::yield();
        }
        threads.ball.checkpoints.restore(n % 2 ? id : Checkpoints::kScannedBone);
        threads.waitUntilRestored();
    });
    EXPECT_GT(threads.io.removed, 100u);
    EXPECT_EQ(threads.restored(Checkpoints::kScannedBone), MilledBall::densitiesOf(MilledBall::makeBone()));
    EXPECT_EQ(threads.ball.history.missingVoxels(), 0);
}

}  // namespace
}  // namespace bonemill
