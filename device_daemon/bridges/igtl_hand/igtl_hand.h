// A hand that another program holds and tells by OpenIGTLink's TRANSFORM (docs/howto/bridges.md): a robot, a
// tracker, 3D Slicer. Each of its poses is answered by the wrench on the hand.
//
// The port has a thread of its own; what it heard last comes to the arm's loop through one Seqlock, and the
// wrench goes back through another. Nothing of a peer reaches the loop but finite poses.
#pragma once

#include <array>
#include <atomic>
#include <string>
#include <thread>

#include "common/igtl_wire/igtl_port.h"
#include "common/rt/realtime.h"
#include "common/rt/seqlock.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/igtl_hand/paced_hand.h"

namespace bonemill::bridge {

struct IgtlHandOptions {
    std::string address = "127.0.0.1";
    uint16_t port = 18945;
    std::string peer;    // only this address may hold the hand; empty: this PC's
    std::string device;  // that the TRANSFORM names; empty: any
    std::string axes = "x,y,z";
    std::array<double, 3> origin_mm{};
    bool is_place_only = false;  // how the hand is turned is not taken
    double max_torque = 0;       // N·m
    double workspace_mm = 150;   // radius
};

class IgtlHand : public Arm, private igtl::LineSink {
  public:
    IgtlHand(const BridgeOptions& options, const IgtlHandOptions& hand) : options_(options), hand_(hand) {}
    ~IgtlHand() override { stop(); }

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    void came(igtl::Line& line) override;
    void heard(igtl::Line& line, const igtl::Frame& frame) override;
    void gone(const igtl::Line& line) override;
    void hearPose(igtl::Line& line, const igtl::Frame& frame);
    void hearButtons(const igtl::Line& line, const igtl::Frame& frame);
    void listen() noexcept;
    void run(ArmPeriod& period) noexcept;

    const BridgeOptions options_;
    const IgtlHandOptions hand_;
    Tell tell_;
    Eigen::Matrix3d R_DP_ = Eigen::Matrix3d::Identity();  // P: the peer's axes
    std::optional<igtl::Port> port_;
    HeardPose newest_;     // of the port's thread
    uint64_t holder_ = 0;  // the line that holds the hand; 0: none
    Seqlock<HeardPose> heard_;
    Seqlock<std::array<double, 6>> wrench_P_;
    std::atomic<bool> shall_end_{false};
    std::thread listener_;
    RealtimeThread loop_;
    bool has_loop_ = false;
};

// The rotation from the peer's axes to D's: which of the peer's axes D's x, y and z are, as "-y,x,z". Throws
// UserError for what is none, or left-handed.
Eigen::Matrix3d axesOf(const std::string& text);

}  // namespace bonemill::bridge
