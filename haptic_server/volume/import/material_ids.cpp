#include "haptic_server/volume/import/material_ids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/user_error.h"

namespace bonemill {
namespace {

constexpr double kMostShift = 0.25;    // voxels, anywhere: headers round
constexpr double kMostStretch = 0.05;  // per voxel: more is another size

std::string sizeText(const Eigen::Vector3i& dims) {
    return std::to_string(dims.x()) + " x " + std::to_string(dims.y()) + " x " + std::to_string(dims.z());
}

// Gives the index of the label of voxel (i, j, k) among all: first + stride · (i, j, k).
struct LabelOrder {
    ptrdiff_t first = 0;
    std::array<ptrdiff_t, 3> stride{};
};

[[noreturn]] void refuse(const std::string& label_file, const std::string& what) {
    throw UserError(label_file + " " + what + ": both must lie on the same grid");
}

// Lays the voxels' axes each along one of the labels', there or back.
Eigen::Matrix3i axesBetween(const Eigen::Matrix3d& voxel_to_label, const std::string& label_file) {
    const Eigen::Matrix3i axes = voxel_to_label.array().round().cast<int>();
    const bool are_parallel = (axes.cwiseAbs().rowwise().sum().array() == 1).all() &&
                              (axes.cwiseAbs().colwise().sum().array() == 1).all() &&
                              (voxel_to_label - axes.cast<double>()).cwiseAbs().maxCoeff() < kMostStretch;
    if (!are_parallel) refuse(label_file, "has voxels of another size or direction than the volume");
    return axes;
}

LabelOrder orderOf(const VolumeGeometry& volume, const VolumeGeometry& labels,
                   const std::string& label_file) {
    const std::string sizes = "has " + sizeText(labels.dims) + " voxels, the volume " + sizeText(volume.dims);
    if (labels.voxelCount() != volume.voxelCount()) refuse(label_file, sizes);
    const Pose X_LV = labels.X_WV.inverse() * volume.X_WV;
    const Eigen::Matrix3d voxel_to_label = labels.spacing.cwiseInverse().asDiagonal() *
                                           X_LV.rotation.toRotationMatrix() * volume.spacing.asDiagonal();
    const Eigen::Matrix3i axes = axesBetween(voxel_to_label, label_file);
    if (axes.cwiseAbs() * volume.dims != labels.dims) refuse(label_file, sizes);
    const Eigen::Vector3i last = volume.dims.array() - 1;
    // A reversed axis begins at its end.
    const Eigen::Vector3i start = (axes * last).cwiseMin(0).cwiseAbs();
    double shift = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i at(corner & 1 ? last.x() : 0, corner & 2 ? last.y() : 0,
                                 corner & 4 ? last.z() : 0);
        const Eigen::Vector3d label =
            voxel_to_label * at.cast<double>() + labels.spacing.cwiseInverse().cwiseProduct(X_LV.position);
        shift = std::max(shift, (label - (start + axes * at).cast<double>()).cwiseAbs().maxCoeff());
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", shift);
    if (shift > kMostShift)
        refuse(label_file, std::string("lies up to ") + text + " voxels beside the volume");
    const Eigen::Matrix<ptrdiff_t, 3, 1> step(1, labels.dims.x(),
                                              ptrdiff_t(labels.dims.x()) * labels.dims.y());
    LabelOrder order;
    order.first = step.dot(start.cast<ptrdiff_t>());
    for (int axis = 0; axis < 3; ++axis)
        order.stride[size_t(axis)] = step.dot(axes.col(axis).cast<ptrdiff_t>());
    return order;
}

bool isInRange(const MaterialRule& rule, double value) {
    return rule.has_range && std::isfinite(value) && (!rule.from || value >= *rule.from) &&
           (!rule.below || value < *rule.below);
}

std::vector<MaterialId> idsByValue(const RawVolume& raw, std::span<const MaterialRule> rules) {
    std::vector<MaterialId> ids(raw.values.size(), kNoMaterial);
    const bool has_ranges =
        std::any_of(rules.begin(), rules.end(), [](const MaterialRule& rule) { return rule.has_range; });
    if (!has_ranges) return ids;
    raw.values.visit([&](auto samples) {
        for (size_t n = 0; n < samples.size(); ++n)
            for (size_t rule = rules.size(); rule > 0 && ids[n] == kNoMaterial; --rule)
                if (isInRange(rules[rule - 1], double(samples[n]))) ids[n] = MaterialId(rule);
    });
    return ids;
}

std::vector<MaterialId> idOfLabel(std::span<const MaterialRule> rules) {
    std::vector<MaterialId> ids(kMostLabel + 1, kNoMaterial);
    for (size_t n = 0; n < rules.size(); ++n)
        for (const uint32_t label : rules[n].labels) ids[label] = MaterialId(n + 1);
    return ids;
}

}  // namespace

std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    const RawVolume* labels, const std::string& label_file) {
    std::vector<MaterialId> ids = idsByValue(raw, rules);
    if (!labels) return ids;
    const LabelOrder order = orderOf(raw.geometry, labels->geometry, label_file);
    if (const ValueRange& range = labels->values.range(); !range.are_integers || range.non_finite > 0)
        throw UserError(label_file +
                        " holds values that are no whole numbers: labels are needed, not a scan");
    const std::vector<MaterialId> of_label = idOfLabel(rules);
    const Eigen::Vector3i& dims = raw.geometry.dims;
    labels->values.visit([&](auto samples) {
        MaterialId* id = ids.data();
        for (int k = 0; k < dims.z(); ++k)
            for (int j = 0; j < dims.y(); ++j) {
                ptrdiff_t at = order.first + j * order.stride[1] + k * order.stride[2];
                for (int i = 0; i < dims.x(); ++i, ++id, at += order.stride[0]) {
                    const double label = double(samples[size_t(at)]);
                    if (label < 0 || label > kMostLabel) continue;
                    *id = std::max(*id, of_label[size_t(label)]);  // the later one wins
                }
            }
    });
    return ids;
}

}  // namespace bonemill
