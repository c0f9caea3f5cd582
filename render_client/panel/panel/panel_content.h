// The control panel says and offers this, as one frame of ImGui. It belongs to the render thread.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/config/live_fields.h"
#include "proto/topics.pb.h"
#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/panel/panel/panel_memory.h"
#include "render_client/panel/panel/plot_history.h"

namespace bonemill {

// What is tuned and the accuracy in force, as a scene file says them; empty if that can say nothing.
std::string sceneTextOf(const topics::Status& status);

class PanelContent {
  public:
    // Pixels at scale 1: the panel's width, and its distance to the picture's edge.
    static constexpr float kWidth = 330, kMargin = 14;

    // Everything must outlive the object. `places` takes where each control is; `is_ending` says whether the
    // end of the session waits to be confirmed.
    PanelContent(ViewerControls& controls, const SessionView& session, Wishes& wishes,
                 std::map<std::string, PixelPoint>& places, bool& is_ending, LessonDraft& draft,
                 RemarkDraft& remark_draft, InviteDraft& invite_draft, TuningDraft& tuning_draft,
                 WhatIfDraft& what_if_draft, PanelFolds& folds,
                 const std::map<std::string, ScenePicture>& pictures, const PlotHistory& plots, float scale,
                 float view_width)
        : controls_(controls),
          settings_(controls.settings()),
          session_(session),
          wishes_(wishes),
          places_(places),
          is_ending_(is_ending),
          draft_(draft),
          remark_draft_(remark_draft),
          invite_draft_(invite_draft),
          tuning_draft_(tuning_draft),
          what_if_draft_(what_if_draft),
          folds_(folds),
          pictures_(pictures),
          plots_(plots),
          scale_(scale),
          view_width_(view_width) {}

    // It is called between ImGui::NewFrame() and ImGui::Render().
    void build();

  private:
    // These say what is seen (panel_view.cpp).
    void buildView();
    void buildHold();
    void buildSides();
    bool hasPatientAxes() const;
    void buildTransparency();
    void buildCuts();
    void buildScan();
    void buildStereo();
    void buildSigns();
    void buildQualityPick();
    void buildReading();
    void buildLanguages();
    // These say which structures are seen, and how (panel_view.cpp).
    bool hasStructures() const;
    void buildStructures();
    bool hasEffects() const;
    bool isListed(ViewerEffect effect) const;
    void buildEffects();
    // These teach (panel_lesson.cpp).
    void buildLesson();
    std::string title() const;
    void buildTrainee(const topics::Lesson& lesson);
    void startAttempt(const topics::Lesson& lesson);
    void buildScene(const topics::Lesson& lesson, const topics::SceneChoice& scene);
    bool isRowClicked(const std::string& name);
    void buildAttempts(const topics::Lesson& lesson);
    void buildAttempt(const topics::Lesson& lesson, const topics::Attempt& attempt);
    // These lead to attempts of before (panel_past.cpp).
    void buildPast();
    void buildPastAttempt(const PastAttempt& attempt, const std::string& number);
    void showPicture(const std::string& name, float size);
    // These lead a replay, and compare it (panel_replay.cpp).
    void buildReplay();
    void buildComparison();
    void buildCompared(const topics::Comparison& comparison);
    void buildLegend(uint32_t first);
    // Lets it go on otherwise (panel_what_if.cpp).
    void buildWhatIf();
    // These say how the session goes (panel_session.cpp).
    void buildSession();
    void buildCheckpoints();
    void buildTools();
    void buildAccuracy();
    void buildEnd();
    void buildTraining();
    void buildFaults();
    void buildPlots();
    void buildPlot(const char* name, const PlotHistory::Curve& curve, double limit, const char* unit);
    void buildWatchers();
    // These tune the contact law (panel_tuning.cpp).
    void buildTuning();
    void buildTuned(const LiveField& field);
    void tune(const scene::Tuning& tuning);
    // Lets people from elsewhere in (panel_invite.cpp).
    void buildInvite();
    void buildInvitation();
    void drawCode();
    // These are about what people write and draw (panel_session.cpp).
    void buildRemarks();
    void buildNote();
    void sendNote();
    void buildRemark(const topics::Remark& remark);

    // Draws the headline of a part of the panel, which a click folds. Returns true where it is open.
    bool isPartOpen(const char* name, bool is_open_at_first);
    // Each control has a label, and says what it does in words while the mouse rests on it.
    bool button(const std::string& label, const char* what);
    bool box(const std::string& label, bool is_on, const char* what);
    bool choice(const std::string& label, bool is_chosen, const char* what);
    // Returns the fraction that it was moved to, at least `least`.
    std::optional<double> slider(const char* label, double fraction, double least, const char* what);
    // These controls do what a key does; the key stands beside the text.
    void button(const char* text, Action action, const char* what);
    // Stands beside the control before it, or below it where there is no room.
    void buttonBeside(const char* text, Action action, const char* what);
    void box(const char* text, Action action, bool is_on, const char* what);
    void note(const std::string& label, const char* what);
    void explain(const std::string& text);

    void gap();
    void sayQuietly(const std::string& text);
    void say(const std::string& text, HudTone tone);
    void sayWrapped(const std::string& text, HudTone tone);
    void send(const topics::Command& command) { controls_.request(command, session_, wishes_); }
    void act(Action action) { controls_.act(action, session_, wishes_); }

    ViewerControls& controls_;
    const ViewSettings& settings_;
    const SessionView& session_;
    Wishes& wishes_;
    std::map<std::string, PixelPoint>& places_;
    bool& is_ending_;
    LessonDraft& draft_;
    RemarkDraft& remark_draft_;
    InviteDraft& invite_draft_;
    TuningDraft& tuning_draft_;
    WhatIfDraft& what_if_draft_;
    PanelFolds& folds_;
    const std::map<std::string, ScenePicture>& pictures_;
    const PlotHistory& plots_;
    float scale_;
    float view_width_;  // pixels
};

}  // namespace bonemill
