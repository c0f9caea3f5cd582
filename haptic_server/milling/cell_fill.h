// How much of a cell is bone. RT-safe.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptic_server/contact/cell_corners.h"

namespace bonemill {

// Share of a unit cube where level + slope·(t - ½) >= 0, t in 0 .. 1 along each axis: a plane cuts the cube
// (Scardovelli and Zaleski 2000, J. Comput. Phys. 164, eq 3).
inline double planeFill(double level, const Eigen::Vector3d& slope) noexcept {
    constexpr double kLeastShare = 1e-6;  // of the slope along an axis; keeps the quotients small
    const double size = slope.cwiseAbs().sum();
    if (size <= 0) return level >= 0 ? 1 : 0;
    const double depth = level / size + 0.5;  // 0: nothing, 1: all
    if (depth <= 0) return 0;
    if (depth >= 1) return 1;
    Eigen::Array3d m = (slope.array().abs() / size).max(kLeastShare);
    m /= m.sum();
    if (m[0] > m[1]) std::swap(m[0], m[1]);
    if (m[1] > m[2]) std::swap(m[1], m[2]);
    if (m[0] > m[1]) std::swap(m[0], m[1]);
    const double a = std::min(depth, 1 - depth);
    const auto cut = [&](int i) { return m[i] * m[i] * (m[i] - 3 * a); };
    const double six = 6 * m[0] * m[1] * m[2], both = m[0] + m[1];
    double fill = 0;
    if (a < m[0])
        fill = a * a * a / six;
    else if (a < m[1])
        fill = a * (a - m[0]) / (2 * m[1] * m[2]) + m[0] * m[0] / (6 * m[1] * m[2]);
    else if (a < std::min(both, m[2]))
        fill = (a * a * (3 * both - a) + cut(0) + cut(1)) / six;
    else if (m[2] < both)
        fill = (a * a * (3 - 2 * a) + cut(0) + cut(1) + cut(2)) / six;
    else
        fill = (2 * a - both) / (2 * m[2]);
    return depth > 0.5 ? 1 - fill : fill;
}

// With the corners' mean density and mean slope.
inline double cellFill(const CellCorners& corners) noexcept {
    bool has_bone = false, has_air = false;
    for (const float e : corners.excess) (e >= 0 ? has_bone : has_air) = true;
    if (!has_air) return 1;
    if (!has_bone) return 0;
    const FieldSample middle = sampleField(corners, Eigen::Vector3f::Constant(0.5f));
    return planeFill(double(middle.excess), middle.slope.cast<double>());
}

}  // namespace bonemill
