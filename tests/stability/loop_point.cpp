#include "tests/stability/loop_point.h"

#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kDt = 1e-3;
constexpr double kInertiaPerMass = 2e-4, kAngularPerLinear = 2e-3, kAngularFriction = 5e-3;
constexpr double kAnglePerStep = 35;          // rad/m: 0.01° at 5 µm
constexpr double kPush = 1, kTwist = 2.5e-4;  // N, N·m
constexpr int kMaxWindows = 14, kMostAsBefore = 3;
constexpr double kWindow = 0.5;  // s

// A hole that the tool cannot drift out of along its axis, for there is nothing that would brake it.
constexpr double kPegHalf = 1e-3, kClearance = kVoxel / 2;
const Eigen::Vector3d kSocket(2.02e-3, 2.77e-3, 1.97e-3);

VoxelVolume socketBone() {
    return bodyVolume(boxOf({4e-3, 5.5e-3, 4e-3}), [](const Eigen::Vector3d& p) {
        Eigen::Vector3d r = p - kSocket;
        r.y() -= std::clamp(r.y(), -kPegHalf, kPegHalf);
        return kBurrRadius + kClearance - r.norm();
    });
}

struct Setting {
    VoxelVolume bone;
    TestTool tool;
    Pose start;
    Wrench push;
};

// What a thousand points share is made once.
const Setting& settingOf(LoopPlace place) {
    static const Setting kPlane{planeBone(), burr(), abovePlane(0.2e-3), {{0, 0, -kPush}, {0, 0, 0}}};
    static const Setting kHole{socketBone(),
                               pegTool(kBurrRadius, kPegHalf),
                               upright(kSocket),
                               {{kPush, 0, kPush / 2}, {kTwist, 0, kTwist}}};
    return place == LoopPlace::kPlane ? kPlane : kHole;
}

bool isQuiet(const Residual& r) {
    return r.rms <= kFeltForce && r.torque_rms <= kFeltTorque;
}

DeviceCapabilities wordOf(const LoopPoint& point, const LoopConfig& config, Says says) {
    if (says == Says::kLittle) return declaredLittle(config);
    return says == Says::kTruth ? declared(config, kDt) : declaredWrongly(config, kDt, kWrongBy, point.seed);
}

// Evenly in the logarithm.
double drawn(std::minstd_rand& random, double least, double most) {
    return least * std::pow(most / least, std::uniform_real_distribution<>(0, 1)(random));
}

}  // namespace

LoopPoint randomDevice(int n) {
    std::minstd_rand random(uint32_t(1000003 + 7919 * n));
    random.discard(10);
    const auto chance = [&random] { return std::uniform_real_distribution<>(0, 1)(random); };
    LoopPoint point;
    point.place = chance() < 0.6 ? LoopPlace::kPlane : LoopPlace::kHole;
    point.hand = chance() < 0.5 ? 0 : 1 + int(3 * chance());
    point.friction = chance() < 0.35 ? 0 : drawn(random, 0.02, 0.5);
    point.mass = drawn(random, 0.05, 0.6);
    point.damping = drawn(random, 0.1, 5);
    const double delay = 3 * chance();
    point.delay_ticks = int(delay);
    point.late_ticks = delay - point.delay_ticks;
    point.encoder_step = drawn(random, 1e-6, 20e-6);
    point.push = drawn(random, 0.5, 3);
    point.amplifier_hz = drawn(random, 200, 1000);
    point.has_torque = point.place == LoopPlace::kHole || chance() < 0.5;
    point.seed = uint32_t(n + 1);
    return point;
}

const char* nameOf(Says says) {
    constexpr const char* kNames[] = {"nobody", "little", "truth", "wrong"};
    return kNames[int(says)];
}

const std::vector<NamedHand>& loopHands() {
    static const std::vector<NamedHand> kHands{{"none", kNoHand},
                                               {"soft", {0.05, 1, 50, 1e-5, 0.002, 0.1}},
                                               {"typical", {}},
                                               {"stiff", {0.2, 15, 1000, 1e-4, 0.05, 2}}};
    return kHands;
}

const char* nameOf(LoopPlace place) {
    return place == LoopPlace::kPlane ? "plane" : "hole";
}

LoopConfig LoopPoint::config() const {
    LoopConfig config;
    config.delay_ticks = delay_ticks;
    config.late_ticks = late_ticks;
    config.jitter_ticks = jitter_ticks;
    config.lost_share = lost_share;
    config.most_force = most_force;
    config.has_torque = has_torque;
    config.hand = loopHands()[size_t(hand)].plant;
    config.device = {.mass = mass,
                     .damping = damping,
                     .coulomb = friction,
                     .inertia = mass * kInertiaPerMass,
                     .angular_damping = damping * kAngularPerLinear,
                     .angular_coulomb = friction * kAngularFriction,
                     .amplifier_hz = amplifier_hz,
                     .encoder_step = encoder_step,
                     .encoder_angle = encoder_step * kAnglePerStep};
    return config;
}

LoopVerdict tryLoop(const LoopPoint& point, const Variant& variant, Says says) {
    const Setting& setting = settingOf(point.place);
    Scene scene(setting.bone, setting.tool, variant, kDt);
    const LoopConfig config = point.config();
    ClosedLoop loop(config, scene, setting.start);
    if (says != Says::kNobody) loop.declare(wordOf(point, config, says));
    const Wrench push{point.push * setting.push.force, point.push * setting.push.torque};
    if (config.hand.stiffness > 0)
        loop.plant.setTarget(setting.start.incremented(push.force / config.hand.stiffness,
                                                       push.torque / config.hand.angular_stiffness));
    else
        loop.plant.setBias(push);
    loop.run(kWindow);
    Residual r = residual(loop, kWindow);
    double swing = r.rms + r.torque_rms;
    const auto shares = [&] {
        const TickRecord& record = loop.stepper.record();
        return record.coupling_share + record.rotation_share;
    };
    double share_before = shares();
    int as_before = 0;
    for (int n = 2; n < kMaxWindows && r.is_finite && !isQuiet(r); ++n) {
        r = residual(loop, kWindow);
        const double now = r.rms + r.torque_rms;
        const bool goes_on_as_before = now > 0.9 * swing && shares() == share_before;
        as_before = goes_on_as_before ? as_before + 1 : 0;
        if (as_before == kMostAsBefore) break;
        swing = now;
        share_before = shares();
    }
    const bool has_flown_off = loop.stepper.record().faults & kFaultBadDevicePose;
    const double share = loop.stepper.record().coupling_share;
    return {.force_rms = r.rms,
            .torque_rms = r.torque_rms,
            .wall = share * couplingFigures(scene.config).translation_stiffness,
            .share = share,
            .is_lost = !r.is_finite || !r.is_touching || has_flown_off};
}

}  // namespace bonemill::test
