// Poses and boxes of the topics' messages are checked: what came over the network may be anything.
#pragma once

#include <optional>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"

namespace bonemill {

using WireVector = google::protobuf::RepeatedField<double>;

// Returns three finite numbers, or nothing.
inline std::optional<Eigen::Vector3d> readVector(const WireVector& v) {
    if (v.size() != 3) return std::nullopt;
    const Eigen::Vector3d vector(v[0], v[1], v[2]);
    if (!vector.allFinite()) return std::nullopt;
    return vector;
}

// Returns position (m) and quaternion (w, x, y, z; normalised here), or nothing.
inline std::optional<Pose> readPose(const WireVector& position, const WireVector& quaternion) {
    const auto p = readVector(position);
    if (!p || quaternion.size() != 4) return std::nullopt;
    const Eigen::Quaterniond q(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
    const double norm = q.norm();
    if (!(norm > 1e-6) || !std::isfinite(norm)) return std::nullopt;
    return Pose{*p, q.normalized()};
}

}  // namespace bonemill
