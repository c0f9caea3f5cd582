// A session that is written down as functions of time, so that what is measured of it is known in closed
// form.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "haptic_server/assessment/measures/technique.h"

namespace bonemill::test {

inline constexpr double kPi = std::numbers::pi;

struct HandMadeSession {
    double seconds = 1;
    double rate = 1000;  // Hz
    double begin_s = 0;
    std::function<Eigen::Vector3d(double)> place = [](double) {
        return Eigen::Vector3d::Zero().eval();
    };                                                                 // m
    std::function<double(double)> force = [](double) { return 0.0; };  // N, along -y: on the shaft's end
    std::function<bool(double)> contact = [](double) { return false; };
    std::function<double(double)> removed_until = [](double) { return 0.0; };  // m³
    std::function<void(double, TickRecord&)> more = [](double, TickRecord&) {};

    void play(const std::function<void(const TickRecord&)>& see) const {
        const auto ticks = int64_t(std::llround(seconds * rate));
        double removed_before = 0;
        for (int64_t n = 0; n <= ticks; ++n) {
            const double t = double(n) / rate;
            TickRecord record{};
            record.tick = uint64_t(n);
            record.t_s = begin_s + t;
            Eigen::Map<Eigen::Vector3d>(record.p_WT) = place(t);
            record.q_WT[0] = 1;
            record.contacts = contact(t) ? 1 : 0;
            record.f_hand_W[1] = force(t);
            const double removed = removed_until(t);
            record.removed = removed - std::exchange(removed_before, removed);
            more(t, record);
            see(record);
        }
    }
    // Measured from beginning to end.
    void measure(Technique& technique) const {
        play([&](const TickRecord& record) { technique.add(record); });
        technique.finish();
    }
    Figures figures(const TechniqueScene& scene = {}) const {
        Technique technique(scene);
        measure(technique);
        return technique.figures();
    }
};

// NaN if there is none.
inline double valueOf(const Figures& figures, const std::string& id) {
    const Figure* const figure = findFigure(figures, id);
    return figure ? figure->value : std::nan("");
}

}  // namespace bonemill::test
