// The contact loop sees the tool as signed distances at the nodes of a regular grid, interpolated
// between them.
//
// The frame is T (docs/reference/frames.md), with its origin at the burr centre and +y along the shaft
// towards the hand. The unit is m; distances are negative inside. Node (i, j, k) lies at origin + spacing·(i,
// j, k). Outside of the grid there is no tool and hence no contact. Queries are const, noexcept and RT-safe,
// for any thread; a NaN point counts as outside. The thesis ("Haptic Milling Simulation in Six
// Degrees-of-Freedom", KTH 2012) has a grid of 22×128×22 nodes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

class SdfGrid {
  public:
    // A query outside of the grid returns this, which is farther than any contact distance (m).
    static constexpr float kOutsideDistance = 1e9f;

    // `values` has one distance per node, x fastest. Throws std::invalid_argument unless there are at least 2
    // nodes per axis, one finite value for each, a positive spacing and a finite origin. It allocates, so it
    // is not RT-safe.
    SdfGrid(const Eigen::Vector3i& nodes, double spacing, const Eigen::Vector3d& origin_T,
            std::vector<float> values);

    const Eigen::Vector3i& nodes() const noexcept { return nodes_; }
    double spacing() const noexcept { return spacing_; }
    const Eigen::Vector3d& origin() const noexcept { return origin_T_; }
    const std::vector<float>& values() const noexcept { return values_; }
    float at(int i, int j, int k) const noexcept { return values_[offset(i, j, k)]; }
    Eigen::Vector3d nodePosition(int i, int j, int k) const noexcept {
        return origin_T_ + spacing_ * Eigen::Vector3d(i, j, k);
    }

    // The box reaches from the first node to the last.
    const Eigen::AlignedBox3d& gridBox() const noexcept { return grid_box_; }
    // distance() is nowhere negative outside of this box: the nodes inside the tool, grown by one spacing and
    // cut at the grid's end. It is empty if no node is inside.
    const Eigen::AlignedBox3d& box() const noexcept { return box_; }

    bool contains(const Eigen::Vector3d& p_T) const noexcept;

    // The distance is trilinear, and kOutsideDistance outside of the grid.
    float distance(const Eigen::Vector3d& p_T) const noexcept;

    // This is the same without rounding; p_T is inside of the grid.
    double distanceExactly(const Eigen::Vector3d& p_T) const noexcept;

    // Returns the exact gradient of distance(), one-sided (from the higher cell) on a cell's face; it is zero
    // outside of the grid.
    Eigen::Vector3d gradient(const Eigen::Vector3d& p_T) const noexcept;

    // This is the contact loop's distance(), in single precision throughout.
    float distanceAt(const Eigen::Vector3f& p_T) const noexcept {
        Eigen::Vector3f unused;
        return sampleAt(p_T, unused);
    }

    // It is the same with its gradient, which is left alone outside of the grid.
    float sampleAt(const Eigen::Vector3f& p_T, Eigen::Vector3f& gradient) const noexcept {
        const Eigen::Array3f u = (p_T - origin_f_).array() * inverse_spacing_f_;
        if (!((u >= 0.0f).all() && (u <= last_f_).all())) return kOutsideDistance;  // this way round for NaN
        const int i = std::min(int(u.x()), last_cell_.x());
        const int j = std::min(int(u.y()), last_cell_.y());
        const int k = std::min(int(u.z()), last_cell_.z());
        const float fx = u.x() - float(i), fy = u.y() - float(j), fz = u.z() - float(k);
        const float* v = values_.data() + offset(i, j, k);
        const float *v10 = v + stride_y_, *v01 = v + stride_z_, *v11 = v + stride_z_ + stride_y_;
        const float d00 = v[1] - v[0], d10 = v10[1] - v10[0], d01 = v01[1] - v01[0], d11 = v11[1] - v11[0];
        const float a00 = v[0] + fx * d00, a10 = v10[0] + fx * d10, a01 = v01[0] + fx * d01,
                    a11 = v11[0] + fx * d11;
        const float b0 = a00 + fy * (a10 - a00), b1 = a01 + fy * (a11 - a01);
        const float dx0 = d00 + fy * (d10 - d00), dx1 = d01 + fy * (d11 - d01);
        gradient =
            inverse_spacing_f_ *
            Eigen::Vector3f(dx0 + fz * (dx1 - dx0), (a10 - a00) + fz * ((a11 - a01) - (a10 - a00)), b1 - b0);
        return b0 + fz * (b1 - b0);
    }

  private:
    struct Cell {
        const float* corner;       // value at the cell's lowest node
        Eigen::Vector3d fraction;  // 0..1 inside the cell
    };
    Cell cellOf(const Eigen::Vector3d& p_T) const noexcept;  // p_T inside the grid

    size_t offset(int i, int j, int k) const noexcept {
        return size_t(i) + stride_y_ * size_t(j) + stride_z_ * size_t(k);
    }

    Eigen::Vector3i nodes_;
    double spacing_;
    Eigen::Vector3d origin_T_;
    std::vector<float> values_;
    size_t stride_y_;
    size_t stride_z_;
    Eigen::AlignedBox3d grid_box_;
    Eigen::AlignedBox3d box_;
    Eigen::Vector3i last_cell_;
    Eigen::Vector3f origin_f_;
    float inverse_spacing_f_;
    Eigen::Array3f last_f_;
};

}  // namespace bonemill
