// Runs the emulated controller in its own real-time thread on a UDP socket, and looks after it in another.
#pragma once

#include <atomic>
#include <cstdint>

#include "common/process/hand_order.h"
#include "common/rt/stop_signals.h"
#include "device_daemon/ares/emulator/emulated_controller.h"
#include "device_daemon/ares/emulator/emulator_options.h"
#include "device_daemon/ares/emulator/emulator_statistics.h"
#include "device_daemon/ares/emulator/faulty_wire.h"
#include "device_daemon/ares/emulator/scenario.h"
#include "device_daemon/ares/wire/udp_socket.h"

namespace bonemill {

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
