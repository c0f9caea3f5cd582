// These are the contact points near the tool that one solve works on, as structure of arrays, and what
// effects see and change of them. They are RT-safe but for construction.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "haptic_server/core/contact/shell_pool.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

struct Candidates {
    // V axes, from an origin near the tool: small numbers keep their digits.
    std::vector<float> x, y, z;
    std::vector<float> nx, ny, nz;  // V, unit or zero
    std::vector<float> weight;      // κ a λ, of one place
    std::vector<float> area;        // m², of the whole patch
    std::vector<float> nearest;     // m: no place of the patch was nearer to the tool at the gathering
    std::vector<PatchId> patch;
    size_t most;  // at most this many, though there may be room for more
    size_t count = 0;

    explicit Candidates(size_t room) : patch(room), most(room) {
        for (std::vector<float>* values : {&x, &y, &z, &nx, &ny, &nz, &weight, &area, &nearest})
            values->resize(room + kCellLanes);  // the kernels go on to a multiple of that
    }

    size_t capacity() const noexcept { return most; }

    // Adds these points of a block with weight κ a, as many as there is room for. False says that not
    // all were added.
    bool add(const ShellBlock& block, const int* points, int point_count, LeafId leaf,
             const Eigen::Vector3d& origin, float stiffness_per_area, const float* nearest_place) noexcept {
        const int n = int(std::min(size_t(point_count), capacity() - count));
        const auto put = [&](std::vector<float>& to, auto&& value) {
            float* out = to.data() + count;
            for (int i = 0; i < n; ++i) out[i] = value(points[i]);
        };
        put(x, [&](int i) { return float(double(block.x[i]) - origin.x()); });
        put(y, [&](int i) { return float(double(block.y[i]) - origin.y()); });
        put(z, [&](int i) { return float(double(block.z[i]) - origin.z()); });
        put(nx, [&](int i) { return block.nx[i]; });
        put(ny, [&](int i) { return block.ny[i]; });
        put(nz, [&](int i) { return block.nz[i]; });
        put(area, [&](int i) { return block.area[i]; });
        put(weight, [&](int i) { return stiffness_per_area * block.area[i]; });
        put(nearest, [&](int i) { return nearest_place[i]; });
        for (int i = 0; i < n; ++i) patch[count + size_t(i)] = {leaf, block.key[points[i]]};
        count += size_t(n);
        return n == point_count;
    }
    // Appends those of `from` that `which` lists, for which there must be room.
    void append(const Candidates& from, const uint32_t* which, size_t n) noexcept {
        copy(from.x, which, n, x), copy(from.y, which, n, y), copy(from.z, which, n, z);
        copy(from.nearest, which, n, nearest);
        appendPatches(from, which, n);
    }
    // The same without places and how near they are: those are there already.
    void appendPatches(const Candidates& from, const uint32_t* which, size_t n) noexcept {
        copy(from.nx, which, n, nx), copy(from.ny, which, n, ny), copy(from.nz, which, n, nz);
        copy(from.weight, which, n, weight), copy(from.area, which, n, area);
        copy(from.patch, which, n, patch);
        count += n;
    }
    Eigen::Vector3f position(size_t n) const noexcept { return {x[n], y[n], z[n]}; }
    Eigen::Vector3f normal(size_t n) const noexcept { return {nx[n], ny[n], nz[n]}; }

  private:
    template <class Values>
    void copy(const Values& from, const uint32_t* which, size_t n, Values& to) noexcept {
        for (size_t i = 0; i < n; ++i) to[count + i] = from[which[i]];
    }
};

// Lets an effect scale the energy of single contact points: softer where a burr cuts, harder in enamel.
class ContactWeights {
  public:
    virtual ~ContactWeights() = default;
    // Multiplies weights of the candidates just gathered, before the far-side guard and the stiffness cap see
    // them. `origin` is that of the candidates' positions, X_VT the tool's pose at the gathering. Returns the
    // largest factor. It is called once or more often in a tick, for each gathering anew. It is RT-safe, for
    // the tick thread only.
    virtual double scale(Candidates& candidates, const Eigen::Vector3d& origin_V, const ToolField& tool,
                         const Pose& X_VT) noexcept = 0;
};

// It is one contact point as effects see it after the solve.
struct SurfaceContact {
    Eigen::Vector3f r_V;     // from the tool point to the contact, V axes, m
    Eigen::Vector3f push_V;  // unit: where the bone pushes the tool
    float depth;             // m, > 0
    float force;             // N along push_V
    uint32_t candidate;      // its place among the candidates of the last gathering
};

}  // namespace bonemill
