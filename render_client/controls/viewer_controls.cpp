#include "render_client/controls/viewer_controls.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill {
namespace {

constexpr double kOrbitPerHeight = 3.5;   // rad for a drag over the picture's height
constexpr double kZoomPerStep = 0.9;      // distance factor of one notch of the wheel, or of + and -
constexpr double kOrbitPerKey = 0.0873;   // rad, 5 degrees
constexpr double kCutStep = 0.02;         // of the bone's box
constexpr double kTextStep = 1.25;        // factor
constexpr double kDoubleClickTime = 0.4;  // s
constexpr double kDoubleClickRadius = 6;  // pixels

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

StereoMode nextStereo(StereoMode mode) {
    switch (mode) {
        case StereoMode::kOff:
            return StereoMode::kSideBySide;
        case StereoMode::kSideBySide:
            return StereoMode::kAnaglyph;
        case StereoMode::kAnaglyph:
            return StereoMode::kOff;
    }
    return StereoMode::kOff;
}

CtShown nextCt(CtShown shown) {
    return CtShown((int(shown) + 1) % (int(CtShown::kOnCutsAndMilled) + 1));
}

StructureMode nextMode(StructureMode mode) {
    return StructureMode((int(mode) + 1) % (int(StructureMode::kOff) + 1));
}

// W is LPS: x to the patient's left, y to the back, z to the head.
Eigen::Vector3d directionOf(Side side) {
    switch (side) {
        case Side::kFront:
            return -Eigen::Vector3d::UnitY();
        case Side::kBack:
            return Eigen::Vector3d::UnitY();
        case Side::kLeft:
            return Eigen::Vector3d::UnitX();
        case Side::kRight:
            return -Eigen::Vector3d::UnitX();
        case Side::kTop:
            return Eigen::Vector3d::UnitZ();
        case Side::kBottom:
            return -Eigen::Vector3d::UnitZ();
    }
    return -Eigen::Vector3d::UnitY();
}

// The camera's own axes for its `up` are read off the camera.
Eigen::Vector3d towardsEyeAt(OrbitCamera camera, double azimuth) {
    camera.azimuth = azimuth;
    camera.elevation = 0;
    return camera.towardsEye_W();
}

}  // namespace

void ViewerControls::handle(const WindowEvent& event, int picture_height, const SessionView& session,
                            Wishes& wishes) {
    if (pane_mouse_.handle(event, drag_ != Drag::kNone, settings_.slices)) {
        if (const auto* move = std::get_if<MouseMoveEvent>(&event)) passOver(*move);
        return;
    }
    if (hold_.handle(event, drag_ != Drag::kNone)) return;
    std::visit(Overloaded{[&](const KeyEvent& e) { onKey(e, session, wishes); },
                          [&](const TextEvent& e) {
                              if (const auto action = actionOf(e)) act(*action, session, wishes);
                          },
                          [&](const MouseButtonEvent& e) { onButton(e, session, wishes); },
                          [&](const MouseMoveEvent& e) { onMove(e, picture_height); },
                          [&](const ScrollEvent& e) { camera_.zoom(std::pow(kZoomPerStep, e.steps)); }},
               event);
}

void ViewerControls::onKey(const KeyEvent& event, const SessionView& session, Wishes& wishes) {
    if (!event.is_down && isKeyOf(Action::kPoint, event)) is_point_key_down_ = false;
    if (const auto action = actionOf(event)) act(*action, session, wishes);
}

void ViewerControls::onButton(const MouseButtonEvent& event, const SessionView& session, Wishes& wishes) {
    mouse_ = event.at;
    if (!event.is_down) {
        if (event.button == drag_button_) drag_ = Drag::kNone;
        return;
    }
    if (drag_ != Drag::kNone) return;  // a second button does not disturb a drag
    drag_button_ = event.button;
    const bool is_spare =
        hold_.isHolding() && event.button == MouseButton::kMiddle;  // the tool has the others
    if (is_spare && !event.held.shift) {
        drag_ = Drag::kOrbit;
    } else if (event.button != MouseButton::kLeft || event.held.shift) {
        drag_ = Drag::kPan;
    } else if (event.held.control) {
        drag_ = mayPoint(session, wishes) ? Drag::kPoint : Drag::kNone;
    } else {
        drag_ = Drag::kOrbit;
        onDoubleClick(event, wishes);
    }
}

