#include "device_daemon/ares/driver/operator_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bonemill {
namespace {

// Physiological tremor has 8 to 12 Hz. The frequencies are incommensurable, so that the axes never move in
// step for long.
constexpr double kTremorFrequencies_hz[3][3] = {{8.3, 9.7, 11.9}, {8.9, 10.3, 11.3}, {8.1, 9.1, 10.9}};
constexpr double kTremorPhases_rad[3][3] = {{0.3, 1.9, 4.1}, {2.7, 5.3, 0.9}, {4.7, 3.1, 1.3}};

}  // namespace

OperatorPath::OperatorPath(std::vector<Waypoint> waypoints, double tremor)
    : waypoints_(std::move(waypoints)), tremor_(tremor) {
    for (size_t i = 0; i + 1 < waypoints_.size(); ++i) {
        turns_.push_back(
            logRotation(waypoints_[i + 1].X_DT.rotation * waypoints_[i].X_DT.rotation.conjugate()));
    }
}

HandTarget OperatorPath::at(double t) const noexcept {
    HandTarget target = withoutTremor(t);
    if (tremor_ > 0) addTremor(t, target);
    return target;
}

HandTarget OperatorPath::withoutTremor(double t) const noexcept {
    HandTarget target;
    if (waypoints_.empty()) return target;
    const auto after = std::upper_bound(waypoints_.begin(), waypoints_.end(), t,
                                        [](double time, const Waypoint& w) { return time < w.time; });
    target.waypoint = static_cast<int>(after - waypoints_.begin()) - 1;
    if (target.waypoint < 0) {
        target.X_DT = waypoints_.front().X_DT;
        return target;
    }
    const Waypoint& from = waypoints_[target.waypoint];
    target.buttons = from.buttons;
    target.X_DT = from.X_DT;
    if (after == waypoints_.end()) return target;

    const double span = after->time - from.time;
    const double u = (t - from.time) / span;
    const double s = u * u * (3 - 2 * u);
    const double s_rate = 6 * u * (1 - u) / span;
    const Eigen::Vector3d way = after->X_DT.position - from.X_DT.position;
    const Eigen::Vector3d& turn = turns_[target.waypoint];
    target.X_DT = from.X_DT.incremented(s * way, s * turn);
    target.v_DT = s_rate * way;
    target.w_DT = s_rate * turn;
    return target;
}

void OperatorPath::addTremor(double t, HandTarget& target) const noexcept {
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 3; ++k) {
            const double w = 2 * std::numbers::pi * kTremorFrequencies_hz[axis][k];
            const double angle = w * t + kTremorPhases_rad[axis][k];
            target.X_DT.position[axis] += tremor_ / 3 * std::sin(angle);
            target.v_DT[axis] += tremor_ / 3 * w * std::cos(angle);
        }
    }
}

}  // namespace bonemill
