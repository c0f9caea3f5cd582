// What a lab engineer watches: force, torque and the tick's own work over the last seconds. It belongs to the
// render thread.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "render_client/hand/controls/session_view.h"

namespace bonemill {

class PlotHistory {
  public:
    static constexpr size_t kLength = 1000;
    static constexpr double kStep = 0.01;  // s of each value: 10 s in all

    // Values over time in a ring, whose oldest one stands at `next`.
    struct Curve {
        std::array<float, kLength> values{};
        size_t next = 0;

        void add(double value);  // what is not finite counts as 0
        float newest() const { return values[(next + kLength - 1) % kLength]; }
        float largest() const;
    };

    // Takes what the session says at its time_s; until the next call that is the value. Another server begins
    // anew.
    void update(const SessionView& session);
    const Curve& force() const { return force_; }    // N, on the hand
    const Curve& torque() const { return torque_; }  // N·mm, about the tool point
    const Curve& tick() const { return tick_; }      // µs, p99

  private:
    Curve force_, torque_, tick_;
    uint64_t epoch_ = 0;
    double shown_s_ = 0;  // up to there there are values
};

}  // namespace bonemill