void ViewerControls::onDoubleClick(const MouseButtonEvent& event, Wishes& wishes) {
    const auto first = std::exchange(last_click_, event);
    if (!first || event.time - first->time > kDoubleClickTime ||
        std::hypot(event.at.x - first->at.x, event.at.y - first->at.y) > kDoubleClickRadius)
        return;
    last_click_.reset();
    const std::string why_not = whyNoPlace();
    if (why_not.empty()) {
        wishes.centre_at = event.at;
    } else {
        wishes.notice = HudNotice{why_not, HudTone::kWarning};
    }
}

void ViewerControls::onMove(const MouseMoveEvent& event, int picture_height) {
    const PixelPoint from = std::exchange(mouse_, event.to);
    const double right = (mouse_.x - from.x) / std::max(picture_height, 1);
    const double down = (mouse_.y - from.y) / std::max(picture_height, 1);
    if (drag_ == Drag::kPan) camera_.pan(right, -down);
    if (drag_ == Drag::kOrbit) camera_.orbit(-right * kOrbitPerHeight, down * kOrbitPerHeight);
}

void ViewerControls::passOver(const MouseMoveEvent& event) {
    mouse_ = event.to;
    hold_.passOver(event.to);
}

void ViewerControls::switchHold(const SessionView& session, Wishes& wishes) {
    if (hold_.isHolding()) {
        hold_.letGo();
        wishes.notice = HudNotice{"The tool is let go: " + keyLabelOf(Action::kHoldTool) + " takes it again",
                                  HudTone::kPlain};
        return;
    }
    const std::string why_not = whyNotHold(session);
    wishes.hold_tool = why_not.empty();
    if (!why_not.empty()) wishes.notice = HudNotice{why_not, HudTone::kWarning};
}

std::optional<PixelPoint> ViewerControls::pointing() const {
    if (drag_ == Drag::kPoint || is_point_key_down_) return mouse_;
    return std::nullopt;
}

std::optional<PixelPoint> ViewerControls::hovering() const {
    if (drag_ != Drag::kNone || hold_.buttons() != 0) return std::nullopt;
    return hold_.isHolding() ? hold_.cursor() : mouse_;
}

bool ViewerControls::mayPoint(const SessionView& session, Wishes& wishes) const {
    std::string why_not = whyNotPoint(session);
    if (why_not.empty()) why_not = whyNoPlace();
    if (!why_not.empty()) wishes.notice = HudNotice{why_not, HudTone::kWarning};
    return why_not.empty();
}

// A pixel of a stereo picture stands for no one place (RenderScene::pick).
std::string ViewerControls::whyNoPlace() const {
    if (settings_.stereo == StereoMode::kOff) return "";
    return "No place can be shown in stereo: " + keyLabelOf(Action::kStereo) + " switches it off";
}

void ViewerControls::act(Action action, const SessionView& session, Wishes& wishes) {
    switch (action) {
        case Action::kFirstView:
            wishes.reset_view = true;
            return;
        case Action::kPoint:
            is_point_key_down_ = mayPoint(session, wishes);
            return;
        case Action::kHoldTool:
            return switchHold(session, wishes);
        case Action::kTrainee:
            is_panel_open_ = wishes.type_trainee = session.lesson != nullptr;
            if (!session.lesson) wishes.notice = HudNotice{"This server gives no lesson", HudTone::kWarning};
            return;
        case Action::kSavePicture:
            wishes.save_picture = true;
            return;
        case Action::kQuit:
            if (!std::exchange(settings_.show_help, false)) want({Deed::Kind::kQuit}, session, wishes);
            return;
        default:
            break;
    }
    CommandOrReason asked = commandOf(action, session);
    if (asked.command) {
        request(*asked.command, session, wishes);
    } else if (!asked.why_not.empty()) {
        wishes.notice = HudNotice{asked.why_not, HudTone::kWarning};
    } else {
        changeView(action);
    }
}

