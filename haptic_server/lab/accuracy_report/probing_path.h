// Finds where the tool first touches the scene's bone, and where on it it is tried; there the device is led
// along smooth closed strokes with the forces of surgery. For laying out paths, not for the tick.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/lab/accuracy_report/measures.h"
#include "proto/scene.pb.h"

namespace bonemill {

class TouchProbe {
  public:
    // Keeps references. Uses the shell's finest level and the tool's most exact distances.
    TouchProbe(const BoneModel& bone, const ToolModel& tool);

    // Does some contact point lie in the tool, or the tool point in bone?
    bool touches(const Pose& X_WT);

    // The bone pushes the touching tool along this unit vector in W; it is zero if it does not.
    Eigen::Vector3d pushOn(const Pose& X_WT);

    // It is the distance in m from the tool point to the line along which that push acts; 0 if there is none.
    double armOf(const Pose& X_WT);

    // This is the last free place, to 1 µm, before the tool first touches on the way pose_at(0 .. longest),
    // longest in m; nothing if it is free all the way, or touches at the start.
    using PoseAt = std::function<Pose(double way)>;
    std::optional<double> freeWay(const PoseAt& pose_at, double longest);

    // The way goes straight from X_WT along the unit vector `direction`.
    std::optional<double> freeWay(const Pose& X_WT, const Eigen::Vector3d& direction, double longest);

    // This is the box in V of the bone's surface that lies within `distance` of the tool at any of the poses;
    // it is empty if none does.
    Eigen::AlignedBox3d surfaceNear(std::span<const Pose> path, double distance) const;

  private:
    GradientContactResult contactAt(const Pose& X_WT);
    bool isInBone(const Eigen::Vector3d& p_W) const;

    const BoneModel& bone_;
    const ToolField& field_;
    Pose X_VW_;
    int level_;
    GradientContact contact_;
};

struct ProbingPlace {
    std::string name;          // for people
    Pose X_WT;                 // the tool, about to touch
    Eigen::Vector3d normal_W;  // along which the bone pushes it: unit
    double room;               // m that it can go back along the normal and is still free, up to kMaxRoom
    static constexpr double kMaxRoom = 1e-3;
};

// There are up to kMaxPlaces: the first touch in each segment of the scene's scenario that starts in the
// air, beside the first of these, and there with the tool laid down so that its shaft touches, where it can.
// Without a touch on the scenario's way the tool comes from the volume's faces towards its middle. There is
// none if nothing can be touched.
std::vector<ProbingPlace> findProbingPlaces(const scene::SimulatedOperator& scenario, const BoneModel& bone,
                                            double burr_radius, TouchProbe& probe);
inline constexpr size_t kMaxPlaces = 6;

// It is a unit vector across `normal`, the same for equal normals.
Eigen::Vector3d tangentOf(const Eigen::Vector3d& normal);

// A stroke starts and ends at rest in the same free pose: press, slide round a small closed loop on the
// surface with changing load and a few degrees of turning, let go.
struct ProbingStroke {
    std::string name;
    PosePath device;
    double deepest = 0;  // m: how far the device goes beyond the surface, about
};

// Says how hard and how long a stroke presses.
struct StrokeConfig {
    double lightest = 0.5;      // N that the coupling pulls with, about
    double heaviest = 4;        // N; less if the coupling saturates earlier
    double duration = 1.5;      // s
    double loop_radius = 1e-3;  // m, at most
    double turning = 0.05;      // rad
};

ProbingStroke makeStroke(const ProbingPlace& place, const StrokeConfig& stroke, const FixedTickConfig& tick,
                         TouchProbe& probe);

// At this distance of the device beyond the tool the gradient model's coupling pulls with `force` (less
// than its saturation).
double stretchOf(const EnergyCoupling& coupling, double force);

// A knot is a tool pose as an offset from a base pose, both in W.
struct PathKnot {
    Eigen::Vector3d position;                            // m, W
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rotation vector, W, on top of the base's rotation
};

// Makes `ticks` poses along the uniform cubic B-spline of the knots (twice continuously differentiable; it
// passes near the knots, and exactly through the first and the last one, where it rests).
PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks);

}  // namespace bonemill
