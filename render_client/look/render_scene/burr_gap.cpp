#include "render_client/look/render_scene/burr_gap.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr int kLooks = 8;            // pixels around the burr that are looked at
constexpr double kBesideBurr = 1.7;  // burr radii from its middle, where it hides nothing
constexpr double kMinGap = 0.2;      // burr radii: less is hardly in front
constexpr double kMaxGap = 40;       // burr radii: more is another part of the bone

}  // namespace

// The shaft hides some of the surroundings, and walls stand beside the burr: the middle one of all gaps
// counts.
std::optional<double> burrGap(const FrameView& view, const Eigen::Vector2i& size,
                              const std::function<std::optional<Eigen::Vector3d>(int, int)>& pick) {
    if (!view.X_WT || !(view.burr_radius > 0)) return std::nullopt;
    const Camera& camera = view.camera;
    const Eigen::Vector3d burr_C = camera.R_WC.transpose() * (view.X_WT->position - camera.eye_W);
    const double depth = -burr_C.z();
    if (!(depth > view.burr_radius)) return std::nullopt;
    const double pixels = size.y() / (2 * camera.halfTangent() * depth);
    const Eigen::Vector2d middle(size.x() / 2.0 + burr_C.x() * pixels, size.y() / 2.0 - burr_C.y() * pixels);
    double gaps[kLooks];
    int found = 0;
    for (int i = 0; i < kLooks; ++i) {
        const double angle = 2 * M_PI * (i + 0.5) / kLooks;
        const Eigen::Vector2d at = middle + kBesideBurr * view.burr_radius * pixels *
                                                Eigen::Vector2d(std::cos(angle), std::sin(angle));
        const auto seen_W = pick(int(at.x()), int(at.y()));
        if (seen_W) gaps[found++] = (*seen_W - camera.eye_W).dot(camera.forward_W()) - depth;
    }
    if (found <= kLooks / 2) return std::nullopt;
    std::sort(gaps, gaps + found);
    const double gap = gaps[found / 2] - view.burr_radius;
    if (gap < kMinGap * view.burr_radius || gap > kMaxGap * view.burr_radius) return std::nullopt;
    return gap;
}

BurrGap behindBurr(const FrameView& view, double distance) {
    const Eigen::Vector3d sight_W = view.X_WT->position - view.camera.eye_W;
    const double way = (view.burr_radius + distance) / sight_W.dot(view.camera.forward_W());
    return {view.X_WT->position + way * sight_W, distance};
}

}  // namespace bonemill
