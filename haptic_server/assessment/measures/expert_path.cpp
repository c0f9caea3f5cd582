#include "haptic_server/assessment/measures/expert_path.h"

#include <algorithm>

namespace bonemill {

std::optional<Pose> ExpertPath::at(double t_s) const {
    if (points_.empty() || !(t_s >= points_.front().t_s) || t_s > points_.back().t_s) return std::nullopt;
    const auto next = std::ranges::lower_bound(points_, t_s, {}, &Point::t_s);
    if (next == points_.begin()) return next->X_WT;
    const Point& before = *std::prev(next);
    const double share = (t_s - before.t_s) / (next->t_s - before.t_s);
    return Pose{before.X_WT.position + share * (next->X_WT.position - before.X_WT.position),
                before.X_WT.rotation.slerp(share, next->X_WT.rotation)};
}

}  // namespace bonemill
