// What keys and panel do to the view.
#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/hand/controls/viewer_controls.h"

namespace bonemill {
namespace {

constexpr double kZoomPerKey = 0.9;      // distance factor of + and -
constexpr double kOrbitPerKey = 0.0873;  // rad, 5 degrees
constexpr double kCutStep = 0.02;        // of the bone's box
constexpr double kTextStep = 1.25;       // factor

template <class Mode>
Mode nextOf(Mode mode, Mode last) {
    return Mode((int(mode) + 1) % (int(last) + 1));
}

// W is LPS: x to the patient's left, y to the back, z to the head. The order is that of Side.
const Eigen::Vector3d kSides[] = {-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY(),
                                  Eigen::Vector3d::UnitX(),  -Eigen::Vector3d::UnitX(),
                                  Eigen::Vector3d::UnitZ(),  -Eigen::Vector3d::UnitZ()};

// The camera's own axes for its `up` are read off the camera.
Eigen::Vector3d towardsEyeAt(OrbitCamera camera, double azimuth) {
    camera.azimuth = azimuth;
    camera.elevation = 0;
    return camera.towardsEye_W();
}

}  // namespace

void ViewerControls::changeView(Action action) {
    const auto toggle = [](bool& value) { value = !value; };
    switch (action) {
        case Action::kForceArrow:
            return toggle(settings_.show_force);
        case Action::kCutX:
        case Action::kCutY:
        case Action::kCutZ:
            return switchCut(size_t(action) - size_t(Action::kCutX));
        case Action::kFlipX:
        case Action::kFlipY:
        case Action::kFlipZ:
            return flipCut(size_t(action) - size_t(Action::kFlipX));
        case Action::kCutLower:
            return moveCut(-kCutStep);
        case Action::kCutHigher:
            return moveCut(kCutStep);
        case Action::kScanOnBone:
            settings_.slices.ct = nextOf(settings_.slices.ct, CtShown::kMaterialsOnCuts);
            return;
        case Action::kSlices:
            return toggle(settings_.slices.are_shown);
        case Action::kTransparency:
            return toggle(settings_.is_transparent);
        case Action::kStructures:
            return settings_.structures.fill(nextOf(settings_.structures[0], StructureMode::kOff));
        case Action::kThickness:
            return toggle(settings_.show_thickness);
        case Action::kStereo:
            return setStereo(nextOf(settings_.stereo, StereoMode::kAnaglyph));
        case Action::kQuickDrawing:
            settings_.quality = settings_.quality == Quality::kFull ? Quality::kQuick : Quality::kFull;
            settings_.picks_quality = false;
            return;
        case Action::kEndoscope:
            return switchCamera(CameraMode::kEndoscope);
        case Action::kMicroscope:
            return switchCamera(CameraMode::kMicroscope);
        case Action::kWatchers:
            settings_.show_details = false;
            return toggle(settings_.show_watchers);
        case Action::kRemarks:
            return toggle(settings_.show_remarks);
        case Action::kPanel:
            return toggle(is_panel_open_);
        case Action::kHud:
            return toggle(settings_.show_hud);
        case Action::kDetails:
            return switchDetails();
        case Action::kHelp:
            return toggle(settings_.show_help);
        case Action::kLargerText:
            return scaleText(kTextStep);
        case Action::kSmallerText:
            return scaleText(1 / kTextStep);
        case Action::kOrbitLeft:
            return camera_.orbit(kOrbitPerKey, 0);
        case Action::kOrbitRight:
            return camera_.orbit(-kOrbitPerKey, 0);
        case Action::kOrbitUp:
            return camera_.orbit(0, -kOrbitPerKey);
        case Action::kOrbitDown:
            return camera_.orbit(0, kOrbitPerKey);
        case Action::kZoomIn:
            return camera_.zoom(kZoomPerKey);
        case Action::kZoomOut:
            return camera_.zoom(1 / kZoomPerKey);
        default:
            return;
    }
}

// Who asks for all figures wants to see them. Of two lists one is open, so that the bone stays in view.
void ViewerControls::switchDetails() {
    settings_.show_watchers = false;
    settings_.show_details = !(settings_.show_hud && settings_.show_details);
    settings_.show_hud = true;
}

void ViewerControls::scaleText(double factor) {
    settings_.text_scale =
        std::clamp(settings_.text_scale * factor, ViewSettings::kMinText, ViewSettings::kMaxText);
}

void ViewerControls::switchCamera(CameraMode mode) {
    settings_.camera = settings_.camera == mode ? CameraMode::kOrbit : mode;
}

void ViewerControls::switchCut(size_t axis) {
    settings_.cuts[axis].is_on = !settings_.cuts[axis].is_on;
    last_cut_ = axis;
}

void ViewerControls::flipCut(size_t axis) {
    settings_.cuts[axis].is_flipped = !settings_.cuts[axis].is_flipped;
    last_cut_ = axis;
}

void ViewerControls::moveCut(double by) {
    CutPlane& cut = settings_.cuts[last_cut_];
    cut.position = std::clamp(cut.position + by, 0.0, 1.0);
}

void ViewerControls::moveCutTo(size_t axis, double position) {
    settings_.cuts[axis].is_on = true;
    settings_.cuts[axis].position = std::clamp(position, 0.0, 1.0);
    last_cut_ = axis;
}

void ViewerControls::setOpacity(double opacity) {
    settings_.is_transparent = true;
    settings_.opacity = std::clamp(opacity, 0.0, 1.0);
}

void ViewerControls::lookFrom(Side side) {
    const Eigen::Vector3d& direction = kSides[size_t(side)];
    const Eigen::Vector3d front = towardsEyeAt(camera_, 0), left = towardsEyeAt(camera_, M_PI / 2);
    camera_.elevation = std::asin(std::clamp(direction.dot(camera_.up_W()), -1.0, 1.0));
    const Eigen::Vector2d level(direction.dot(front), direction.dot(left));
    camera_.azimuth = level.norm() > 1e-6 ? std::atan2(level.y(), level.x()) : 0;
    camera_.orbit(0, 0);  // into range
}

}  // namespace bonemill
