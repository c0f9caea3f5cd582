// Turns deflections of a SpaceMouse or of sticks into rates, and rates into a wanted pose of the handle.
//
// Each deflection goes through a dead zone, so that a released device stands still, and a cubic curve, so
// that a light touch moves slowly. The frames are U, the user's axes (hand_input.h), and D, the device's
// base; units are m, rad, s. Everything is deterministic and RT-safe, for one thread.
#pragma once

#include <array>

#include "common/geometry/hand_space.h"

namespace bonemill {

struct RateConfig {
    double max_speed = 0.06;  // m/s of the tool, with all axes together
    double max_spin = 1;      // rad/s, at full deflection
    double dead_zone = 0.1;   // share of the full deflection
    double fine_share = 0.2;  // of the rates in the fine mode
    HandSpace hand_space = {};
    Eigen::Quaterniond R_DU = Eigen::Quaterniond::Identity();
};

struct Rates {
    Eigen::Vector3d v_D = Eigen::Vector3d::Zero();  // m/s, of the handle
    Eigen::Vector3d w_D = Eigen::Vector3d::Zero();  // rad/s
};

// Returns the share of the full rate, -1 to 1, for any deflection; 0 for what is not finite.
double responseOf(double deflection, double dead_zone) noexcept;

// The deflections are along and about U's x, y, z. No rate exceeds those of the configuration.
Rates ratesOf(const std::array<float, 6>& deflections, bool is_fine, const RateConfig& config) noexcept;

// How far a wish may lead the handle: as far as the hand's strength stretches its spring.
struct Leash {
    double distance;  // m
    double angle;     // rad
};

// The wish moves at the rates while the handle follows. Where something holds the handle back, the wish slows
// down and stops at the end of the leash, so that the hand pulls with its full strength there, and turning
// round is felt at once.
class RateWish {
  public:
    RateWish(const Pose& X_DT_start, const Leash& leash) noexcept : X_DT_(X_DT_start), leash_(leash) {}

    void advance(double elapsed, const Rates& rates, const Pose& X_DT_handle) noexcept;
    // Wants the handle where it is.
    void restAt(const Pose& X_DT_handle) noexcept { X_DT_ = X_DT_handle; }

    const Pose& pose() const noexcept { return X_DT_; }

  private:
    Pose X_DT_;
    Leash leash_;
};

}  // namespace bonemill
