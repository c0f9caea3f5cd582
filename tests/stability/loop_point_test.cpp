// A selection of the stability grid (tests/bench/stability_grid.cpp): devices that shook come to rest when
// they say what they are like, and a hand that holds them firmly keeps the whole wall.
#include "tests/stability/loop_point.h"

#include <gtest/gtest.h>

#include <ostream>

namespace bonemill::test {
namespace {

const Variant& balanced() {
    return allVariants()[2];
}

struct NamedPoint {
    const char* name;
    LoopPoint point;
};
void PrintTo(const NamedPoint& p, std::ostream* out) {
    *out << p.name;
}
std::string pointName(const testing::TestParamInfo<NamedPoint>& info) {
    return info.param.name;
}

constexpr int kNone = 0, kTypical = 2;
constexpr LoopPlace kPlane = LoopPlace::kPlane, kHole = LoopPlace::kHole;
// A handle of 0.1 kg and 0.5 N·s/m that no hand holds, a tick of delay, encoders of 5 µm.
constexpr LoopPoint light(LoopPlace place, double friction) {
    return {.place = place, .hand = kNone, .friction = friction, .mass = 0.1, .damping = 0.5};
}
constexpr LoopPoint with(LoopPoint point, double LoopPoint::*what, double value) {
    point.*what = value;
    return point;
}
constexpr LoopPoint late(LoopPoint point, int delay_ticks) {
    point.delay_ticks = delay_ticks;
    return point;
}

// Without word of the device each of them goes on swinging, or is lost.
const NamedPoint kShakes[] = {
    {"plane", light(kPlane, 0.02)},
    {"plane_without_friction", light(kPlane, 0)},
    {"hole", light(kHole, 0.02)},
    {"two_ticks", late(with(light(kPlane, 0.02), &LoopPoint::damping, 2), 2)},
    {"three_ticks", late(light(kHole, 0.1), 3)},
    {"lightest", with(with(light(kPlane, 0.02), &LoopPoint::mass, 0.03), &LoopPoint::damping, 0.05)},
    {"coarse_encoders", with(light(kPlane, 0.02), &LoopPoint::encoder_step, 50e-6)},
    {"jitter", with(light(kPlane, 0.02), &LoopPoint::jitter_ticks, 1)},
    {"lost_ticks", with(light(kPlane, 0.02), &LoopPoint::lost_share, 0.05)},
};
class Shakes : public testing::TestWithParam<NamedPoint> {};
TEST_P(Shakes, UntilTheDeviceSaysWhatItIsLike) {
    EXPECT_FALSE(tryLoop(GetParam().point, balanced(), Says::kNobody).isQuiet());
    const LoopVerdict verdict = tryLoop(GetParam().point, balanced(), Says::kTruth);
    if (GetParam().point.friction == 0) {
        // It may swing on by a step of its encoders: whether it does, depends on how it lies to them.
        EXPECT_LE(verdict.force_rms, 2 * kFeltForce);
        EXPECT_FALSE(verdict.is_lost);
        return;
    }
    EXPECT_TRUE(verdict.isQuiet()) << verdict.force_rms << " N, " << verdict.torque_rms * 1e3
                                   << " N mm, lost " << verdict.is_lost;
}
INSTANTIATE_TEST_SUITE_P(LoopPoint, Shakes, testing::ValuesIn(kShakes), pointName);

// A hand damps these: nothing of the wall may be given up.
const NamedPoint kHeld[] = {
    {"light",
     [] {
         auto p = light(kPlane, 0.02);
         p.hand = kTypical;
         return p;
     }()},
    {"lightest",
     [] {
         auto p = with(light(kHole, 0.1), &LoopPoint::mass, 0.03);
         p.hand = kTypical;
         return p;
     }()},
    {"two_ticks",
     [] {
         auto p = late(light(kPlane, 0.1), 2);
         p.hand = kTypical;
         return p;
     }()},
    {"typical",
     [] {
         LoopPoint p{.hand = kTypical, .friction = 0.2, .mass = 0.25, .damping = 2};
         return p;
     }()},
};
class Held : public testing::TestWithParam<NamedPoint> {};
TEST_P(Held, KeepsTheWall) {
    const LoopVerdict today = tryLoop(GetParam().point, balanced(), Says::kNobody);
    const LoopVerdict verdict = tryLoop(GetParam().point, balanced(), Says::kTruth);
    EXPECT_TRUE(verdict.isQuiet()) << verdict.force_rms << " N";
    EXPECT_GE(verdict.wall, 0.9 * today.wall);
}
INSTANTIATE_TEST_SUITE_P(LoopPoint, Held, testing::ValuesIn(kHeld), pointName);

}  // namespace
}  // namespace bonemill::test
