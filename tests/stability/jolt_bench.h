// A burr on a bone in a hand that follows a script, with everything that may happen to it, and the meter of
// jolts (jolts.h).
#pragma once

#include <functional>

#include "haptic_server/core/bone/bone_history.h"
#include "tests/stability/drive.h"
#include "tests/stability/jolts.h"

namespace bonemill::test {

// The tool's centre is where it must not be.
using WrongSide = std::function<bool(const Eigen::Vector3d& p_W)>;

class JoltBench {
  public:
    static constexpr double kDt = 1e-3;                        // s
    static constexpr double kSmall = 0.5e-3, kLarge = 1.5e-3;  // m, beside kBurrRadius
    static constexpr size_t kBurr = 0, kSmallBurr = 1, kLargeBurr = 2;
    static constexpr double kMaxPull = 11.5;  // N: what a scene allows this burr

    JoltBench(VoxelVolume volume, const Variant& variant, const Eigen::Vector3d& start,
              const std::function<void(FixedTickConfig&)>& edit = {});

    // The hand comes to rest and all that was measured is forgotten.
    void settle(int ticks = 400);
    // The hand moves on with this velocity, m/s, or rests.
    void run(int ticks, const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero(), uint32_t buttons = 0);
    // The same, but these are the samples that the tick gets to see.
    void runFalse(int ticks, const Pose& sample, const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());
    void change(size_t tool) { tools_.choose(tool); }
    void choose(Preset preset) { stepper_.choose(preset); }
    Stepper& stepper() { return stepper_; }
    BoneHistory& history() { return history_; }
    Pose hand() const { return hand_; }
    void forbid(WrongSide wrong_side) { wrong_side_ = std::move(wrong_side); }
    // From here on the recovery counts.
    void beginRecovery() { recovering_from_ = forces_.size(); }
    JoltFigures figures() const;

  private:
    void step(const Pose& sample, const Eigen::Vector3d& velocity, uint32_t buttons);

    Scene scene_;
    BoneHistory history_;
    ToolModel small_, large_;
    ToolSwitch tools_;
    Stepper stepper_;
    double quick_stiffness_, drag_;
    Pose hand_;
    WrongSide wrong_side_;
    Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> forces_;
    size_t recovering_from_ = 0;
    JoltFigures figures_;
};

}  // namespace bonemill::test
