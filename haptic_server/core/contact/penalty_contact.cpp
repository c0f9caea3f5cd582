#include "haptic_server/core/contact/penalty_contact.h"

#include <algorithm>

#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

// These are sums over the colliding points at unit stiffness; the stiffness of all points depends
// on their number.
struct UnitSums {
    Vector6d depth_direction = Vector6d::Zero();          // Σ d [n; r × n]
    Matrix6d outer = Matrix6d::Zero();                    // Σ J Jᵀ, J = [n; r × n]
    Eigen::Matrix3d depth_n_r = Eigen::Matrix3d::Zero();  // Σ d n rᵀ
    uint32_t contacts = 0;
    float max_depth = 0;

    void add(float depth, const Eigen::Vector3d& r, const Eigen::Vector3d& n) noexcept {
        Vector6d J;
        J << n, r.cross(n);
        depth_direction += double(depth) * J;
        outer += J * J.transpose();
        depth_n_r += double(depth) * n * r.transpose();
        ++contacts;
        max_depth = std::max(max_depth, depth);
    }
};

// The tool's pose is in single precision: points are tested in T relative to the tool point.
struct PointTest {
    const SdfGrid& sdf;
    Eigen::Matrix3f R_TV;
    Eigen::Vector3f p_VT;

    void operator()(const ShellBlock& block, uint32_t count, UnitSums& sums) const noexcept {
        for (uint32_t i = 0; i < count; ++i) {
            const Eigen::Vector3f r(block.x[i] - p_VT.x(), block.y[i] - p_VT.y(), block.z[i] - p_VT.z());
            const float distance = sdf.distanceAt(R_TV * r);
            if (!(distance < 0)) continue;
            sums.add(-distance, r.cast<double>(), Eigen::Vector3d(block.nx[i], block.ny[i], block.nz[i]));
        }
    }
};

// Does the leaf's bounding sphere reach the tool's box in T? Skips leaves that only its box in V meets.
bool mayTouch(const IndexBox& cells, const Eigen::Vector3d& spacing, const Eigen::AlignedBox3d& box_T,
              const Pose& X_TV) noexcept {
    const Sphere around = sphereAround(cells, spacing);
    return box_T.squaredExteriorDistance(X_TV * around.center) <= around.radius * around.radius;
}

ContactWrench scaled(const PenaltyContactConfig& config, const UnitSums& sums) noexcept {
    const double limit = double(config.full_stiffness_contacts);
    const double k = config.point_stiffness * std::min(1.0, limit / std::max(1u, sums.contacts));
    ContactWrench result;
    result.wrench = {k * sums.depth_direction.head<3>(), k * sums.depth_direction.tail<3>()};
    result.derivative = -k * sums.outer;
    result.derivative.topRightCorner<3, 3>() += k * skew(sums.depth_direction.head<3>());
    // Σ d r~ n~ = Σ d (n rᵀ - (r·n) I)
    result.derivative.bottomRightCorner<3, 3>() +=
        k * (sums.depth_n_r - sums.depth_n_r.trace() * Eigen::Matrix3d::Identity());
    result.contacts = sums.contacts;
    result.max_depth = sums.max_depth;
    return result;
}

}  // namespace

ContactWrench penaltyContact(const PenaltyContactConfig& config, const VoxelVolume& volume,
                             const LeafLattice& lattice, const PointShell& shell, const SdfGrid& tool_sdf,
                             const Pose& X_VT) noexcept {
    const Pose X_TV = X_VT.inverse();
    const PointTest test{tool_sdf, X_TV.rotation.toRotationMatrix().cast<float>(),
                         X_VT.position.cast<float>()};
    const Eigen::AlignedBox3d box_T = tool_sdf.box();
    UnitSums sums;
    lattice.forEachSurfaceLeaf(boxInV(box_T, X_VT), volume.spacing(), volume.iso(), [&](LeafId leaf) {
        if (shell.pointCount(config.shell_level, leaf) == 0 ||
            !mayTouch(lattice.cellsOf(leaf), volume.spacing(), box_T, X_TV))
            return;
        shell.forEachBlock(config.shell_level, leaf,
                           [&](const ShellBlock& block, uint32_t count) { test(block, count, sums); });
    });
    return scaled(config, sums);
}

}  // namespace bonemill
