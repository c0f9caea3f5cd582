// Makes ticks as a session has them, and their records.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "haptic_server/core/telemetry/tick_record.h"

namespace bonemill::test {

// A hand with tremor; now and then somebody orders something, a sample is missing, another device is there.
inline std::vector<TickRecord> recordedTicks(size_t count, unsigned seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise;
    std::vector<TickRecord> records(count, TickRecord{});
    for (size_t n = 0; n < count; ++n) {
        TickRecord& record = records[n];
        const double t = double(n) * 1e-3;
        record.tick = n;
        record.start_ns = 5'000'000'000 + int64_t(n) * 1'000'000 + int64_t(random() % 50'000);
        record.t_s = double(record.start_ns - records[0].start_ns) / 1e9;
        record.buttons = uint32_t(n / 100 % 3);
        record.device.state = n < 10 ? 0 : 2;
        record.device.flags = uint32_t(n / 50 % 2);
        TickInput& input = record.input;
        for (int axis = 0; axis < 3; ++axis)
            input.p_WT[axis] = 0.01 * std::sin(t + axis) + 2e-6 * noise(random);
        const double turn = 0.3 * std::sin(2 * t) + 1e-5 * noise(random);
        const double q[4] = {-std::cos(turn), std::sin(turn) * 0.6, std::sin(turn) * 0.8,
                             1e-3 * noise(random)};
        const double norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
        for (int part = 0; part < 4; ++part) input.q_WT[part] = q[part] / norm;
        input.stale_factor = n % 97 == 0 ? 0.25 : 1;
        input.placements = uint32_t(n / 300);
        input.faults = n % 101 == 0 ? uint32_t(kFaultEarlySamples) : 0;
        input.periods = n % 89 == 0 ? 3 : 1;
        input.is_repeated = n % 89 == 0;
        input.is_stale = n % 97 == 0;
        input.decisions = {.tool = uint32_t(n / 200 % 2),
                           .accuracy = uint32_t(n / 150 % 4),
                           .is_milling_paused = n % 400 > 350,
                           .is_write_refused = n % 77 == 0,
                           .is_milling_put_off = n % 31 == 0,
                           .is_heat_put_off = n % 13 == 0,
                           .milling_thrift = uint8_t(n / 60 % (kMostThrift + 1)),
                           .most_samples = n > 500 ? 128u : 0u,
                           .bone_order = n / 250};
        record.p_WT[0] = record.input.p_WT[0];
        record.f_hand_W[2] = std::sin(t);
        if (n == 3) {
            input.has_other_device = true;
            input.other_device.max_force = 20;
            input.other_device.max_torque = 0.5;
        }
    }
    return records;
}

}  // namespace bonemill::test
