#include "haptic_server/lab/accuracy_report/touch.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

constexpr double kStep = 50e-6;            // m: thinner than any wall that a scan shows
constexpr double kTolerance = 1e-6;        // m
constexpr AccuracySettings kExactField{};  // analytic if the tool has shapes

}  // namespace

TouchProbe::TouchProbe(const BoneModel& bone, const ToolModel& tool)
    : bone_(bone),
      field_(tool.field(kExactField)),
      X_VW_(bone.volume.geometry().X_WV.inverse()),
      level_(levelOf(bone.shell, kExactField)),
      contact_(GradientContactConfig{}) {}

GradientContactResult TouchProbe::contactAt(const Pose& X_WT) {
    const Pose X_VT = X_VW_ * X_WT;
    contact_.gather({bone_.volume, bone_.lattice, bone_.shell, level_, 1, 0}, field_, X_VT, kTolerance);
    return contact_.evaluate<double>(field_, X_VT);
}

bool TouchProbe::isInBone(const Eigen::Vector3d& p_W) const {
    const VoxelVolume& volume = bone_.volume;
    const Eigen::Array3d index = ((X_VW_ * p_W).array() / volume.spacing().array()).round();
    if ((index < 0).any() || (index >= volume.dims().cast<double>().array()).any()) return false;
    const Eigen::Array3i voxel = index.cast<int>();
    return volume.at(voxel.x(), voxel.y(), voxel.z()) >= volume.iso();
}

bool TouchProbe::touches(const Pose& X_WT) {
    return contactAt(X_WT).contacts > 0 || isInBone(X_WT.position);
}

Eigen::Vector3d TouchProbe::pushOn(const Pose& X_WT) {
    const Eigen::Vector3d force = X_VW_.rotation.conjugate() * contactAt(X_WT).term.wrench.force;
    return force.norm() > 0 ? Eigen::Vector3d(force.normalized()) : Eigen::Vector3d::Zero();
}

double TouchProbe::armOf(const Pose& X_WT) {
    const Wrench push = contactAt(X_WT).term.wrench;
    return push.force.norm() > 0 ? push.torque.norm() / push.force.norm() : 0;
}

std::optional<double> TouchProbe::freeWay(const PoseAt& pose_at, double longest) {
    if (touches(pose_at(0))) return std::nullopt;
    for (double free = 0; free < longest;) {
        const double next = std::min(longest, free + kStep);
        if (!touches(pose_at(next))) {
            free = next;
            continue;
        }
        for (double touching = next; touching - free > kTolerance;) {
            const double middle = (free + touching) / 2;
            (touches(pose_at(middle)) ? touching : free) = middle;
        }
        return free;
    }
    return std::nullopt;
}

std::optional<double> TouchProbe::freeWay(const Pose& X_WT, const Eigen::Vector3d& direction,
                                          double longest) {
    return freeWay([&](double way) { return Pose{X_WT.position + way * direction, X_WT.rotation}; }, longest);
}

Eigen::AlignedBox3d TouchProbe::surfaceNear(std::span<const Pose> path, double distance) const {
    Eigen::AlignedBox3d near;
    for (const Pose& X_WT : path) {
        const Pose X_TV = (X_VW_ * X_WT).inverse();
        Eigen::AlignedBox3d box = boxInV(field_.box(), X_VW_ * X_WT);
        box.min().array() -= distance;
        box.max().array() += distance;
        bone_.lattice.forEachSurfaceLeaf(box, bone_.volume.spacing(), bone_.volume.iso(), [&](LeafId leaf) {
            bone_.shell.forEachBlock(level_, leaf, [&](const ShellBlock& block, uint32_t count) {
                for (uint32_t i = 0; i < count; ++i) {
                    const Eigen::Vector3d p_V(block.x[i], block.y[i], block.z[i]);
                    if (!near.contains(p_V) && field_.distanceBound(X_TV * p_V) <= distance) near.extend(p_V);
                }
            });
        });
    }
    return near;
}

}  // namespace bonemill
