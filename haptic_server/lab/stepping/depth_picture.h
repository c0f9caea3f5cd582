// How far everything that a camera sees of a run is away: bone by rays through its densities, as trilinear
// interpolation has them, and the tool by its triangles. No graphics card, and no library of one.
//
// Frame C: x right, y up, z out of the picture. The bone is what voxels and mesh of a run are: what lies
// around the milled region is not in it. One normal thread, the run's.
#pragma once

#include <vector>

#include "haptic_server/lab/stepping/stepped_run.h"

namespace bonemill {

struct DepthCamera {
    Pose X_WC;
    double field_of_view = 0.7;  // rad, vertical; below pi
    int width = 84, height = 84;
    double far = 0.3;  // m: what lies farther is not seen
};

inline constexpr double kNearestDepth = 1e-4;  // m: what lies nearer to the camera is not seen
inline constexpr double kFarthestDepth = 100;
inline constexpr int kMaxDepthPictureEdge = 4096;

// Row by row from above: how far the first thing behind the middle of each pixel lies along the camera's
// axis, in m; camera.far where there is none. The tool is in it from the first tick on. Throws UserError for
// a camera that cannot be.
std::vector<float> depthPicture(const SteppedRun& run, const DepthCamera& camera);

}  // namespace bonemill
