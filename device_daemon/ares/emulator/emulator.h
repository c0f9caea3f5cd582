// Runs the emulated controller in its own real-time thread on a UDP socket, and looks after it in another.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/process/hand_order.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/ares/emulator/emulated_controller.h"
#include "device_daemon/ares/emulator/fault_spec.h"
#include "device_daemon/ares/emulator/scenario.h"
#include "device_daemon/ares/wire/packet_flow.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill {

// The command line of ares_emulator.
struct EmulatorOptions {
    std::string scene;
    std::string address = "127.0.0.1";
    uint16_t port = 0;              // 0: any free one
    uint16_t host_port = 0;         // of this PC, the only one that is listened to; 0: any host
    std::optional<double> rate_hz;  // not given: the scene's
    std::optional<double> seconds;  // of the scenario; not given: until the last waypoint
    bool hold = false;
    double watchdog_ms = 5;
    bool is_unhomed = false;
    std::vector<FaultSpec> faults;
    uint32_t seed = 1;
    bool is_strict_realtime = false;
    int core = -1;  // any
    std::string log_level = "info";
    std::optional<int> parent;  // process to end with
};

// What the emulator counted.
struct EmulatorStatistics {
    uint64_t ticks = 0;
    uint64_t missed_periods = 0;
    double wall_time = 0;           // s
    double scenario_time = 0;       // s
    double max_tracking_error = 0;  // m, hand against its own wish
    uint64_t stop_ticks = 0;        // handle at the end of its workspace
    uint64_t packets_sent = 0;
    wire::FlowStatistics commands;
    uint64_t watchdog_trips = 0;
    std::string final_phase;
};

// Returns one JSON object on one line, with the units in the names.
std::string jsonLineOf(const EmulatorStatistics& statistics);

class Emulator {
  public:
    // Listens from now on. listenToHandOrders() was called; `stop_signals` must outlive the emulator. Throws
    // UserError when the address is not free, or the watchdog is too short for the rate.
    Emulator(const Scenario& scenario, const EmulatorOptions& options, const StopSignals& stop_signals);

    wire::Endpoint local() const noexcept { return socket_.local(); }

    // Blocks until the scenario, --seconds or a signal ends it and the host has switched off. Throws
    // UserError when there is no real-time scheduling with --strict-rt.
    void run();

    const EmulatorStatistics& statistics() const noexcept { return statistics_; }

  private:
    // The loop writes it and the watcher reads it. Each value is complete in itself, so relaxed order is
    // enough.
    struct Progress {
        std::atomic<bool> was_engaged = false;
        std::atomic<int> waypoint = -1;
        std::atomic<double> scenario_time = 0;
        std::atomic<uint32_t> fault = 0;
        std::atomic<bool> is_finished = false;
    };

    void runLoop();
    void listenUntil(int64_t instant_ns) noexcept;
    void takeDatagrams(int64_t now_ns) noexcept;
    void deliverCommands(int64_t now_ns) noexcept;
    void deliverStates(int64_t now_ns) noexcept;
    void tick(int64_t now_ns) noexcept;
    void obeyHandOrder() noexcept;
    void record() noexcept;
    bool shouldEnd() const noexcept;
    bool hasLeft(int64_t now_ns) noexcept;
    void finish(int64_t start_ns, uint64_t missed_periods);

    void watch();
    void hearHandOrders();
    void reportProgress(int& shown_waypoint, uint32_t& shown_fault) const;
    std::string phase() const;

    Scenario scenario_;
    EmulatorOptions options_;
    const StopSignals& stop_signals_;
    double rate_hz_;
    int64_t period_ns_;
    double end_time_;  // of the scenario, s
    wire::UdpSocket socket_;
    FaultyWire from_host_;
    FaultyWire to_host_;
    EmulatedController controller_;
    int64_t leaving_since_ns_ = 0;  // 0: not yet
    EmulatorStatistics statistics_;
    Progress progress_;
    std::atomic<HandOrder> hand_order_ = HandOrder::kNone;  // from the watcher to the loop
    std::atomic<bool> should_stop_ = false;
};

}  // namespace bonemill
