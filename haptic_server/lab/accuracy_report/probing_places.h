// Finds where on the scene's bone the tool is tried.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/lab/accuracy_report/touch.h"
#include "proto/scene.pb.h"

namespace bonemill {

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

}  // namespace bonemill
