// The default contact model: every shell point inside the tool stores energy, and force and torque are exactly minus
// the gradient of the sum. No closed path gains energy, noisy bone normals do no harm, and the points' areas make the
// result independent of how densely the surface is sampled.
//
// With φ the tool's distance at bone point b, δ = -φ, g = R∇φ, n the bone's outward normal, a the point's area:
//   E = Σ κ a λ w(s) Ψ(δ),  s = -n·g,   Ψ = ½δ², linear beyond the depth cap.
// w is 0 where the tool reaches the bone from its far side (s <= 0), 1 from kGuardWidth on: a point that the tool's
// medial axis has passed cannot pull the tool on. λ <= 1 caps the stiffness in the direction of g; it is frozen when the
// candidates are gathered, so that each solve has one energy (across ticks a λ that acts is not conservative).
//
// Frame V, m, N, torque about the tool point. Everything but construction is RT-safe; tick thread only.
#pragma once

#include <vector>

#include "haptic_server/contact/point_shell.h"
#include "haptic_server/coupling/energy_coupling.h"
#include "haptic_server/tool/tool_field.h"

namespace bonemill {

struct GradientContactConfig {
    double stiffness_per_area = 1e12;  // κ, N/m³
    double stiffness_cap = 1e7;        // N/m in any direction; infinity: none
};

struct GradientContactResult {
    EnergyTerm term;
    uint32_t contacts = 0;
    double max_depth = 0;  // m
};

class GradientContact {
  public:
    static constexpr double kGuardWidth = 0.25;
    static constexpr double kDepthCap = 0.75;  // of the tool's thinnest radius

    // Room for this many candidate points; allocates.
    explicit GradientContact(const GradientContactConfig& config, size_t most_candidates = 65536);

    // Collects the points of a shell level that can touch the tool after a motion of at most `margin` (m, of any of its
    // points) from X_VT. False: more than there is room for; the rest is left out.
    bool gather(const VoxelVolume& volume, const LeafLattice& lattice, const PointShell& shell, int level,
                const ToolField& tool, const Pose& X_VT, double margin) noexcept;

    // Energy, wrench on the tool and stiffness at this pose, over the gathered points.
    template <class Scalar>
    GradientContactResult evaluate(const ToolField& tool, const Pose& X_VT) const noexcept;

    // Largest share t of the motion `step` (world increment x, ω) for which no gathered point that is free at X_VT comes
    // deeper than `allowed_depth`, and none in contact gets deeper by more than that: conservative advancement. The
    // share may be smaller than the largest, never larger. In 0 .. 1.
    double advance(const ToolField& tool, const Pose& X_VT, const Vector6d& step, double allowed_depth) const noexcept;

    size_t candidateCount() const noexcept { return count_; }
    double margin() const noexcept { return margin_; }

  private:
    struct Candidate {
        float x, y, z;     // V axes, from origin_: small numbers keep their digits
        float nx, ny, nz;  // V, unit or zero
        float weight;      // κ a λ
    };
    void capStiffness(const ToolField& tool, const Pose& X_VT) noexcept;

    GradientContactConfig config_;
    std::vector<Candidate> candidates_;
    size_t count_ = 0;
    double touching_stiffness_ = 0;  // N/m: of the candidates in contact, all directions together
    double margin_ = 0;
    Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  // V: the tool point at the gathering
};

}  // namespace bonemill
