// An attempt as a class has many: with gates, scores, a total, series and moments.
#pragma once

#include <cmath>
#include <limits>

#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill::test {

inline Figure figure(const std::string& id, double value, const std::string& unit) {
    return {id, 1, "Figure " + id, value, unit};
}

inline AttemptResult typicalResult(const std::string& pseudonym = "P07", uint32_t number = 3) {
    AttemptResult result;
    result.pseudonym = pseudonym;
    result.number = number;
    result.scene_id = "tooth_cavity";
    result.scene_title = "Class I cavity, molar";
    result.scene_hash = "00000000deadbeef";
    result.start_unix_ns = 1'795'000'000'000'000'000 + int64_t(number) * 600'000'000'000;
    result.duration_s = 61.5;
    result.journal = "session.mcap";
    Assessment& assessment = result.assessment;
    assessment.figures = {figure("force.max", 6.25, "N"), figure("damage.volume:nerve", 0.8, "mm3"),
                          figure("time.session", 61.5, "s"), figure("force.median", 2.1, "N"),
                          figure("time.pedal", 31.5, "s")};
    assessment.gates = {{"damage:nerve", "The nerve is whole", "damage.volume:nerve", 0, true, false,
                         "0.8 mm³ of the nerve were cut; 0 are allowed"},
                        {"target", "Most of the target is gone", "target.removed", 90, false, true,
                         "97 % are gone; 90 are asked"}};
    assessment.sub_scores = {{"force", "Pressure", assessment.figures[0], 10, 2, 0.47, 1}};
    assessment.total = Total{0.47, 0.97, 2, "0123456789abcdef"};
    SeriesTable seconds{"second", {"t", "Time", "s", {}}, {}};
    Series force{"force", "Force", "N", {}}, peak{"force_max", "Peak", "N", {}},
        removed{"removed", "Removed", "mm3", {}}, distance{"distance", "Distance", "mm", {}};
    for (int n = 0; n < 62; ++n) {
        seconds.index.values.push_back(n + 1);
        const bool is_in_contact = n > 5;
        const double pressed = 2 + std::sin(0.2 * n);
        force.values.push_back(is_in_contact ? pressed : std::numeric_limits<double>::quiet_NaN());
        peak.values.push_back(is_in_contact ? 1.8 * pressed : std::numeric_limits<double>::quiet_NaN());
        removed.values.push_back(is_in_contact ? 0.6 + 0.3 * std::cos(0.3 * n) : 0);
        distance.values.push_back(3.2 - 0.055 * n);
    }
    seconds.columns = {force, peak, removed, distance};
    SeriesTable buckets{"bucket", {"share", "Share", "percent", {20, 40, 60, 80, 100}}, {}};
    buckets.columns = {{"force", "Force", "N", {2, 2.5, 3, 2.2, 1.5}}};
    assessment.series = {seconds, buckets};
    assessment.moments = {{112.4, "force", "5.2 N on the bone", 0.52},
                          {140.1, "touch", "nerve touched with 0.6 N", 3.06},
                          {158.9, "damage", "nerve cut: 0.8 mm³", 10.8}};
    return result;
}

}  // namespace bonemill::test
