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
    if (frame.has_shadow) append(signature, frame.key.shadow_from_camera);
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

// What moves is drawn anew also where it stands still before bone that is.
PictureChanges::Dirty PictureChanges::next(const Frame& frame, int width, int height, Changed changed) {
    const bool stands_still = !changed.still_like.empty() && changed.still_like == still_like_;
    still_like_ = std::move(changed.still_like);
    Dirty dirty{false, {}, PixelTiles(width, height), changed.moving};
    const std::optional<PixelTiles> moved = std::exchange(moving_, std::move(changed.moving));
    std::vector<float> signature = signatureOf(frame, width, height);
    if (signature != signature_) {
        signature_ = std::move(signature);
        return {true, PixelBox::whole(width, height), dirty.look, PixelTiles::whole(width, height)};
    }
    const auto pixels = [&](const Eigen::AlignedBox3f& box_V) {
        return PixelBox::around(box_V, frame.clip_from_camera * frame.X_CV, width, height);
    };
    dirty.bone = pixels(changed.bone_V);
    for (const Eigen::AlignedBox3f& box_V : changed.look_V) dirty.look.add(pixels(box_V));
    if (moved) dirty.moving.add(*moved);
    if (stands_still && dirty.bone.isEmpty() && dirty.look.isEmpty())
        dirty.moving = PixelTiles(width, height);
    return dirty;
}

}  // namespace bonemill
