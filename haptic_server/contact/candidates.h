// The contact points near the tool that one solve works on, as structure of arrays. RT-safe but for
// construction.
#pragma once

#include <cstdint>
#include <vector>

#include "haptic_server/contact/shell_pool.h"
#include "haptic_server/kernels/kernels.h"
#include "haptic_server/volume/leaf_lattice.h"

namespace bonemill {

struct Candidates {
    // V axes, from an origin near the tool: small numbers keep their digits.
    std::vector<float> x, y, z;
    std::vector<float> nx, ny, nz;  // V, unit or zero
    std::vector<float> weight;      // κ a λ, of one place
    std::vector<float> area;        // m², of the whole patch
    std::vector<float> nearest;     // m: no place of the patch was nearer to the tool at the gathering
    std::vector<uint64_t> patch;    // leaf and key in the shell
    size_t count = 0;

    explicit Candidates(size_t most) : patch(most) {
        for (std::vector<float>* values : {&x, &y, &z, &nx, &ny, &nz, &weight, &area, &nearest})
            values->resize(most + kCellLanes);  // the kernels go on to a multiple of that
    }

    size_t capacity() const noexcept { return patch.size(); }
    bool isFull() const noexcept { return count == capacity(); }

    // Not when full.
    void add(const ShellBlock& block, int i, LeafId leaf, const Eigen::Vector3f& position, float point_weight,
             float nearest_place) noexcept {
        const size_t n = count++;
        x[n] = position.x(), y[n] = position.y(), z[n] = position.z();
        nx[n] = block.nx[i], ny[n] = block.ny[i], nz[n] = block.nz[i];
        weight[n] = point_weight, area[n] = block.area[i], nearest[n] = nearest_place;
        patch[n] = uint64_t(leaf) << 32 | block.key[i];
    }
    void copy(size_t from, size_t to) noexcept {
        x[to] = x[from], y[to] = y[from], z[to] = z[from];
        nx[to] = nx[from], ny[to] = ny[from], nz[to] = nz[from];
        weight[to] = weight[from], area[to] = area[from], nearest[to] = nearest[from];
        patch[to] = patch[from];
    }
    Eigen::Vector3f position(size_t n) const noexcept { return {x[n], y[n], z[n]}; }
    Eigen::Vector3f normal(size_t n) const noexcept { return {nx[n], ny[n], nz[n]}; }
};

}  // namespace bonemill
