// A small marker in the picture's lower right corner turns with the camera: it says where the patient's sides
// are, or at least the volume's axes. The functions are pure; any thread may call them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "render_client/look/hud/hud.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/look/hud/hud_layout.h"

namespace bonemill {

// An end of an axis as it is drawn: towards (right, up) of unit length or less; `nearness` is 1 when it
// points at the eye, -1 away from it.
struct OrientationEnd {
    char letter;
    int axis;
    bool is_positive;
    Eigen::Vector2f towards;
    float nearness;
};

// Returns the ends that have a letter, the farthest first: R, L, A, P, S, I of the patient, or x, y, z.
std::vector<OrientationEnd> orientationEnds(const OrientationAxes& axes);

// Puts the marker above the scale bar's place. A picture that is too small for it gets none.
void layOutOrientation(HudCanvas& canvas, const OrientationAxes& axes, const PictureSize& picture);

}  // namespace bonemill
