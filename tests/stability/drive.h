// Runs ticks of the real HapticTick: along a scripted device pose, or in a closed loop with the plant.
#pragma once

#include <deque>
#include <random>
#include <vector>

#include "haptic_server/core/tick/haptic_tick.h"
#include "tests/stability/plant.h"
#include "tests/stability/scene.h"

namespace bonemill::test {

// It makes one tick at a time with whatever device pose the caller says.
class Stepper : private TickIo {
  public:
    // It takes `tools` instead of the scene's tool, if it is not null, and a history if that is not null.
    explicit Stepper(Scene& scene, const ToolSwitch* tools = nullptr, BoneHistory* history = nullptr);

    const TickRecord& step(const Pose& X_WT_device, uint32_t buttons = 0);
    void holdButtons(uint32_t buttons) noexcept { held_buttons_ = buttons; }
    // The accuracy is this preset's from the end of the next step on, once its contact points are there.
    void choose(Preset preset) noexcept { accuracy_.choose(AccuracySwitch::choiceOf(preset)); }
    // Until this is called again the device is silent, and the force has this factor; or (1) it is there.
    void fadeDevice(double stale_factor, bool is_stale) noexcept {
        input_.stale_factor = stale_factor;
        input_.is_stale = is_stale;
    }
    // From the next step on the hand holds this one, which must outlive that step.
    void plugIn(const DeviceCapabilities* device) noexcept { input_.other_device = device; }
    const Wrench& wrenchOnHand() const noexcept { return wrench_; }
    Pose spo() const noexcept { return tick_.X_WT(); }
    const TickRecord& record() const noexcept { return record_; }
    // It is also false where the tick hid what was not finite: it kept its pose, or left contact points out.
    bool isFinite() const noexcept {
        return wrench_.isFinite() && spo().isFinite() && !(faults_ & (kFaultSolve | kFaultShellOverflow));
    }

  private:
    bool read(DeviceInput& input) noexcept override;
    int64_t write(const Wrench& wrench_hand_W) noexcept override;
    int64_t now() noexcept override { return 0; }

    uint32_t faults_ = 0;
    uint32_t held_buttons_;
    ToolSwitch own_tool_;
    AccuracySwitch accuracy_;
    HapticTick tick_;
    DeviceInput input_;
    Wrench wrench_;
    TickRecord record_{};
};

struct LoopConfig {
    int delay_ticks = 1;  // a wrench computed from sample k acts from sample k + delay on
    DevicePlant device;
    HandPlant hand;
    double late_ticks = 0;    // beside whole ticks, below 1
    double jitter_ticks = 0;  // the delay varies by up to so much, evenly
    double lost_share = 0;    // of the periods, in which the controller hears nothing
    double most_force = 0;    // N that the motors give; 0: all
    bool has_torque = true;   // of its motors
};

// What such a device says of itself.
DeviceCapabilities declared(const LoopConfig& config, double dt);
// What it says of itself with figures that are wrong by up to this share, each to either side by the seed.
DeviceCapabilities declaredWrongly(const LoopConfig& config, double dt, double share, uint32_t seed);
// It says only what it gives, as a bridge does that knows no more.
DeviceCapabilities declaredLittle(const LoopConfig& config);

class ClosedLoop {
  public:
    ClosedLoop(const LoopConfig& config, Scene& scene, const Pose& start, const ToolSwitch* tools = nullptr,
               BoneHistory* history = nullptr);

    // These buttons are pressed beside those that the scene holds.
    void step(uint32_t buttons = 0);
    // The controller misses a period: the device holds the last wrench.
    void dropTick();
    void run(double seconds);
    // The device says what it is like, from the next step on.
    void declare() { declare(declared(config_, dt)); }
    void declare(const DeviceCapabilities& says);

    Plant plant;
    Stepper stepper;
    double dt;
    size_t averaged_ticks;

  private:
    // The handle starts where the tool does.
    Pose toolPose() const noexcept;
    void actuate(double time);
    double random() { return std::uniform_real_distribution<>(0, 1)(random_); }

    LoopConfig config_;
    DeviceCapabilities declared_;
    std::minstd_rand random_;
    Pose start_;
    double workspace_scale_;
    std::deque<Wrench> on_the_way_;
    Wrench held_;
};

// It tells of a window's signal how far it spreads about its mean, and whether it grows.
struct Residual {
    double rms = 0;           // of the force (mean over the scene's averaged_ticks) about its mean, N
    double torque_rms = 0;    // N·m
    double position_rms = 0;  // of the true handle position about its mean, m
    double growth = 0;        // RMS of the second half over that of the first
    bool is_finite = true;
    bool is_touching = false;  // in contact at the end
};
Residual residual(ClosedLoop& loop, double seconds);

// Returns the RMS of the force over `watch` s after `settle` s, or kNan or kLost if that says nothing.
double forceBuzz(ClosedLoop& loop, double settle, double watch);

}  // namespace bonemill::test
