#include "render_client/hand/controls/tool_hold.h"

#include <algorithm>
#include <utility>

#include "common/device_messages/device_messages.h"
#include "render_client/hand/controls/key_table.h"

namespace bonemill {
namespace {

constexpr double kMinDepth = 1e-3;       // m in front of the eye
constexpr double kBeginInFront = 3;      // burr radii from the surface to the burr's centre
constexpr double kMinTowardsEye = 0.15;  // of the shaft's direction
constexpr double kHandAboveSight = 0.7;  // rad: a hand comes from above the line of sight

}  // namespace

Eigen::Vector3d PictureView::pointAt(const PixelPoint& pixel, double depth) const {
    const double tangent = camera.halfTangent(), aspect = double(width) / height;
    const double right = (2 * pixel.x / width - 1) * tangent * aspect + camera.shift;
    const double up = (1 - 2 * pixel.y / height) * tangent;
    return camera.eye_W + camera.R_WC * (depth * Eigen::Vector3d(right, up, -1));
}

PixelPoint PictureView::pixelOf(const Eigen::Vector3d& p_W) const {
    const Eigen::Vector3d p_C = camera.R_WC.transpose() * (p_W - camera.eye_W);
    const double pixels = height / (2 * camera.halfTangent() * -p_C.z());
    return {width / 2.0 + (p_C.x() + camera.shift * p_C.z()) * pixels, height / 2.0 - p_C.y() * pixels};
}

double PictureView::depthOf(const Eigen::Vector3d& p_W) const {
    return (p_W - camera.eye_W).dot(camera.forward_W());
}

void ToolHold::lookAt(const PictureView& view) {
    const bool is_other = view.camera.eye_W != view_.camera.eye_W || view.camera.R_WC != view_.camera.R_WC ||
                          view.width != view_.width || view.height != view_.height;
    if (is_other) aside_ = {};
    view_ = view;
}

void ToolHold::passOver(const PixelPoint& to) {
    mouse_ = to;
    aside_ = {};
}

void ToolHold::begin(const Pose& X_WT, double burr_radius) {
    X_WT_ = X_WT;
    burr_radius_ = burr_radius;
    aside_ = {};
    held_ = {};
    is_holding_ = true;
}

void ToolHold::letGo() {
    is_holding_ = false;
    held_ = {};
}

uint32_t ToolHold::buttons() const {
    if (held_.mill_button || held_.mill_key) return kButtonRemove;
    return held_.add_button || held_.add_key ? uint32_t{kButtonAdd} : 0u;
}

bool ToolHold::handle(const WindowEvent& event, bool is_camera_dragged) {
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        onMove(move->to, is_camera_dragged);
        return false;  // whoever drags something else follows it, too
    }
    if (!is_holding_) return false;
    if (const auto* key = std::get_if<KeyEvent>(&event)) return onKey(*key);
    if (const auto* button = std::get_if<MouseButtonEvent>(&event)) return onButton(*button);
    if (const auto* scroll = std::get_if<ScrollEvent>(&event); scroll && !held_.clutch) {
        moveAlongSight(scroll->steps);
        return true;
    }
    return false;
}

bool ToolHold::onKey(const KeyEvent& event) {
    const std::pair<Action, bool*> held[] = {{Action::kMill, &held_.mill_key},
                                             {Action::kAddMaterial, &held_.add_key},
                                             {Action::kTurnTool, &held_.turn_key},
                                             {Action::kClutch, &held_.clutch}};
    for (const auto& [action, is_held] : held) {
        if (!isKeyOf(action, event)) continue;
        *is_held = event.is_down;
        return true;
    }
    const bool is_deeper = isKeyOf(Action::kToolDeeper, event);
    if (!is_deeper && !isKeyOf(Action::kToolNearer, event)) return false;
    if (event.is_down) moveAlongSight(is_deeper ? 1 : -1);
    return true;
}

bool ToolHold::onButton(const MouseButtonEvent& event) {
    const bool is_left = event.button == MouseButton::kLeft, is_right = event.button == MouseButton::kRight;
    if (!event.is_down) {
        if (is_left) held_.mill_button = held_.add_button = false;
        if (is_right) held_.turn_button = false;
        return false;  // it may end a drag of the camera
    }
    if (held_.clutch || event.held.control) return false;
    if (is_left) (event.held.shift ? held_.add_button : held_.mill_button) = true;
    if (is_right) held_.turn_button = true;
    return is_left || is_right;
}

void ToolHold::onMove(const PixelPoint& to, bool is_camera_dragged) {
    const PixelPoint from = std::exchange(mouse_, to).value_or(to);
    if (!is_holding_ || is_camera_dragged || held_.clutch) return;
    held_.turn_button || held_.turn_key ? turn(from, to) : follow(from, to);
}

double ToolHold::depth() const {
    return std::max(view_.depthOf(X_WT_.position), kMinDepth);
}

void ToolHold::follow(const PixelPoint& from, const PixelPoint& to) {
    if (view_.has_places) {
        X_WT_.position = view_.pointAt({to.x + aside_.x, to.y + aside_.y}, depth());
    } else {
        X_WT_.position += view_.pointAt(to, depth()) - view_.pointAt(from, depth());
    }
}

// What the user sees of the tool's near side goes with the mouse.
void ToolHold::turn(const PixelPoint& from, const PixelPoint& to) {
    const Eigen::Vector3d turn_C(to.y - from.y, to.x - from.x, 0);
    aside_ = {aside_.x + from.x - to.x, aside_.y + from.y - to.y};
    X_WT_ = X_WT_.incremented(Eigen::Vector3d::Zero(),
                              view_.camera.R_WC * (kTurnPerHeight / view_.height * turn_C));
}

void ToolHold::moveAlongSight(double steps) {
    const Eigen::Vector3d sight = (X_WT_.position - view_.camera.eye_W).normalized();
    const Eigen::Vector3d p_W = X_WT_.position + steps * kDepthPerStep * burr_radius_ * sight;
    if (view_.depthOf(p_W) > kMinDepth) X_WT_.position = p_W;
}

Pose beginInFrontOf(const Eigen::Vector3d& surface_W, const Camera& camera, double burr_radius,
                    const std::optional<Pose>& X_WT) {
    const Eigen::Vector3d towards_eye = (camera.eye_W - surface_W).normalized();
    const Eigen::Vector3d p_W = surface_W + kBeginInFront * burr_radius * towards_eye;
    const bool is_turned_well =
        X_WT && (X_WT->rotation * Eigen::Vector3d::UnitY()).dot(towards_eye) > kMinTowardsEye;
    if (is_turned_well) return {p_W, X_WT->rotation};
    const Eigen::Vector3d up_W = camera.R_WC.col(1);
    const Eigen::Vector3d shaft_W =
        std::cos(kHandAboveSight) * towards_eye + std::sin(kHandAboveSight) * up_W;
    return {p_W, rotationBetween(Eigen::Vector3d::UnitY(), shaft_W)};
}

}  // namespace bonemill
