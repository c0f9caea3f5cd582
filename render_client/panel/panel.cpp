#include "render_client/panel/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/hud/font_files.h"
#include "render_client/panel/lesson_cards.h"
#include "render_client/panel/panel_content.h"
#include "render_client/panel/question_box.h"
#include "render_client/panel/session_choice.h"

namespace bonemill {
namespace {

constexpr float kFontPixels = 14;        // at scale 1
constexpr double kShortestFrame = 1e-4;  // s; ImGui wants time to pass
constexpr int kFramesToSettle = 3;       // until ImGui knows how large its contents are
constexpr float kFarAway = -1e6f;        // where no mouse is
constexpr ImWchar kSigns[] = {0x20, 0xff, 0x2013, 0x2013, 0x2026, 0x2026, 0};

constexpr struct {
    ImGuiKey_ imgui;
    Key key;
} kEditingKeys[] = {
    {ImGuiKey_Tab, Key::kTab},     {ImGuiKey_LeftArrow, Key::kLeft}, {ImGuiKey_RightArrow, Key::kRight},
    {ImGuiKey_UpArrow, Key::kUp},  {ImGuiKey_DownArrow, Key::kDown}, {ImGuiKey_Home, Key::kHome},
    {ImGuiKey_End, Key::kEnd},     {ImGuiKey_Delete, Key::kDelete},  {ImGuiKey_Backspace, Key::kBackspace},
    {ImGuiKey_Enter, Key::kEnter}, {ImGuiKey_Escape, Key::kEscape},  {ImGuiKey_A, keyOf('A')},
    {ImGuiKey_C, keyOf('C')},      {ImGuiKey_V, keyOf('V')},         {ImGuiKey_X, keyOf('X')},
    {ImGuiKey_Y, keyOf('Y')},      {ImGuiKey_Z, keyOf('Z')},
};

void holdModifiers(const Modifiers& held) {
    ImGui::GetIO().KeyShift = held.shift;
    ImGui::GetIO().KeyCtrl = held.control;
}

void moveMouse(const PixelPoint& to) {
    ImGui::GetIO().MousePos = ImVec2(float(to.x), float(to.y));
}

ImGuiStyle makeStyle(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 6;
    style.FrameRounding = 3;
    style.WindowBorderSize = 0;
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.03f, 0.045f, 0.06f, 0.9f);
    style.ScaleAllSizes(scale);
    return style;
}

// The help page takes the place of the panel and of what a lesson shows.
bool isHelpInFront(const ViewerControls& controls) {
    return controls.settings().show_help && controls.settings().show_hud;
}

}  // namespace

void Panel::Destroy::operator()(ImGuiContext* context) const {
    ImGui::DestroyContext(context);
}

Panel::Panel() : context_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(context_.get());
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is left on the disk
    io.ConfigInputTextCursorBlink = false;
    io.MousePos = ImVec2(kFarAway, kFarAway);
    for (const auto& editing : kEditingKeys) io.KeyMap[editing.imgui] = int(editing.key);
    setScale(1);
}

Panel::~Panel() = default;

void Panel::setScale(float scale) {
    if (scale == scale_) return;
    const std::string font = fontFile(FontStyle::kPlain);
    scale_ = scale;
    ImGui::SetCurrentContext(context_.get());
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    fonts.AddFontFromFileTTF(font.c_str(), std::round(kFontPixels * scale), nullptr, kSigns);
    fonts.Build();
    ImGui::GetStyle() = makeStyle(scale);
    ++font_version_;
}

Panel::FontPixels Panel::fontPixels() const {
    ImGui::SetCurrentContext(context_.get());
    unsigned char* pixels = nullptr;
    FontPixels font{nullptr, 0, 0, font_version_};
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &font.width, &font.height);
    font.pixels = pixels;
    return font;
}

void Panel::setPicture(int width, int height, int view_width, float scale, double seconds) {
    view_width_ = float(view_width);
    setScale(scale);
    ImGui::SetCurrentContext(context_.get());
    ImGui::GetIO().DisplaySize = ImVec2(float(width), float(height));
    pending_seconds_ = seconds;
}

void Panel::feed(const WindowEvent& event) {
    ImGui::SetCurrentContext(context_.get());
    ImGuiIO& io = ImGui::GetIO();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        holdModifiers(key->held);
        io.KeysDown[size_t(key->key)] = key->is_down;
    } else if (const auto* text = std::get_if<TextEvent>(&event)) {
        io.AddInputCharacter(text->sign);
    } else if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        holdModifiers(button->held);
        moveMouse(button->at);
        io.MouseDown[size_t(button->button)] = button->is_down;
    } else if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        moveMouse(move->to);
    } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
        io.MouseWheel += float(scroll->steps);
    }
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
    feed(event);
    if (const auto chosen = sessionOfKey(event, session)) {
        wishes.session = chosen;
        return true;
    }
    if (!isWanted(controls, session)) {
        ImGui::GetIO().MouseWheel = 0;
        ImGui::GetIO().ClearInputCharacters();
        return false;
    }
    const bool is_keyboard =
        std::holds_alternative<KeyEvent>(event) || std::holds_alternative<TextEvent>(event);
    const bool wanted_keyboard = ImGui::GetIO().WantCaptureKeyboard;
    frame(kShortestFrame, controls, session, wishes);
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
    ImGui::SetCurrentContext(context_.get());
    ImGui::GetIO().DeltaTime = float(std::max(seconds, kShortestFrame));
    ImGui::NewFrame();
    places_.clear();
    if (std::exchange(lesson_.leaves_keyboard, false) || std::exchange(remark_.leaves_keyboard, false))
        ImGui::SetWindowFocus(nullptr);
    const bool is_bare = isHelpInFront(controls);
    if (controls.isPanelOpen() && !is_bare)
        PanelContent(controls, session, wishes, places_, is_ending_, lesson_, remark_, pictures_.all(),
                     scale_, view_width_)
            .build();
    if (lesson_.isOnScreen(session) && !is_bare)
        LessonCards(controls, session, wishes, lesson_, places_, scale_, view_width_).build();
    if (!session.offered.empty()) buildSessionChoice(session, wishes, places_, scale_);
    buildQuestion(controls, session, wishes, places_, scale_, view_width_);
    ImGui::Render();
}

std::optional<PixelPoint> Panel::find(const std::string& label) const {
    const auto place = places_.find(label);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
}

const ImDrawData* Panel::drawData() const {
    ImGui::SetCurrentContext(context_.get());
    return is_drawn_ ? ImGui::GetDrawData() : nullptr;
}

}  // namespace bonemill
