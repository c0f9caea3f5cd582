// Knows where the controls of a running session's window are: a panel of its own that hears the same session.
#pragma once

#include <optional>
#include <string>

#include "common/base/user_error.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/support/controlled_panel.h"

namespace bonemill::test {

// The window is one that `bonemill start` opens, of this size (pixels) on a display of the usual scale. What
// stands below what changes by itself (faults, attempts of before) is found where both panels are scrolled to
// their end.
class LessonTwin : ControlledPanel {
  public:
    LessonTwin(uint32_t domain, uint32_t session, int width, int height);

    // Takes what has come from the session.
    void look();
    // Returns where the control can be clicked, as the session is known by now; nothing if it cannot be seen.
    std::optional<PixelPoint> find(const std::string& label);
    void openPanel() { switchPanel(); }
    // The mouse's wheel turns so often, towards the panel's end, while the mouse is at that place.
    void scroll(const PixelPoint& mouse, int turns);

    void setClassFolder(const std::string& folder) { session_.class_folder = folder; }
    // The window shows this invitation.
    void setInvitation(const Invitation& invitation) { session_.invitation = invitation; }

    const topics::Lesson* lesson() const { return session_.lesson; }
    const topics::Status& status() const { return status_; }

  private:
    SceneSubscriber subscriber_;
    const std::vector<PastAttempt> past_;
    int width_, height_;
};

}  // namespace bonemill::test
