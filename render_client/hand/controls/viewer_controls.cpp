#include "render_client/hand/controls/viewer_controls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr double kOrbitPerHeight = 3.5;   // rad for a drag over the picture's height
constexpr double kZoomPerStep = 0.9;      // distance factor of one notch of the wheel
constexpr double kDoubleClickTime = 0.4;  // s
constexpr double kDoubleClickRadius = 6;  // pixels

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

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
        if (event.button != drag_button_) return;
        if (drag_ == Drag::kDraw) pen_.end();
        const bool is_click =
            std::hypot(event.at.x - pressed_at_.x, event.at.y - pressed_at_.y) <= kDoubleClickRadius;
        if (drag_ == Drag::kPan && event.button == MouseButton::kRight && is_click && isReplay(session))
            askForRemoval(event.at, session, wishes);
        drag_ = Drag::kNone;
        return;
    }
    if (drag_ != Drag::kNone) return;  // a second button does not disturb a drag
    drag_button_ = event.button;
    pressed_at_ = event.at;
    const bool is_spare =
        hold_.isHolding() && event.button == MouseButton::kMiddle;  // the tool has the others
    const bool is_drawn = event.held.control ? event.held.shift : is_drawing_ && !event.held.shift;
    if (is_spare && !event.held.shift) {
        drag_ = Drag::kOrbit;
    } else if (event.button == MouseButton::kLeft && is_drawn) {
        drag_ = mayDraw(session, wishes) ? Drag::kDraw : Drag::kNone;
        if (drag_ == Drag::kDraw) pen_.begin(event.at);
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
    if (drag_ == Drag::kDraw) pen_.move(event.to);
    if (drag_ == Drag::kPan) camera_.pan(right, -down);
    if (drag_ == Drag::kOrbit) camera_.orbit(-right * kOrbitPerHeight, down * kOrbitPerHeight);
}

void ViewerControls::passOver(const MouseMoveEvent& event) {
    mouse_ = event.to;
    hold_.passOver(event.to);
}

void ViewerControls::askForRemoval(const PixelPoint& at, const SessionView& session, Wishes& wishes) const {
    std::string why_not = whyNotCommand(session);
    if (why_not.empty() && !isReplay(session)) why_not = tr("This is no replay of a recorded session");
    if (why_not.empty()) why_not = whyNoPlace();
    if (why_not.empty())
        wishes.removal_at = at;
    else
        wishes.notice = HudNotice{why_not, HudTone::kWarning};
}

void ViewerControls::switchHold(const SessionView& session, Wishes& wishes) {
    if (hold_.isHolding()) {
        hold_.letGo();
        wishes.notice = HudNotice{
            tr("The tool is let go: {1} takes it again", {keyLabelOf(Action::kHoldTool)}), HudTone::kPlain};
        return;
    }
    if (whyNotTakeOver(session).empty())
        return request(commandWith(&topics::Command::set_take_over, true), session, wishes);
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

bool ViewerControls::mayDraw(const SessionView& session, Wishes& wishes) const {
    std::string why_not = whyNotCommand(session);
    if (why_not.empty()) why_not = whyNoPlace();
    if (!why_not.empty()) wishes.notice = HudNotice{why_not, HudTone::kWarning};
    return why_not.empty();
}

void ViewerControls::switchDrawing(const SessionView& session, Wishes& wishes) {
    is_drawing_ = !is_drawing_ && mayDraw(session, wishes);
    settings_.show_remarks = settings_.show_remarks || is_drawing_;
}

// In stereo the note belongs to no place.
void ViewerControls::writeNote(const SessionView& session, Wishes& wishes) {
    const std::string why_not = whyNotCommand(session);
    if (!why_not.empty()) {
        wishes.notice = HudNotice{why_not, HudTone::kWarning};
        return;
    }
    is_panel_open_ = wishes.write_note = settings_.show_remarks = true;
    if (whyNoPlace().empty()) wishes.note_at = hovering();
}

// A pixel of a stereo picture stands for no one place (RenderScene::pick).
std::string ViewerControls::whyNoPlace() const {
    if (settings_.stereo == StereoMode::kOff) return "";
    return tr("No place can be shown in stereo: {1} switches it off", {keyLabelOf(Action::kStereo)});
}

void ViewerControls::act(Action action, const SessionView& session, Wishes& wishes) {
    switch (action) {
        case Action::kFirstView:
            wishes.reset_view = true;
            return;
        case Action::kPoint:
            is_point_key_down_ = mayPoint(session, wishes);
            return;
        case Action::kDraw:
            return switchDrawing(session, wishes);
        case Action::kNote:
            return writeNote(session, wishes);
        case Action::kRemovalHere:
            return askForRemoval(mouse_, session, wishes);
        case Action::kHoldTool:
            return switchHold(session, wishes);
        case Action::kTrainee:
            is_panel_open_ = wishes.type_trainee = session.lesson != nullptr;
            if (!session.lesson)
                wishes.notice = HudNotice{tr("This server gives no lesson"), HudTone::kWarning};
            return;
        case Action::kFullScreen:
            wishes.full_screen = true;
            return;
        case Action::kSavePicture:
            wishes.save_picture = true;
            return;
        case Action::kQuit:
            if (std::exchange(settings_.show_help, false) || std::exchange(is_drawing_, false)) return;
            return want({Deed::Kind::kQuit}, session, wishes);
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

}  // namespace bonemill
