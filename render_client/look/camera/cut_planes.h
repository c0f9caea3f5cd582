// The view's cut-planes are half-spaces: a point p is shown when n·p + d >= 0 for all of them.
//
// It is for any thread and never throws.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "render_client/look/camera/view_settings.h"

namespace bonemill {

// Each plane is (n, d) with a unit normal n towards the side that is shown, m. One that is off hides nothing.
struct CutPlanes {
    static constexpr int kMax = 3;
    std::array<Eigen::Vector4f, kMax> planes = {Eigen::Vector4f::UnitW(), Eigen::Vector4f::UnitW(),
                                                Eigen::Vector4f::UnitW()};
    std::array<bool, kMax> is_on{};

    bool any() const { return is_on[0] || is_on[1] || is_on[2]; }
};

// Returns the planes in W. The positions count within the bone's box in W; an empty box has no cuts.
CutPlanes cutPlanes(const std::array<CutPlane, CutPlanes::kMax>& cuts, const Eigen::AlignedBox3d& bone_W);

// Returns the same planes in frame A, with the rigid X_AB.
CutPlanes transformed(const CutPlanes& cuts_B, const Eigen::Matrix4f& X_AB);

}  // namespace bonemill
