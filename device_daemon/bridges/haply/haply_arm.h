// An Inverse3 or Minverse of Haply through their Inverse Service: a thread of ours sends it one message in
// each period, and it answers with the arm's state.
//
// Not verified on hardware (docs/howto/bridges.md).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>

#include "common/rt/realtime.h"
#include "common/web_socket/web_socket_client.h"
#include "device_daemon/bridges/bridge/arm.h"
#include "device_daemon/bridges/bridge/bridge_main.h"
#include "device_daemon/bridges/haply/haply_messages.h"

namespace bonemill::bridge {

// The options of the bridge to Haply alone.
struct HaplyOptions {
    std::string host = "127.0.0.1";
    uint16_t port = 10001;
    std::string version = "3.5";
    // In the service's axes; it is where the vendor's documentation shows an arm at rest.
    std::array<double, 3> origin_mm{0, -120, 150};
};

// Takes the service's axes to D.
inline const Eigen::Matrix3d kHaplyAxes{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};

class HaplyArm : public Arm {
  public:
    HaplyArm(const BridgeOptions& options, const HaplyOptions& haply) : options_(options), haply_(haply) {}
    ~HaplyArm() override { stop(); }

    ArmDescription open(const Tell& tell) override;
    void start(ArmPeriod& period) override;
    void stop() noexcept override;

  private:
    void connect();
    void takeInventory();
    // The rest is the loop's thread.
    void run(ArmPeriod& period) noexcept;
    bool exchange(const ArmOrder& order);
    bool send(const std::string& message);
    bool receive(int64_t deadline_ns);
    std::string nextMessage(const ArmOrder& order);
    ArmReading read(bool has_answered) const noexcept;
    void release() noexcept;

    const BridgeOptions options_;
    const HaplyOptions haply_;
    HaplyDialect dialect_;
    Tell tell_;
    std::optional<WebSocketClient> socket_;
    HaplyState state_;

    std::atomic<bool> shall_end_{false};
    RealtimeThread thread_;
    bool has_thread_ = false;

    // Of the loop's thread.
    bool has_spoken_ = false;
    bool has_driven_ = false;
    int64_t unanswered_since_ns_ = 0;  // 0: the last message was answered
    std::string message_;
};

}  // namespace bonemill::bridge
