#include "tests/stability/pressed.h"

#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr double kSettle = 0.5, kWatch = 0.5;           // s
constexpr double kForceBuzz = 0.05, kMotion = 10e-6;    // N, m; RMS
constexpr double kGrowth = 1.5, kMotionFloor = 0.2e-6;  // growth counts above this RMS (m)

LoopConfig loopWith(const HandPlant& hand) {
    LoopConfig config;
    config.hand = hand;
    return config;
}

}  // namespace

const std::vector<PressPlace>& pressPlaces() {
    static const std::vector<PressPlace> kPlaces{
        {"plane", planeBone, burr, abovePlane(0.2e-3), {{0, 0, -2}, {0, 0, 0}}},
        {"hole", holeBone, peg, upright(kHoleMiddle), {{2, 0, 1}, {0.0003, 0, 0.0005}}}};
    return kPlaces;
}

const std::vector<PressHand>& pressHands() {
    static const std::vector<PressHand> kHands{{"typical", {}}, {"none", kNoHand}};
    return kHands;
}

Pressed::Pressed(Scene& scene, const PressPlace& at, const HandPlant& hand)
    : place(at), loop(loopWith(hand), scene, at.start) {
    if (hand.stiffness > 0)
        loop.plant.setTarget(place.start.incremented(place.push.force / hand.stiffness,
                                                     place.push.torque / hand.angular_stiffness));
    else
        loop.plant.setBias(place.push);
}

bool Pressed::isStable() {
    loop.run(kSettle);
    const Residual r = residual(loop, kWatch);
    const bool grows = r.position_rms > kMotionFloor && r.growth > kGrowth;
    return r.is_finite && r.is_touching && r.rms < kForceBuzz && r.position_rms < kMotion && !grows;
}

double Pressed::rendered() {
    constexpr double kHold = 0.1, kMove = 20e-6;  // s, m
    const Eigen::Vector3d along = place.push.force.normalized();
    const Pose rest = loop.plant.measured();
    const auto forceAt = [&](double way) {
        const int ticks = int(kHold / loop.dt);
        double sum = 0;
        for (int n = 0; n < 2 * ticks; ++n) {
            loop.stepper.step({rest.position + way * along, rest.rotation});
            if (n >= ticks) sum -= loop.stepper.wrenchOnHand().force.dot(along) / ticks;
        }
        return sum;
    };
    const double less = forceAt(-kMove);
    return (forceAt(kMove) - less) / (2 * kMove);
}

}  // namespace bonemill::test
