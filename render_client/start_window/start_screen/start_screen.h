// The screen of the window to begin in: at the left how one starts, in the middle a card for each scene, at
// the right what was and what is in the network, and how this PC is.
//
// It needs no OpenGL; StartPainter draws it. Positions are pixels from the picture's upper left corner. It
// belongs to the render thread.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "render_client/hand/controls/window_event.h"
#include "render_client/panel/imgui/control_places.h"
#include "render_client/panel/imgui/imgui_stage.h"
#include "render_client/start_window/start_desk/start_desk.h"
#include "render_client/start_window/start_screen/card_pictures.h"

struct ImVec2;
struct ImVec4;

namespace bonemill {

class StartScreen {
  public:
    // The desk must outlive it. Throws UserError (font).
    explicit StartScreen(StartDesk& desk);

    ImGuiStage& stage() { return stage_; }
    const ImGuiStage& stage() const { return stage_; }
    // Takes the size (pixels) of the picture to come, and how much larger than usual its text is. It is
    // called before the events of the picture.
    void setPicture(int width, int height, float scale);
    void handle(const WindowEvent& event);
    // Brings the screen up to date with the desk; `seconds` have gone by since the picture before.
    void layOut(double seconds);

    // Returns where to click on the control with this label, if it can be seen; a card's is its scene's name.
    std::optional<PixelPoint> find(const std::string& label) const;
    const CardPictures& pictures() const { return pictures_; }

  private:
    void frame(double seconds);
    void buildAll();
    void buildCards();
    void buildCard(const SceneCard& card, const ImVec2& size);
    void drawCard(const SceneCard& card, const ImVec2& low, const ImVec2& size, bool is_lit);
    void buildFoot();
    void buildWaiting();
    // start_choices.cpp
    void buildChoices();
    void buildHands();
    void buildCompany();
    void buildPast();
    void buildOthers();
    void buildThisPc();
    void buildLanguages();
    void buildPart(const char* part, const char* title);
    void buildHandsState();
    void buildCommand(const std::string& command);
    bool button(const std::string& label, const std::string& id = "");
    bool choice(const std::string& label, bool is_chosen);
    template <size_t Size>
    bool isTyped(const char* label, const char* hint, std::array<char, Size>& text);
    static void heading(const char* text);
    static void say(const std::string& text);
    static void say(const std::string& text, const ImVec4& colour);

    StartDesk& desk_;
    ImGuiStage stage_;
    ControlPlaces places_;
    CardPictures pictures_;
    std::string problem_;  // of this screen; empty: none
    int width_ = 1, height_ = 1;
    std::array<char, 128> host_{}, class_{};  // as typed so far, zero-terminated
};

}  // namespace bonemill
