// A device loop with a fake device and a server that a test words, in simulated time.
#pragma once

#include <functional>
#include <limits>

#include "device_daemon/control/device_loop/device_loop.h"
#include "tests/support/fake_device.h"

namespace bonemill::test {

class LoopRig {
  public:
    static constexpr double kPeriod = 1e-3;  // s
    static constexpr int64_t kPeriodNs = 1'000'000;

    explicit LoopRig(const DeviceLoopConfig& config = {}, const SafetyLatch& latch = {})
        : loop(device, config, latch) {}

    // One period: reading, sample, the server's answer to the sample before, order.
    void step() {
        now_ns += kPeriodNs;
        has_sample = loop.read(now_ns, kPeriod, sample);
        if (is_server_there) {
            command.stamp_ns = now_ns - kPeriodNs / 2;
            server(command);
        }
        loop.write(has_answered() ? &command : nullptr, now_ns);
    }
    void run(double seconds) {
        for (int i = 0; i < seconds / kPeriod - 0.5; ++i) step();
    }
    // Presses the enabling switch afresh, with no force commanded meanwhile.
    void engage() {
        const auto wanted = std::exchange(server, [](WrenchCommand& c) { setForce(c, 0); });
        device.reading.status &= ~uint32_t(kStatusEnabled);
        step();
        device.reading.status |= kStatusEnabled;
        run(0.4);
        server = wanted;
        run(0.1);
    }
    SafetyState state() const { return loop.safety().state(); }
    StopCause cause() const { return loop.safety().cause(); }
    // What the motors give: nothing once they are not wanted.
    double force() const { return device.order.is_wanted ? device.order.wrench_hand_D.force.norm() : 0; }

    static void setForce(WrenchCommand& command, double fz) {
        command.f_hand_D[0] = command.f_hand_D[1] = 0;
        command.f_hand_D[2] = fz;
        for (double& t : command.t_hand_D) t = 0;
    }

    FakeDevice device;
    DeviceLoop loop;
    int64_t now_ns = 1'000'000'000;
    bool is_server_there = true;
    std::function<void(WrenchCommand&)> server = [](WrenchCommand& c) { setForce(c, 10); };
    WrenchCommand command{};
    DeviceSample sample{};
    bool has_sample = false;

  private:
    bool has_answered() const { return command.stamp_ns != 0; }
};

}  // namespace bonemill::test
