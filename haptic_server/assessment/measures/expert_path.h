// The way of an expert's tool through a task, to be shown beside an attempt. It never changes; any thread may
// read.
#pragma once

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
    std::optional<Pose> at(double t_s) const;

  private:
    std::vector<Point> points_;
};

}  // namespace bonemill
