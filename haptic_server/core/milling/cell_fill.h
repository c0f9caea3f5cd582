// Says how much of a cell is bone: the volume behind the surface that is drawn (marching cubes). It is
// RT-safe, for any thread, but for the first construction, which makes the tables.
//
// By the divergence theorem with the field (0, 0, z) it is ∫ z n_z over the cell's triangles, plus the bone's
// part of the face z = 1. What is bone on a face only depends on the face, as for the triangles: the cells'
// volumes add up to that of the closed surface.
#pragma once

#include <array>

#include "haptic_server/core/contact/cell_corners.h"
#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {

class CellFill {
  public:
    CellFill() : triangles_(cubeTriangles()) {}

    // This share of the cell is bone, 0 .. 1.
    double operator()(const CellCorners& corners) const noexcept {
        unsigned inside = 0;
        for (unsigned c = 0; c < 8; ++c) inside |= unsigned(corners.excess[c] >= 0) << c;
        if (inside == 0) return 0;
        if (inside == 0xff) return 1;
        double fill = topFace(corners, inside >> 4);
        const CubeTriangles& cell = triangles_[inside];
        std::array<Eigen::Vector3d, 12> on_edge;  // of those that the surface crosses
        unsigned known = 0;
        const auto at = [&](unsigned edge) -> const Eigen::Vector3d& {
            if (!(known >> edge & 1)) on_edge[edge] = crossing(corners, int(edge));
            known |= 1u << edge;
            return on_edge[edge];
        };
        for (size_t n = 0; n < cell.count; ++n) {
            const Eigen::Vector3d& a = at(cell.edges[n][0]);
            const Eigen::Vector3d& b = at(cell.edges[n][1]);
            const Eigen::Vector3d& c = at(cell.edges[n][2]);
            const double area_z = ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x())) / 2;
            fill += (a.z() + b.z() + c.z()) / 3 * area_z;
        }
        return fill;
    }

  private:
    // The surface lies at this share of the way from one density to the other, of which one is inside.
    static double share(double from, double to) noexcept { return from / (from - to); }
    static Eigen::Vector3d crossing(const CellCorners& corners, int edge) noexcept {
        const unsigned low = kCubeEdges[size_t(edge)].low_corner, axis = kCubeEdges[size_t(edge)].axis;
        Eigen::Vector3d place(low & 1, low >> 1 & 1, low >> 2 & 1);
        place[axis] = share(double(corners.excess[low]), double(corners.excess[low | 1u << axis]));
        return place;
    }
    // So much of the face z = 1 is bone; each inside corner, or run of such, is cut off by itself.
    static double topFace(const CellCorners& corners, unsigned inside) noexcept {
        constexpr unsigned kAround[4] = {0, 1, 3, 2};
        if (inside == 0xf) return 1;
        double area = 0;
        for (unsigned n = 0; n < 4; ++n) {
            const auto corner = [&](unsigned step) { return kAround[(n + step) & 3]; };
            const auto is_in = [&](unsigned step) { return (inside >> corner(step) & 1) != 0; };
            const auto e = [&](unsigned step) { return double(corners.excess[4 + corner(step)]); };
            if (!is_in(0)) continue;
            if (!is_in(3) && !is_in(1))  // a corner by itself
                area += share(e(0), e(3)) * share(e(0), e(1)) / 2;
            else if (!is_in(3) && !is_in(2))  // the first of two
                area += (share(e(0), e(3)) + share(e(1), e(2))) / 2;
            else if (is_in(3) && is_in(1))  // the middle one of three
                area += 1 - share(e(2), e(1)) * share(e(2), e(3)) / 2;
        }
        return area;
    }

    const std::array<CubeTriangles, 256>& triangles_;
};

}  // namespace bonemill
