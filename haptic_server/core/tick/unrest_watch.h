// Sees whether hand and device swing to and fro by themselves against bone, and go on doing so.
//
// A loop that is stable comes to rest: its swing becomes smaller from window to window. One that is not, and
// one that dances on the steps of its encoders, does not, whatever the device has said of itself. So the
// watch looks at what happens at the port: while the handle stays about where it is, how much the felt wrench
// alternates about its slow mean, in windows of a fifth of a second.
//
// Poses and wrenches are in V and the tool's, of the coupling alone. It is RT-safe, for the tick thread.
#pragma once

#include <array>

#include "common/geometry/pose.h"

namespace bonemill {

// How long a swing may go on before it is said.
enum class Patience {
    kNone,  // it was seen a short while ago
    kUsual,
    kGreat,  // a device that has told of itself is helped by other means, which take longer
};

// How a vector, of force or of torque, alternates about its slow mean.
class Alternation {
  public:
    // It goes on if it stays above this RMS.
    explicit Alternation(double least) noexcept : least_(least) {}

    void add(const Eigen::Vector3d& value, double share_of_mean) noexcept;
    // Ends a window. Returns its RMS if it goes on, else 0.
    double judge(Patience patience) noexcept;
    bool isQuiet() const noexcept { return last_rms_ <= least_; }  // in the window before
    void beginWindow() noexcept;
    // What was seen says nothing of what comes. The mean stays, unless it is of something else.
    void forget(bool with_mean) noexcept;

  private:
    static constexpr int kRemembered = 5;  // windows

    double least_;
    Eigen::Vector3d mean_ = Eigen::Vector3d::Zero(), side_ = Eigen::Vector3d::Zero();
    bool has_mean_ = false;
    double sum_ = 0;
    int count_ = 0, crossings_ = 0;
    double last_rms_ = 0;
    std::array<double, kRemembered> rms_{};  // of the windows before, the newest first
    int windows_ = 0;
};

struct Unrest {
    double force_rms = 0, torque_rms = 0;  // N, N·m; 0 where that is at rest, or comes to rest
    bool isAny() const noexcept { return force_rms > 0 || torque_rms > 0; }
};

class UnrestWatch {
  public:
    static constexpr double kWindow = 0.2;                            // s
    static constexpr double kLeastForce = 4e-3, kLeastTorque = 4e-5;  // N, N·m RMS: what no hand feels

    explicit UnrestWatch(double dt) noexcept;

    // Something else than the loop changes what is felt: what has been seen says nothing.
    void begin() noexcept;
    // The coupling was made softer because of the unrest that was seen.
    void settle() noexcept;
    // Takes a tick, and returns what goes on at the end of a window, else nothing.
    Unrest add(const Pose& X_VT_device, const Wrench& wrench_hand_V, bool is_touching) noexcept;
    // Another device is there. Whether it has told of itself says how long to wait for it to come to rest.
    void expectOtherDevice(bool has_told) noexcept;

  private:
    Unrest judge() noexcept;
    void beginWindow() noexcept;

    int ticks_in_window_;
    double share_of_mean_;
    Alternation force_{kLeastForce}, torque_{kLeastTorque};
    bool is_known_ = false, has_told_ = false;
    Eigen::Vector3d p_V_first_ = Eigen::Vector3d::Zero();  // the window's first place, where it counts from
    Eigen::Vector3d p_V_mean_before_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d place_sum_ = Eigen::Vector3d::Zero();
    double place_squares_ = 0;
    int ticks_ = 0, touching_ = 0;
};

}  // namespace bonemill
