// Closes the loop of the real tick with the device daemon's emulated ARES, its kinematics, limits and delay.
#include "device_daemon/ares/ares_device/ares_device.h"
#include "device_daemon/ares/driver/ares_emulator.h"
#include "device_daemon/control/device_loop/device_loop.h"
#include "tests/stability/case_test.h"
#include "tests/stability/drive.h"
#include "tests/stability/hard_scenes.h"

namespace bonemill::test {
namespace {

constexpr int64_t kTick_ns = 1'000'000;

DeviceLoopConfig withoutSwitch() {
    DeviceLoopConfig config;
    config.states.needs_enabling_switch = false;
    return config;
}

// Frame D stands where the tool starts: the neutral handle pose is the start pose.
class AresBench {
  public:
    AresBench(Scene& scene, const Pose& start, const Pose& target)
        : X_WD_(start),
          emulator_(AresKinematics{}, {}, {}, OperatorPath({{0, {}, 0}, {0.3, start.inverse() * target, 0}})),
          ares_(emulator_, {}),
          loop_(ares_, withoutSwitch()),
          stepper_(scene) {
        emulator_.startScenario();
    }

    // Returns the force on the hand, or NaN if the device has no pose.
    Eigen::Vector3d step() {
        now_ns_ += kTick_ns;
        DeviceSample sample;
        if (!loop_.read(now_ns_, 1e-3, sample)) return Eigen::Vector3d::Constant(kNan);
        loop_.write(&command_, now_ns_);
        is_engaged_ = loop_.safety().state() == SafetyState::kEngaged;
        stepper_.step(X_WD_ * loop_.reading().X_DT);
        const Wrench wrench_D = stepper_.wrenchOnHand().rotatedBy(X_WD_.rotation.conjugate());
        command_ = {};
        command_.stamp_ns = now_ns_;
        for (int i = 0; i < 3; ++i) {
            command_.f_hand_D[i] = wrench_D.force[i];
            command_.t_hand_D[i] = wrench_D.torque[i];
        }
        return stepper_.wrenchOnHand().force;
    }

    bool isEngaged() const { return is_engaged_; }

  private:
    Pose X_WD_;
    AresEmulator emulator_;
    AresDevice ares_;
    DeviceLoop loop_;
    Stepper stepper_;
    WrenchCommand command_{};
    int64_t now_ns_ = 1'000'000'000;
    bool is_engaged_ = false;
};

double forceResidual(AresBench& bench) {
    for (int n = 0; n < 1000; ++n) bench.step();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double squares = 0;
    constexpr int kTicks = 500;
    for (int n = 0; n < kTicks; ++n) {
        const Eigen::Vector3d force = bench.step();
        sum += force;
        squares += force.squaredNorm();
    }
    if (!bench.isEngaged() || !(sum.norm() / kTicks > 0.5)) return kNan;  // it must press, and be felt
    return std::sqrt(std::max(0.0, squares / kTicks - (sum / kTicks).squaredNorm()));
}

double plane(const Variant& variant) {
    Scene scene(planeBone(), burr(), variant);
    AresBench bench(scene, abovePlane(0.5e-3), {abovePlane(-5e-3).position, expRotation({0.05, 0, 0.05})});
    return forceResidual(bench);
}

double pegInHole(const Variant& variant) {
    Scene scene(holeBone(), peg(), variant);
    AresBench bench(scene, upright(kHoleMiddle),
                    {kHoleMiddle + Eigen::Vector3d(2e-3, 0, 1e-3), expRotation({0.07, 0, 0.1})});
    return forceResidual(bench);
}

const std::vector<StabilityCase> kAresLoopCases{
    {"ares_presses_on_plane", "N_rms", 0.05, plane, {}},
    {"ares_peg_in_hole", "N_rms", 0.05, pegInHole, {}, feltEffects()},
};
BONEMILL_STABILITY_CASES(Ares, kAresLoopCases);

}  // namespace
}  // namespace bonemill::test
