// How far the burr hangs in front of the bone along the line of sight, found in the last picture. It is for
// the thread of the OpenGL context; units are m and pixels, the frame is W.
#pragma once

#include <functional>
#include <optional>

#include "render_client/look/paint/frame.h"

namespace bonemill {

// Returns the way from the burr's surface to the bone (m). `view` is that of the last picture, of this size,
// and `pick` gives what is seen at a pixel of it. Nothing where there is no bone around the burr, or the burr
// is as near as its surroundings.
std::optional<double> burrGap(const FrameView& view, const Eigen::Vector2i& size,
                              const std::function<std::optional<Eigen::Vector3d>(int, int)>& pick);

// Where that is behind the tool of this view, which may have moved on since.
BurrGap behindBurr(const FrameView& view, double distance);

}  // namespace bonemill
