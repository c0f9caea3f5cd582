// What SpaceMouse and gamepad have in common: rates move a wish, the wish draws a VirtualHandle, and the
// handle feels the wrench of haptic_server. Each deflection goes through a dead zone, so that a released
// device stands still, and a cubic curve, so that a light touch moves slowly.
//
// The frames are U, the user's axes (HandInput), D, the device's base, and T, the handle; units are SI. Rates
// and wishes are deterministic and RT-safe, for one thread. The functions of HapticDevice are RT-safe and
// belong to the loop's thread; publish() and name() are for the one reading thread of the class that derives
// from this. Between the two is nothing but a Seqlock and atomics.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>

#include "common/device_messages/device_messages.h"
#include "common/geometry/hand_space.h"
#include "common/rt/seqlock.h"
#include "device_daemon/hands/virtual_handle/virtual_handle.h"

namespace bonemill {

// What a SpaceMouse or gamepad says of the hand on it, the same for both; the reading thread gives it to the
// loop. Deflections are along x, y, z and about x, y, z of the user's axes U, x right, y up and z towards the
// user in the picture: 0 at rest, -1 and 1 as far as it goes. It is a plain value that may travel through a
// Seqlock.
struct HandInput {
    std::array<float, 6> deflections;
    uint32_t buttons;   // Button bits
    uint32_t is_fine;   // 1: the hand wants to go slowly
    uint32_t is_there;  // 0: nothing is plugged in, and the rest is 0
};

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

class RateDevice : public HapticDevice {
  public:
    DeviceCapabilities capabilities() const noexcept final;
    uint32_t capabilitiesVersion() const noexcept final { return names_ + 1; }
    // False while nothing is plugged in; the handle rests then and no button is pressed.
    bool read(double elapsed, DeviceReading& reading) noexcept final;
    void write(const DeviceOrder& order) noexcept final;

  protected:
    // What the hand has to be told without feeling it.
    struct Felt {
        float force = 0;  // N
        uint32_t buttons = 0;
    };

    RateDevice(DeviceKind kind, std::string_view name, const RateConfig& config, const Pose& X_DT_start);

    void publish(const HandInput& input) noexcept { newest_.write(input); }
    // Takes the name of what has just been plugged in.
    void takeName(std::string_view name) noexcept;
    // Returns what is felt now; any thread.
    Felt felt() const noexcept;

  private:
    struct Name {
        char text[sizeof DeviceCapabilities::name];
    };

    void follow(double elapsed) noexcept;

    const DeviceKind kind_;
    const RateConfig config_;
    Seqlock<HandInput> newest_;
    Seqlock<Name> name_;
    std::atomic<uint32_t> names_ = 0;  // how many came
    std::atomic<float> force_ = 0;     // N on the hand
    std::atomic<uint32_t> buttons_ = 0;

    // These belong to the loop.
    VirtualHandle handle_;
    RateWish wish_;
    Wrench wrench_hand_D_;
    HandInput input_{};
    bool was_there_ = false;
};

}  // namespace bonemill
