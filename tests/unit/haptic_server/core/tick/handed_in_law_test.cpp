// The tick knows a contact law by what it says of itself: one that no room has is handed in and does as it
// says.
#include <gtest/gtest.h>

#include "haptic_server/core/tick/fixed_tick.h"
#include "tests/support/led_tick.h"
#include "tests/support/milling_config.h"
#include "tests/support/test_bodies.h"
#include "tests/support/voxel_fields.h"

namespace bonemill {
namespace {

constexpr double kPush = 3, kMuchMore = 20;  // N

// The tool is where the hand is, and the hand feels a force that was said beforehand.
struct ScriptedLaw final : SpoModel {
    explicit ScriptedLaw(SpoTraits its) : its_(its) {}
    SpoTraits traits() const noexcept override { return its_; }
    SpoStep advance(const Pose&, const Pose& X_VT_device) noexcept override {
        SpoStep step;
        step.X_VT = X_VT_device;
        step.wrench_hand_V.force.z() = ++ticks_ > 10 ? kMuchMore : kPush;
        step.is_tool_growing = grows;
        return step;
    }
    void restart() noexcept override {}
    void setAccuracy(const AccuracySettings&) noexcept override {}
    void setTool(const SpoTool&) noexcept override {}
    void setCoupling(const SpoCoupling&) noexcept override {}
    void setCutting(bool is_cutting) noexcept override { was_cutting |= is_cutting; }

    static inline bool grows, was_cutting;

  private:
    SpoTraits its_;
    int ticks_ = 0;
};

template <bool kMillsVoxels>
std::unique_ptr<SpoModel> makeScripted(const SpoParts&) {
    return std::make_unique<ScriptedLaw>(SpoTraits{.mills_voxel_centres = kMillsVoxels});
}
constexpr SpoLaw kFineLaw[] = {{ContactLaw::kConstraint, makeScripted<false>}};
constexpr SpoLaw kVoxelLaw[] = {{ContactLaw::kConstraint, makeScripted<true>}};

struct HandedInBench {
    HandedInBench()
        : bone(test::bodyVolume(test::cubeGeometry(48, 0.125e-3),
                                test::halfSpace({0, 0, 3e-3}, Eigen::Vector3d::UnitZ())),
               Eigen::Vector3i::Constant(16), {.levels = {{1}}}),
          tool(test::sphereToolModel(1e-3, 0.125e-3)) {
        ScriptedLaw::grows = ScriptedLaw::was_cutting = false;
    }
    std::vector<TickRecord> run(std::span<const SpoLaw> laws, uint32_t buttons = 0) {
        FixedTickConfig config = test::millingConfig();
        config.laws = laws;
        config.tool = {&tool, {.radius = 1e-3}};
        config.accuracy = presetSettings(Preset::kConstraint);
        FixedTick tick(config, bone);
        const Pose rest{{3e-3, 3e-3, 3.2e-3}, Eigen::Quaterniond::Identity()};
        return test::lead(tick, test::straightPath(rest, rest.position, 40, buttons));
    }
    // Voxels that are neither whole nor gone.
    size_t partlyMilled() const {
        size_t count = 0;
        test::forEachVoxel(test::wholeBox(bone.volume), [&](int i, int j, int k) {
            const Density density = bone.volume.at(i, j, k);
            count += density > 0 && density < kMaxDensity;
        });
        return count;
    }

    BoneModel bone;
    ToolModel tool;
};

TEST(HandedInLaw, MovesTheToolAndIsFelt) {
    const auto records = HandedInBench().run(kFineLaw);
    EXPECT_EQ(Eigen::Vector3d(records[5].f_hand_W), Eigen::Vector3d(0, 0, kPush));
    EXPECT_EQ(Eigen::Vector3d(records.back().f_hand_W), Eigen::Vector3d(0, 0, kMuchMore));
    EXPECT_EQ(Eigen::Vector3d(records.back().p_WT), Eigen::Vector3d(records.back().p_WT_device));
}

TEST(HandedInLaw, WhileItsToolGrowsTheForceComesAtALimitedRate) {
    HandedInBench bench;
    ScriptedLaw::grows = true;
    const auto records = bench.run(kFineLaw);
    for (size_t n = 1; n < records.size(); ++n)
        EXPECT_LE(records[n].f_hand_W[2] - records[n - 1].f_hand_W[2], HandLimits::kForceRate * 1e-3 + 1e-9);
    EXPECT_GT(records.back().f_hand_W[2], kPush);
}

TEST(HandedInLaw, HearsOfThePedalAndMillsAsItSays) {
    HandedInBench fine, by_voxels;
    const auto removed = [](const std::vector<TickRecord>& records) {
        uint32_t sum = 0;
        for (const TickRecord& record : records) sum += record.removed_voxels;
        return sum;
    };
    EXPECT_GT(removed(fine.run(kFineLaw, kButtonRemove)), 100u);
    EXPECT_TRUE(ScriptedLaw::was_cutting);
    EXPECT_GT(removed(by_voxels.run(kVoxelLaw, kButtonRemove)), 100u);
    EXPECT_GT(fine.partlyMilled(), by_voxels.partlyMilled() + 100);
}

}  // namespace
}  // namespace bonemill
