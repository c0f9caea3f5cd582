#include "render_client/look/visual_effects/surface_walker.h"

#include <algorithm>

namespace bonemill {
namespace {

constexpr float kSurfaceFound = 0.6e-3f;  // m: farther off there is no surface
constexpr float kLevel = 0.06f;           // sine of the slope on which a drop rests
constexpr float kOverhang = -0.85f;       // cosine to `up` of a surface that holds no drop

}  // namespace

Walk walkDown(const BoneSurface& surface, const Eigen::Vector3f& up_V, float distance, SurfacePoint& at) {
    if (at.n_V.dot(up_V) < kOverhang) return Walk::kFallsOff;
    const Eigen::Vector3f along = -up_V + at.n_V.dot(up_V) * at.n_V;
    const float slope = along.norm();
    if (slope < kLevel) return Walk::kRests;
    const Eigen::Vector3f moved = at.p_V + along * distance;  // slower where it is less steep
    const auto found = surface.nearest(moved, kSurfaceFound + distance);
    if (!found) return Walk::kFallsOff;
    at.n_V = (at.n_V + found->n_V).normalized();
    if (!at.n_V.allFinite()) return Walk::kFallsOff;
    at.p_V = moved - found->heightOf(moved) * found->n_V;
    return Walk::kGoesOn;
}

}  // namespace bonemill
