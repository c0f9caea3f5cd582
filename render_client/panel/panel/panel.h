// The control panel has every setting of the view, the session's commands and who is watching, for the mouse.
//
// The panel is a function of what is set and what the server says. It keeps nothing but what is folded,
// scrolled, half typed or half confirmed (the end of the session), so it follows whoever changed something.
// It needs no OpenGL; PanelPainter draws it. Positions are pixels from the picture's upper left corner. It
// belongs to the render thread.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/panel/imgui/imgui_stage.h"
#include "render_client/panel/panel/panel_memory.h"
#include "render_client/panel/panel/plot_history.h"

namespace bonemill {

// Several sessions are there and none was asked for: the user chooses one, as a window of ImGui. It
// is called between ImGui::NewFrame() and ImGui::Render(). `places` takes where each control is.
void buildSessionChoice(const SessionView& session, Wishes& wishes, std::map<std::string, PixelPoint>& places,
                        float scale);

// Returns the session that this key chooses, 1 the first that is offered; none if it chooses none.
std::optional<uint32_t> sessionOfKey(const WindowEvent& event, const SessionView& session);

class Panel {
  public:
    // Throws UserError (font).
    Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;
    ~Panel();

    // Takes the size (pixels) of the picture to come, how much of its width the view of the bone has, beside
    // which nothing but the button is put that opens the panel, how much larger than usual its text is, and
    // the time (s) since the picture before. It is called before the events of the picture.
    void setPicture(int width, int height, int view_width, float scale, double seconds);
    // Passes an event on to the panel, which changes settings and wishes. Returns true when the event was
    // meant for the panel alone.
    bool handle(const WindowEvent& event, ViewerControls& controls, const SessionView& session,
                Wishes& wishes);
    // Brings the panel up to date with the settings and the session, to be drawn.
    void layOut(ViewerControls& controls, const SessionView& session, Wishes& wishes);

    // Returns where to click on the button, box or slider with this label, if it can be seen.
    std::optional<PixelPoint> find(const std::string& label) const;

    // Which parts are open is the owner's to remember.
    const PanelFolds& folds() const { return folds_; }
    void fold(const PanelFolds& folds) { folds_ = folds; }

    // Returns what to draw; null while the panel is closed and no lesson shows anything. It is valid until
    // the next call of setPicture() or handle().
    const ImDrawData* drawData() const;
    ImGuiStage::FontPixels fontPixels() const { return stage_.fontPixels(); }
    // What the drawing names by a texture's number that is not 0 is the picture of this number.
    const std::map<std::string, ScenePicture>& pictures() const { return pictures_.all(); }

  private:
    void frame(double seconds, ViewerControls& controls, const SessionView& session, Wishes& wishes);
    bool isWanted(const ViewerControls& controls, const SessionView& session) const;

    ImGuiStage stage_;
    std::map<std::string, PixelPoint> places_;  // of the controls that can be seen, by label
    float view_width_ = 0;
    double pending_seconds_ = 0;
    bool was_open_ = false;
    bool is_drawn_ = false;   // the panel, or something else
    bool is_ending_ = false;  // the session's end was asked for and waits to be confirmed
    LessonDraft lesson_;
    RemarkDraft remark_;
    InviteDraft invite_;
    TuningDraft tuning_;
    WhatIfDraft what_if_;
    PanelFolds folds_;
    ScenePictures pictures_;
    PlotHistory plots_;
};

// Draws the control panel over a finished picture, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. Leaves blending
// and scissors off.
class PanelPainter {
  public:
    // Throws GlError.
    explicit PanelPainter(const GlApi& gl) : gl_(gl), painter_(gl) {}

    // Draws into the bound framebuffer of this size (pixels). A closed panel draws nothing.
    void paint(const Panel& panel, int width, int height);

  private:
    void uploadPictures(const Panel& panel);

    const GlApi& gl_;
    ImGuiPainter painter_;
    std::map<int, GlTexture> pictures_;  // by number
};

}  // namespace bonemill