void ViewerControls::want(const Deed& deed, const SessionView& session, Wishes& wishes) {
    if (isSecondStart(deed, session)) return;
    const std::optional<Question> question = questionBefore(deed, session);
    const auto asked = std::exchange(asked_, std::nullopt);
    if (!question || (asked && isSame(*asked, deed))) return carryOut(deed, session, wishes);
    asked_ = deed;
    wishes.asked = question->text;
}

bool ViewerControls::isSecondStart(const Deed& deed, const SessionView& session) const {
    return deed.command.has_start_attempt() && last_start_s_ && session.time_s - *last_start_s_ < kStartTime;
}

void ViewerControls::carryOut(const Deed& deed, const SessionView& session, Wishes& wishes) {
    topics::Command extra;
    switch (deed.kind) {
        case Deed::Kind::kCommand:
            extra.set_save_checkpoint(true);
            if (wantsCheckpointBefore(deed, session)) wishes.commands.push_back(extra);
            wishes.commands.push_back(deed.command);
            if (deed.command.has_start_attempt()) last_start_s_ = session.time_s;
            return;
        case Deed::Kind::kNextTrainee:
            extra.set_stop_attempt(true);
            if (session.lesson && session.lesson->is_running()) wishes.commands.push_back(extra);
            wishes.next_trainee = true;
            return;
        case Deed::Kind::kQuit:
            wishes.quit = true;
            return;
    }
}

std::optional<Question> ViewerControls::question(const SessionView& session) const {
    return asked_ ? questionBefore(*asked_, session) : std::nullopt;
}

void ViewerControls::answer(Answer answer, const SessionView& session, Wishes& wishes) {
    const auto asked = std::exchange(asked_, std::nullopt);
    if (!asked || answer == Answer::kNo) return;
    topics::Command save;
    save.set_save_checkpoint(true);
    if (answer == Answer::kSaveFirst) wishes.commands.push_back(save);
    carryOut(*asked, session, wishes);
}

void ViewerControls::dropIdleQuestion(const SessionView& session) {
    if (!question(session)) asked_.reset();
}

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
            settings_.slices.ct = nextCt(settings_.slices.ct);
            return;
        case Action::kSlices:
            return toggle(settings_.slices.are_shown);
        case Action::kTransparency:
            return toggle(settings_.is_transparent);
        case Action::kStructures:
            return settings_.structures.fill(nextMode(settings_.structures[0]));
        case Action::kThickness:
            return toggle(settings_.show_thickness);
        case Action::kStereo:
            return setStereo(nextStereo(settings_.stereo));
        case Action::kQuickDrawing:
            settings_.quality = settings_.quality == Quality::kFull ? Quality::kQuick : Quality::kFull;
            return;
        case Action::kEndoscope:
            return switchCamera(CameraMode::kEndoscope);
        case Action::kMicroscope:
            return switchCamera(CameraMode::kMicroscope);
        case Action::kWatchers:
            settings_.show_details = false;
            return toggle(settings_.show_watchers);
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
            return camera_.zoom(kZoomPerStep);
        case Action::kZoomOut:
            return camera_.zoom(1 / kZoomPerStep);
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
        std::clamp(settings_.text_scale * factor, ViewSettings::kLeastText, ViewSettings::kMostText);
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
    const Eigen::Vector3d direction = directionOf(side);
    const Eigen::Vector3d front = towardsEyeAt(camera_, 0), left = towardsEyeAt(camera_, M_PI / 2);
    camera_.elevation = std::asin(std::clamp(direction.dot(camera_.up_W()), -1.0, 1.0));
    const Eigen::Vector2d level(direction.dot(front), direction.dot(left));
    camera_.azimuth = level.norm() > 1e-6 ? std::atan2(level.y(), level.x()) : 0;
    camera_.orbit(0, 0);  // into range
}

}  // namespace bonemill
