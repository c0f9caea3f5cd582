// Node meshes of several grids as one surface: is it closed, and do their normals agree where they meet?
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill::test {

inline Eigen::Vector3d vertexPlace(const NodeMesh& mesh, size_t vertex) {  // V, m
    const PackedVertex& v = mesh.vertices[vertex];
    return mesh.origin.cast<double>() + mesh.step.cast<double>().cwiseProduct(Eigen::Vector3d(v.x, v.y, v.z));
}

inline Eigen::Vector3d vertexNormal(const NodeMesh& mesh, size_t vertex) {
    const PackedVertex& v = mesh.vertices[vertex];
    return decodeNormal(v.octahedral_u, v.octahedral_v).cast<double>();
}

inline double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 / std::numbers::pi;
}

// Vertices less than kSame apart are one: a mesh has its origin as float.
class JoinedSurface {
  public:
    static constexpr double kSame = 50e-9;  // m

    explicit JoinedSurface(std::span<const NodeMesh> meshes) {
        for (const NodeMesh& mesh : meshes) {
            std::vector<size_t> numbers;
            for (size_t n = 0; n < mesh.vertices.size(); ++n) numbers.push_back(add(mesh, n));
            for (size_t i = 0; i < mesh.indices.size(); ++i) {
                const size_t from = numbers[mesh.indices[i]],
                             to = numbers[mesh.indices[i - i % 3 + (i + 1) % 3]];
                if (from != to) uses_[std::minmax(from, to)] += from < to ? 1 : -1;
            }
        }
    }

    // Edges that are not used as often one way as the other.
    size_t openEdges() const {
        return size_t(std::ranges::count_if(uses_, [](const auto& use) { return use.second != 0; }));
    }
    // The ends of the open edges; V, m.
    std::vector<Eigen::Vector3d> openPlaces() const {
        std::vector<Eigen::Vector3d> places;
        for (const auto& [edge, balance] : uses_)
            if (balance != 0)
                for (const size_t end : {edge.first, edge.second}) places.push_back(places_[end]);
        return places;
    }
    double largestJump() const noexcept { return largest_jump_; }  // of normals at one vertex, degrees
    size_t shared() const noexcept { return shared_; }             // vertices of several meshes

  private:
    using Cell = std::array<int64_t, 3>;

    size_t add(const NodeMesh& mesh, size_t vertex) {
        const Eigen::Vector3d p = vertexPlace(mesh, vertex), in_cells = p / kCell;
        for (int near = 0; near < 8; ++near) {
            Cell cell;
            for (int axis = 0; axis < 3; ++axis)
                cell[size_t(axis)] =
                    int64_t(std::floor(in_cells[axis] + ((near >> axis & 1) ? kSame : -kSame) / kCell));
            const auto found = cells_.find(cell);
            if (found == cells_.end()) continue;
            for (const size_t number : found->second)
                if ((places_[number] - p).norm() < kSame) {
                    largest_jump_ =
                        std::max(largest_jump_, degreesBetween(normals_[number], vertexNormal(mesh, vertex)));
                    ++shared_;
                    return number;
                }
        }
        Cell own;
        for (int axis = 0; axis < 3; ++axis) own[size_t(axis)] = int64_t(std::floor(in_cells[axis]));
        cells_[own].push_back(places_.size());
        places_.push_back(p);
        normals_.push_back(vertexNormal(mesh, vertex));
        return places_.size() - 1;
    }

    static constexpr double kCell = 4e-6;  // m
    std::map<Cell, std::vector<size_t>> cells_;
    std::vector<Eigen::Vector3d> places_, normals_;
    std::map<std::pair<size_t, size_t>, int> uses_;
    double largest_jump_ = 0;
    size_t shared_ = 0;
};

}  // namespace bonemill::test
