#include "render_client/panel/panel/panel.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

#include "render_client/panel/panel/lesson_cards.h"
#include "render_client/panel/panel/panel_content.h"
#include "render_client/panel/panel/question_box.h"
#include "render_client/panel/panel/session_choice.h"

namespace bonemill {
namespace {

constexpr int kFramesToSettle = 3;  // until ImGui knows how large its contents are
// The help page takes the place of the panel and of what a lesson shows.
bool isHelpInFront(const ViewerControls& controls) {
    return controls.settings().show_help && controls.settings().show_hud;
}

}  // namespace

Panel::Panel() = default;

Panel::~Panel() = default;

void Panel::setPicture(int width, int height, int view_width, float scale, double seconds) {
    view_width_ = float(view_width);
    stage_.setPicture(width, height, scale);
    pending_seconds_ = seconds;
}

// Each event gets a frame of ImGui: none of two clicks within one picture is lost, and who is meant by an
// event is known before the next one.
bool Panel::handle(const WindowEvent& event, ViewerControls& controls, const SessionView& session,
                   Wishes& wishes) {
    if (const auto answer = answerOfKey(event); answer && controls.question(session)) {
        controls.answer(*answer, session, wishes);
        return true;
    }
    const auto* const button = std::get_if<MouseButtonEvent>(&event);
    if (isHelpInFront(controls) && controls.isPanelOpen() && !controls.question(session) && button) {
        if (button->is_down) controls.act(Action::kHelp, session, wishes);  // the panel is back
        return true;
    }
    stage_.feed(event);
    if (const auto chosen = sessionOfKey(event, session)) {
        wishes.session = chosen;
        return true;
    }
    if (!isWanted(controls, session)) {
        stage_.dropInput();
        return false;
    }
    const bool is_keyboard =
        std::holds_alternative<KeyEvent>(event) || std::holds_alternative<TextEvent>(event);
    const bool wanted_keyboard = ImGui::GetIO().WantCaptureKeyboard;
    frame(0, controls, session, wishes);
    return is_keyboard ? wanted_keyboard : ImGui::GetIO().WantCaptureMouse;
}

bool Panel::isWanted(const ViewerControls& controls, const SessionView& session) const {
    if (!session.offered.empty() || controls.question(session)) return true;
    return !isHelpInFront(controls) && (controls.isPanelOpen() || lesson_.isOnScreen(session));
}

void Panel::layOut(ViewerControls& controls, const SessionView& session, Wishes& wishes) {
    lesson_.follow(session);
    controls.dropIdleQuestion(session);
    if (session.lesson) pictures_.follow(*session.lesson);
    if (wishes.next_trainee) lesson_.trainee.fill(0);
    if (wishes.write_note) remark_.wants_keyboard = true;
    if (wishes.write_note) remark_.place = wishes.note_place;
    if (wishes.type_trainee || wishes.next_trainee) lesson_.wants_keyboard = true;
    const bool is_open = controls.isPanelOpen();
    const bool was_drawn = std::exchange(is_drawn_, isWanted(controls, session));
    const bool is_new = (is_open && !was_open_) || (is_drawn_ && !was_drawn);
    const int frames = is_new ? kFramesToSettle : is_drawn_ ? 1 : 0;
    was_open_ = is_open;
    if (!is_open) is_ending_ = false;
    if (!is_drawn_) places_.clear();
    for (int i = 0; i < frames; ++i) frame(i + 1 == frames ? pending_seconds_ : 0, controls, session, wishes);
}

void Panel::frame(double seconds, ViewerControls& controls, const SessionView& session, Wishes& wishes) {
    stage_.begin(seconds);
    places_.clear();
    if (std::exchange(lesson_.leaves_keyboard, false) || std::exchange(remark_.leaves_keyboard, false))
        ImGui::SetWindowFocus(nullptr);
    const bool is_bare = isHelpInFront(controls);
    if (controls.isPanelOpen() && !is_bare)
        PanelContent(controls, session, wishes, places_, is_ending_, lesson_, remark_, pictures_.all(),
                     stage_.scale(), view_width_)
            .build();
    if (lesson_.isOnScreen(session) && !is_bare)
        LessonCards(controls, session, wishes, lesson_, places_, stage_.scale(), view_width_).build();
    if (!session.offered.empty()) buildSessionChoice(session, wishes, places_, stage_.scale());
    buildQuestion(controls, session, wishes, places_, stage_.scale(), view_width_);
    stage_.end();
}

std::optional<PixelPoint> Panel::find(const std::string& label) const {
    const auto place = places_.find(label);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
}

const ImDrawData* Panel::drawData() const {
    return is_drawn_ ? stage_.drawData() : nullptr;
}

}  // namespace bonemill
