// A scan of random densities that lies turned in W, in voxels that are no cubes and bricks that do not fill
// it.
#pragma once

#include <random>

#include "render_client/link/density_store/density_store.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill::test {

struct SlicedVolume {
    DensityGrid grid{{37, 29, 23}, {4e-4, 5e-4, 7e-4}, {1e-3, -2e-3, 5e-4}, 8, -1000, 3000, 500};
    std::vector<uint16_t> scanned, present;
    std::vector<uint8_t> materials;

    SlicedVolume() {
        std::mt19937 random(3);
        for (int n = 0; n < grid.voxels.prod(); ++n) {
            scanned.push_back(uint16_t(random()));
            present.push_back(random() % 3 == 0 ? uint16_t(random()) : scanned.back());
            materials.push_back(uint8_t(scanned.back() % 3));
        }
    }
    size_t indexOf(const Eigen::Vector3i& v) const {
        return size_t(v.x() + grid.voxels.x() * (v.y() + grid.voxels.y() * v.z()));
    }
    DensityBrick brick(uint32_t number) const {
        DensityBrick brick;
        const Eigen::Vector3i first = firstVoxelOf(grid, number);
        for (int k = 0; k < grid.brick_edge; ++k)
            for (int j = 0; j < grid.brick_edge; ++j)
                for (int i = 0; i < grid.brick_edge; ++i) {
                    const Eigen::Vector3i v = first + Eigen::Vector3i(i, j, k);
                    const bool is_inside = (v.array() < grid.voxels.array()).all();
                    brick.scanned.push_back(is_inside ? scanned[indexOf(v)] : 0);
                    brick.present.push_back(is_inside ? present[indexOf(v)] : 0);
                    brick.materials.push_back(is_inside ? materials[indexOf(v)] : uint8_t(0));
                }
        return brick;
    }
    void putAll(DensityStore& store) const {
        store.setGrid(grid);
        for (uint32_t b = 0; b < uint32_t(brickCount(grid)); ++b) store.put(b, brick(b));
    }
    // Returns the trilinear density there (V), clamped to the outermost voxels.
    double at(const std::vector<uint16_t>& densities, const Eigen::Vector3d& p_V) const {
        double sum = 0;
        forEachCorner(p_V, [&](size_t voxel, double weight) { sum += weight * densities[voxel]; });
        return sum;
    }
    // visit(voxel, weight) for the eight around that place (V), clamped to the outermost ones.
    template <class Visit>
    void forEachCorner(const Eigen::Vector3d& p_V, Visit&& visit) const {
        const Eigen::Vector3d last = (grid.voxels - Eigen::Vector3i::Ones()).cast<double>();
        const Eigen::Vector3d v =
            (p_V - grid.origin_m).cwiseQuotient(grid.spacing_m).cwiseMax(0).cwiseMin(last);
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1;
            Eigen::Vector3i voxel;
            for (int axis = 0; axis < 3; ++axis) {
                const bool is_high = corner >> axis & 1;
                const double low = std::floor(v[axis]), fraction = v[axis] - low;
                voxel[axis] = std::min(int(low) + is_high, grid.voxels[axis] - 1);
                weight *= is_high ? fraction : 1 - fraction;
            }
            visit(indexOf(voxel), weight);
        }
    }
};

inline Pose turned(const Eigen::Vector3d& rotation) {
    Pose X_WV;
    X_WV.position = {0.02, -0.01, 0.03};
    X_WV.rotation = expRotation(rotation);
    return X_WV;
}

}  // namespace bonemill::test
