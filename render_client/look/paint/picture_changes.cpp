#include "render_client/look/paint/picture_changes.h"

#include <algorithm>
#include <utility>

namespace bonemill {
namespace {

constexpr double kLoosest = 2;        // a range that is N times too wide is made anew
constexpr double kRangeMargin = 0.1;  // of the near and far distance: room for the tool to move

bool isSame(const Camera& a, const Camera& b) {
    return a.eye_W == b.eye_W && a.R_WC == b.R_WC && a.field_of_view == b.field_of_view &&
           a.focus == b.focus && a.shift == b.shift;
}

template <class Matrix>
void append(std::vector<float>& signature, const Matrix& matrix) {
    signature.insert(signature.end(), matrix.data(), matrix.data() + matrix.size());
}

std::vector<float> signatureOf(const Frame& frame, int width, int height) {
    std::vector<float> signature{float(width),       float(height), frame.bone_radius, frame.key.reach,
                                 frame.field_radius, frame.focus,   frame.blur_per_m};
    append(signature, frame.clip_from_camera);
    append(signature, frame.X_CV);
    append(signature, frame.key.direction);
    for (const Eigen::Vector4f& plane : frame.cuts_V.planes) append(signature, plane);
    append(signature, frame.bone_V.min());
    append(signature, frame.bone_V.max());
    return signature;
}

}  // namespace

DepthRange PictureChanges::range(const Camera& camera, const DepthRange& needed) {
    const bool is_tight = needed.far * kLoosest > range_.far && needed.near < range_.near * kLoosest;
    if (isSame(camera, camera_) && is_tight) {
        range_ = {std::min(range_.near, needed.near), std::max(range_.far, needed.far)};
    } else {
        range_ = {needed.near * (1 - kRangeMargin), needed.far * (1 + kRangeMargin)};
        camera_ = camera;
    }
    return range_;
}

PictureChanges::Dirty PictureChanges::next(const Frame& frame, int width, int height,
                                           const Eigen::AlignedBox3f& changed_V, const PixelBox& moving,
                                           std::vector<float> still_like) {
    const bool stands_still = !still_like.empty() && still_like == still_like_;
    still_like_ = std::move(still_like);
    const PixelBox moved = std::exchange(moving_, moving);
    const PixelBox whole = PixelBox::whole(width, height);
    std::vector<float> signature = signatureOf(frame, width, height);
    if (signature != signature_) {
        signature_ = std::move(signature);
        return {whole, whole};
    }
    const PixelBox bone = PixelBox::around(changed_V, frame.clip_from_camera * frame.X_CV, width, height);
    if (stands_still) return {bone, bone};
    return {bone, bone.joined(moved).joined(moving)};
}

}  // namespace bonemill
