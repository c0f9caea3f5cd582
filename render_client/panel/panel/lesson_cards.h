// What a lesson shows over the picture, as windows of ImGui: the task at its start, the summary at its end,
// and that the scene is about to change. It belongs to the render thread.
#pragma once

#include <map>
#include <string>

#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/panel/panel/panel_memory.h"

namespace bonemill {

class LessonCards {
  public:
    // Everything must outlive the object; the session has a lesson. `places` takes where each control is.
    LessonCards(ViewerControls& controls, const SessionView& session, Wishes& wishes, LessonDraft& draft,
                std::map<std::string, PixelPoint>& places, float scale, float view_width)
        : controls_(controls),
          session_(session),
          wishes_(wishes),
          draft_(draft),
          places_(places),
          scale_(scale),
          view_width_(view_width) {}

    // It is called between ImGui::NewFrame() and ImGui::Render().
    void build();

  private:
    void buildTop();
    void sayClock(double attempt_s);
    void buildSummary(const topics::Attempt& attempt);
    void buildHandle();
    bool nextButton(const char* label);
    bool button(const char* label);

    ViewerControls& controls_;
    const SessionView& session_;
    Wishes& wishes_;
    LessonDraft& draft_;
    std::map<std::string, PixelPoint>& places_;
    float scale_;
    float view_width_;  // pixels
};

}  // namespace bonemill
