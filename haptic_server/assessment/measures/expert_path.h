// The way of an expert's tool through a task, to be shown beside an attempt. It never changes; any thread may
// read.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

class ExpertPath {
  public:
    struct Point {
        double t_s;  // since the attempt began; pauses do not count
        Pose X_WT;
    };

    // The times increase.
    explicit ExpertPath(std::vector<Point> points) : points_(std::move(points)) {}

    // Where the tool was at this time, between two points by their share; nothing before the first point and
    // after the last.
    std::optional<Pose> at(double t_s) const {
        if (points_.empty() || !(t_s >= points_.front().t_s) || t_s > points_.back().t_s) return std::nullopt;
        const auto next = std::ranges::lower_bound(points_, t_s, {}, &Point::t_s);
        if (next == points_.begin()) return next->X_WT;
        const Point& before = *std::prev(next);
        const double share = (t_s - before.t_s) / (next->t_s - before.t_s);
        return Pose{before.X_WT.position + share * (next->X_WT.position - before.X_WT.position),
                    before.X_WT.rotation.slerp(share, next->X_WT.rotation)};
    }

  private:
    std::vector<Point> points_;
};

}  // namespace bonemill
