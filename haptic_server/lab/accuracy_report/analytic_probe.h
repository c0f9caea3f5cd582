// Presses the burr on a plane, where force and pose are known in closed form: the sphere of radius R at depth
// d is pushed back by π κ (R - d) d² (gradient law with areas). There are many rotated and shifted voxel
// grids, so that what remains is the accuracy of the sampling, and how it depends on the grid's direction.
#pragma once

#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/tick/tick_config.h"

namespace bonemill {

// This is the force in N on a sphere at depth d < R in a half-space.
double forceOnSphere(double kappa, double radius, double depth) noexcept;

// This is the diameter in m of the circle in which a sphere at the depth of this force touches a half-space,
// found by bisection.
double contactWidth(double kappa, double radius, double force) noexcept;

// At this depth d that force balances the saturating spring to a device at depth `device_depth`;
// bisection finds it.
double depthUnderSpring(const FixedTickConfig& tick, double device_depth) noexcept;

// The hand feels this from the burr pressed on a plane with 0.5 to 4 N, against the closed form.
struct PlaneErrors {
    double force = 0;  // of 1, root mean square over grids and loads
    double depth = 0;  // m, root mean square
    double anisotropy =
        0;  // of 1: (largest - smallest) / mean force over the grids, at the load where it is largest
};

// Judges the contact alone, with the burr at a prescribed depth in the plane.
struct PatchErrors {
    int shell_factor = 1;
    ToolDistance tool_distance = ToolDistance::kAnalytic;
    int sdf_refinement = 1;
    double sample_spacing = 0;  // m
    double width_voxels = 0;    // diameter of the contact circle
    double depth = 0;           // m
    double force_rms = 0;       // of 1, over the grids
    double force_worst = 0;     // of 1
    double direction_rms = 0;   // rad
};

struct AnalyticProbeConfig {
    FixedTickConfig tick;
    double spacing = 0;                 // m, of the voxels
    double sdf_spacing = 0;             // m, of the burr's distance grid
    std::vector<int> refinements;       // of that grid, > 1, ascending: those that will be asked for
    std::vector<int> shell_factors{1};  // those that will be asked for
    bool has_analytic_tool = true;      // false: the scene's tool has only grids, so the burr here too
};

class AnalyticProbe {
  public:
    static constexpr int kGrids = 20;

    explicit AnalyticProbe(const AnalyticProbeConfig& config);

    PlaneErrors measure(const AccuracySettings& settings);
    // There is one entry for each shell factor with the analytic burr and each preset's sampling, and
    // one with its grids and the finest sampling.
    std::vector<PatchErrors> patchErrors() const;

  private:
    struct Plane {  // the half-space z_W < 0 in voxels of its own direction
        BoneModel bone;
        Eigen::Quaterniond R_WT;
    };
    PatchErrors patchAt(const AccuracySettings& settings, double width_voxels) const;

    AnalyticProbeConfig config_;
    ToolModel burr_;
    std::vector<Plane> planes_;
};

}  // namespace bonemill
