#include "render_client/look/camera/microscope.h"

#include <cmath>

namespace bonemill {
namespace {

constexpr double kWorkingDistance =
    0.25;  // m from the objective to the focus, as ear and spine surgeons have it

}  // namespace

Camera microscopeCamera(const Camera& orbit) {
    Camera camera = orbit;
    camera.eye_W = orbit.target_W() - kWorkingDistance * orbit.forward_W();
    camera.field_of_view = 2 * std::atan(orbit.halfTangent() * orbit.focus / kWorkingDistance);
    camera.focus = kWorkingDistance;
    return camera;
}

}  // namespace bonemill
