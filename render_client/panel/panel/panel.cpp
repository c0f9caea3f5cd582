#include "render_client/panel/panel/panel.h"

#include <imgui.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/language/language.h"
#include "render_client/panel/panel/hand_card.h"
#include "render_client/panel/panel/lesson_cards.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr float kChoiceHeight = 0.82f;  // of the picture: below the page that says what the viewer waits for

// A question to the user in the middle of the picture, as a window of ImGui. It stands until it is answered:
// Enter means yes, Esc no. It belongs to the render thread.
constexpr float kQuestionWidth = 400, kNarrowest = 240;  // pixels at scale 1

// The panel stays free, for who answers by the same button once more, unless the picture is too narrow.
float freeWidth(const ViewerControls& controls, float picture_width, float scale) {
    const float panel = (PanelContent::kWidth + 2 * PanelContent::kMargin) * scale;
    const bool is_free = controls.isPanelOpen() && picture_width - panel >= kNarrowest * scale;
    return is_free ? picture_width - panel : picture_width;
}

bool isAnswered(const std::string& label, std::map<std::string, PixelPoint>& places) {
    const bool is_pressed = ImGui::Button(label.c_str());
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    places[label] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
    return is_pressed;
}

// Is called between ImGui::NewFrame() and ImGui::Render(), last of all windows; draws nothing while no
// question stands. `places` takes where each answer is.
void buildQuestion(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                   std::map<std::string, PixelPoint>& places, float scale, float view_width) {
    using Answer = ViewerControls::Answer;
    const std::optional<Question> question = controls.question(session);
    if (!question) return;
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    const float space = freeWidth(controls, view_width, scale);
    const float width = std::min(kQuestionWidth * scale, space - PanelContent::kMargin * scale);
    ImGui::SetNextWindowPos(ImVec2(space / 2, picture.y / 2), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, picture.y));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(16 * scale, 14 * scale));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.0f, scale));
    ImGui::PushStyleColor(ImGuiCol_Border, ImVec4(0.95f, 0.75f, 0.3f, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImVec4(0.06f, 0.08f, 0.1f, 1));
    ImGui::Begin("##question", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    ImGui::PushTextWrapPos();
    ImGui::TextUnformatted(question->text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy(ImVec2(0, 6 * scale));
    std::optional<Answer> answer;
    if (isAnswered(question->yes + tr(" (Enter)"), places)) answer = Answer::kYes;
    ImGui::SameLine();
    if (isAnswered(question->no + tr(" (Esc)"), places)) answer = Answer::kNo;
    if (question->offers_checkpoint) {
        ImGui::SameLine();
        if (isAnswered(tr("Save a checkpoint first"), places)) answer = Answer::kSaveFirst;
    }
    ImGui::End();
    ImGui::PopStyleColor(2);
    ImGui::PopStyleVar(2);
    if (answer) controls.answer(*answer, session, wishes);
}

// Returns the answer that a key gives.
std::optional<ViewerControls::Answer> answerOfKey(const WindowEvent& event) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (!key || !key->is_down || key->is_repeat) return std::nullopt;
    if (key->key == Key::kEnter) return ViewerControls::Answer::kYes;
    if (key->key == Key::kEscape) return ViewerControls::Answer::kNo;
    return std::nullopt;
}

constexpr int kFramesToSettle = 3;  // until ImGui knows how large its contents are
// The help page takes the place of the panel and of what a lesson shows.
bool isHelpInFront(const ViewerControls& controls) {
    return controls.settings().show_help && controls.settings().show_hud;
}

}  // namespace

void PanelPainter::uploadPictures(const Panel& panel) {
    std::set<int> wanted;
    for (const auto& [id, picture] : panel.pictures()) {
        if (picture.number == 0) continue;
        wanted.insert(picture.number);
        if (pictures_.contains(picture.number)) continue;
        GlTexture& texture = pictures_.try_emplace(picture.number, gl_).first->second;
        gl_.BindTexture(GL_TEXTURE_2D, texture.name());
        gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.pixels.width, picture.pixels.height, 0, GL_RGBA,
                       GL_UNSIGNED_BYTE, picture.pixels.rgba.data());
        gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
    }
    std::erase_if(pictures_, [&](const auto& entry) { return !wanted.contains(entry.first); });
}

void PanelPainter::paint(const Panel& panel, int width, int height) {
    const ImDrawData* const drawing = panel.drawData();
    if (!drawing) return;
    gl_.ActiveTexture(GL_TEXTURE0);
    uploadPictures(panel);
    ImGuiTextures textures;
    for (const auto& [number, texture] : pictures_) textures[number] = texture.name();
    painter_.paint(*drawing, panel.fontPixels(), textures, width, height);
}

void buildSessionChoice(const SessionView& session, Wishes& wishes, std::map<std::string, PixelPoint>& places,
                        float scale) {
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(picture.x / 2, picture.y * kChoiceHeight), ImGuiCond_Always,
                            ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(picture.x * 0.9f, picture.y * 0.3f));
    ImGui::Begin("##sessions", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    ImGui::TextUnformatted(tr("There are several sessions. Click one, or press its number:"));
    ImGui::Dummy(ImVec2(0, 2 * scale));
    for (size_t n = 0; n < session.offered.size(); ++n) {
        const std::string label = std::to_string(n + 1) + "   " + session.offered[n].text;
        if (ImGui::Button(label.c_str())) wishes.session = session.offered[n].number;
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        places[session.offered[n].text] = {low.x + (high.y - low.y) / 2, (low.y + high.y) / 2};
    }
    ImGui::End();
}

std::optional<uint32_t> sessionOfKey(const WindowEvent& event, const SessionView& session) {
    const auto* const key = std::get_if<KeyEvent>(&event);
    if (!key || !key->is_down) return std::nullopt;
    const int n = int(key->key) - int(keyOf('1'));
    if (n < 0 || n > 8 || size_t(n) >= session.offered.size()) return std::nullopt;
    return session.offered[size_t(n)].number;
}

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
    return !isHelpInFront(controls) &&
           (controls.isPanelOpen() || lesson_.isOnScreen(session) || isHandCardOnScreen(session));
}

void Panel::layOut(ViewerControls& controls, const SessionView& session, Wishes& wishes) {
    plots_.update(session);
    lesson_.follow(session);
    controls.dropIdleQuestion(session);
    pictures_.follow(session);
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
        PanelContent(controls, session, wishes, places_, is_ending_, lesson_, remark_, invite_, tuning_,
                     what_if_, folds_, pictures_.all(), plots_, stage_.scale(), view_width_)
            .build();
    if (lesson_.isOnScreen(session) && !is_bare)
        LessonCards(controls, session, wishes, lesson_, places_, stage_.scale(), view_width_).build();
    if (isHandCardOnScreen(session) && !is_bare)
        buildHandCard(controls, session, wishes, places_, stage_.scale(),
                      freeWidth(controls, view_width_, stage_.scale()));
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
