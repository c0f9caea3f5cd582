#include "haptic_server/assessment/measures/sight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "haptic_server/assessment/measures/definitions.h"

namespace bonemill {

// Half a voxel per step misses no wall of a voxel's thickness.
bool isHidden(const VoxelVolume& volume, const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_target_W,
              double margin) {
    const Pose X_VW = volume.geometry().X_WV.inverse();
    const Eigen::Vector3d eye_I = (X_VW * p_eye_W).cwiseQuotient(volume.spacing());
    const Eigen::Vector3d target_I = (X_VW * p_target_W).cwiseQuotient(volume.spacing());
    const double distance = (p_target_W - p_eye_W).norm();
    if (!(distance > margin)) return false;
    const Eigen::Vector3d way = (target_I - eye_I) * (1 - margin / distance);
    // Only the part in the volume is walked.
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double high = volume.dims()[axis] - 1;
        if (std::abs(way[axis]) < 1e-12) {
            if (eye_I[axis] < 0 || eye_I[axis] > high) return false;
            continue;
        }
        const double a = -eye_I[axis] / way[axis], b = (high - eye_I[axis]) / way[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (first > last) return false;
    const auto steps = std::max(1, int(std::ceil(2 * way.norm() * (last - first))));
    for (int step = 0; step <= steps; ++step) {
        const double share = first + (last - first) * step / steps;
        const Eigen::Vector3i voxel = (eye_I + share * way).array().round().cast<int>();
        const Eigen::Vector3i inside = voxel.cwiseMax(0).cwiseMin(volume.dims() - Eigen::Vector3i::Ones());
        if (volume.at(inside.x(), inside.y(), inside.z()) >= volume.iso()) return true;
    }
    return false;
}

void Sight::setEye(const Eigen::Vector3d& p_eye_W) noexcept {
    if (!p_eye_W.allFinite()) return;
    p_eye_W_ = p_eye_W;
    has_eye_ = true;
}

Sight::Found Sight::add(const TickStep& step) {
    removed_ += step.record.removed;
    pending_ += step.record.removed;
    if (!is_hidden_ || step.t() < next_s_ || pending_ <= 0) return {};
    next_s_ = step.t() + kEvery;
    const double removed = std::exchange(pending_, 0);
    if (!has_eye_) return {};
    const Eigen::Vector3d to_eye = p_eye_W_ - step.p_W();
    if (const double norm = to_eye.norm(); norm > 0)
        view_angle_.add(std::acos(std::clamp(to_eye.dot(step.axis_W()) / norm, -1.0, 1.0)) / kDegree,
                        removed);
    const bool is_hidden = is_hidden_(p_eye_W_, step.p_W(), step.record.tool);
    (is_hidden ? unseen_ : seen_) += removed;
    return is_hidden ? Found{0, removed} : Found{removed, 0};
}

void Sight::append(Figures& figures) const {
    if (!has_eye_) return;
    put(figures, "sight.unseen", 100 * unseen_ / (seen_ + unseen_));
    put(figures, "sight.known", 100 * (seen_ + unseen_) / removed_);
    put(figures, "angle.view", view_angle_.median());
}

}  // namespace bonemill
