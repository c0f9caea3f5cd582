// Far-side guard and stiffness cap scale the candidates' energy for the length of one solve.
#include <algorithm>
#include <cmath>

#include "haptic_server/core/contact/gradient_contact.h"

namespace bonemill {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

bool isInside(const VoxelVolume& volume, const Vector3d& p_V) noexcept {
    const Eigen::Array3d index = (p_V.array() / volume.spacing().array()).round();
    if ((index < 0).any() || (index >= volume.dims().cast<double>().array()).any()) return false;
    const Eigen::Vector3i voxel = index.cast<int>().matrix();
    return volume.at(voxel.x(), voxel.y(), voxel.z()) >= volume.iso();
}

constexpr size_t kSampleTests = 4;  // an exact sample by itself takes as long as N distances in a batch

double smoothstep(double t) noexcept {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

void GradientContact::guardFarSide(const VoxelVolume& volume, const ToolField& tool,
                                   const Pose& X_VT) noexcept {
    const double from = kGuardFrom * tool.thinnestRadius(), full = kGuardFull * tool.thinnestRadius();
    const double guard = isInside(volume, X_VT.position) ? 1 : smoothstep((deepest_ - from) / (full - from));
    if (guard == 0) return;
    point_tests_ += kSampleTests * candidates_.count;
    const Pose X_TV = X_VT.inverse();
    for (size_t i = 0; i < candidates_.count; ++i) {
        const Vector3d n = candidates_.normal(i).cast<double>();
        if (n.isZero(0)) continue;
        const Vector3d g = X_VT.rotation * tool.sample(X_TV * positionOf(i)).gradient;
        candidates_.weight[i] *= float(1 - guard * (1 - smoothstep(-n.dot(g) / kGuardWidth)));
    }
}

void GradientContact::capStiffness(const ToolField& tool, const Pose& X_VT) noexcept {
    if (most_stiffness_ <= config_.stiffness_cap) return;
    point_tests_ += kSampleTests * candidates_.count;
    const Pose X_TV = X_VT.inverse();
    Matrix3d stiffness = Matrix3d::Zero();  // T axes
    for (size_t i = 0; i < candidates_.count; ++i) {
        const ToolSample sample = tool.sample(X_TV * positionOf(i));
        const double weight = shareInContact(sample.distance) * double(candidates_.weight[i]);
        if (weight > 0) stiffness += weight * sample.gradient * sample.gradient.transpose();
    }
    if (stiffness.trace() <= config_.stiffness_cap) return;
    point_tests_ += kSampleTests * candidates_.count;
    for (size_t i = 0; i < candidates_.count; ++i) {
        const Vector3d g = tool.sample(X_TV * positionOf(i)).gradient;
        const double in_direction = g.dot(stiffness * g);
        if (in_direction > config_.stiffness_cap)
            candidates_.weight[i] *= float(config_.stiffness_cap / in_direction);
    }
}

}  // namespace bonemill
