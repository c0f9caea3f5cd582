#include "haptic_server/core/tool/sdf_grid.h"

#include <cmath>
#include <stdexcept>

namespace bonemill {
namespace {

void check(const Eigen::Vector3i& nodes, double spacing, const Eigen::Vector3d& origin,
           const std::vector<float>& values) {
    if ((nodes.array() < 2).any()) throw std::invalid_argument("SdfGrid: fewer than 2 nodes on an axis");
    if (values.size() != size_t(nodes.x()) * size_t(nodes.y()) * size_t(nodes.z()))
        throw std::invalid_argument("SdfGrid: not one value per node");
    if (!(spacing > 0) || !std::isfinite(spacing) || !origin.allFinite())
        throw std::invalid_argument("SdfGrid: spacing or origin is not usable");
    if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
        throw std::invalid_argument("SdfGrid: a distance is not finite");
}

}  // namespace

SdfGrid::SdfGrid(const Eigen::Vector3i& nodes, double spacing, const Eigen::Vector3d& origin_T,
                 std::vector<float> values)
    : nodes_(nodes),
      spacing_(spacing),
      origin_T_(origin_T),
      values_(std::move(values)),
      stride_y_(size_t(nodes.x())),
      stride_z_(size_t(nodes.x()) * size_t(nodes.y())),
      last_cell_(nodes.array() - 2),
      origin_f_(origin_T.cast<float>()),
      inverse_spacing_f_(float(1.0 / spacing)),
      last_f_((nodes.array() - 1).cast<float>()) {
    check(nodes, spacing, origin_T, values_);
    grid_box_ = {origin_T_, nodePosition(nodes.x() - 1, nodes.y() - 1, nodes.z() - 1)};
    for (int k = 0; k < nodes.z(); ++k)
        for (int j = 0; j < nodes.y(); ++j)
            for (int i = 0; i < nodes.x(); ++i)
                if (at(i, j, k) < 0) box_.extend(nodePosition(i, j, k));
    if (box_.isEmpty()) return;
    // A trilinear value is negative only if a corner of its cell is.
    box_.min().array() -= spacing_;
    box_.max().array() += spacing_;
    box_ = box_.intersection(grid_box_);
}

bool SdfGrid::contains(const Eigen::Vector3d& p_T) const noexcept {
    return (p_T.array() >= grid_box_.min().array()).all() && (p_T.array() <= grid_box_.max().array()).all();
}

SdfGrid::Cell SdfGrid::cellOf(const Eigen::Vector3d& p_T) const noexcept {
    const Eigen::Vector3d u = (p_T - origin_T_) / spacing_;
    const Eigen::Vector3i cell = u.cast<int>().cwiseMin(last_cell_);
    return {values_.data() + offset(cell.x(), cell.y(), cell.z()), u - cell.cast<double>()};
}

float SdfGrid::distance(const Eigen::Vector3d& p_T) const noexcept {
    return contains(p_T) ? float(distanceExactly(p_T)) : kOutsideDistance;
}

double SdfGrid::distanceExactly(const Eigen::Vector3d& p_T) const noexcept {
    const auto [v, f] = cellOf(p_T);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2 & 1;
        sum += (x ? f.x() : 1 - f.x()) * (y ? f.y() : 1 - f.y()) * (z ? f.z() : 1 - f.z()) *
               double(v[size_t(x) + stride_y_ * size_t(y) + stride_z_ * size_t(z)]);
    }
    return sum;
}

Eigen::Vector3d SdfGrid::gradient(const Eigen::Vector3d& p_T) const noexcept {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (!contains(p_T)) return sum;
    const auto [v, f] = cellOf(p_T);
    for (int corner = 0; corner < 8; ++corner) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2 & 1;
        const double wx = x ? f.x() : 1 - f.x(), wy = y ? f.y() : 1 - f.y(), wz = z ? f.z() : 1 - f.z();
        const double value = double(v[size_t(x) + stride_y_ * size_t(y) + stride_z_ * size_t(z)]);
        sum +=
            value * Eigen::Vector3d((x ? 1 : -1) * wy * wz, wx * (y ? 1 : -1) * wz, wx * wy * (z ? 1 : -1));
    }
    return sum / spacing_;
}

}  // namespace bonemill
