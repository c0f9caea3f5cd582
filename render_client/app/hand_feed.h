// The tool in this viewer's mouse: begins to hold it, tells the device where it is wanted, and lets the
// user see how. It belongs to the thread of the OpenGL context.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "render_client/controls/viewer_controls.h"
#include "render_client/scene/render_scene.h"
#include "render_client/subscribe/scene_subscriber.h"

namespace bonemill {

class HandFeed {
  public:
    using Clock = std::chrono::steady_clock;

    // Everything must outlive the feed. With `begins_by_itself` the tool is held as soon as it can be, also
    // where the session says nothing of its device; otherwise only where it says that this is a mouse.
    HandFeed(ViewerControls& controls, RenderScene& scene, SceneSubscriber& subscriber, bool begins_by_itself)
        : controls_(controls), scene_(scene), subscriber_(subscriber), begins_by_itself_(begins_by_itself) {}

    // Once per picture, before its events: the mouse means what the user has seen.
    void lookAt(int width, int height);
    // Once per picture, after its events; `begin` says that the user asks for the tool now. Returns why the
    // tool that was to be held by itself is not, a sentence for the user; mostly empty.
    std::string update(const SessionView& session, bool begin, Clock::time_point now);

  private:
    bool isOffered(const SessionView& session);
    void begin(bool is_at_cursor, Clock::time_point now);
    Eigen::Vector3d surfaceInView(bool is_at_cursor) const;
    void tellDevice();
    void showHand(const SessionView& session, Clock::time_point now);

    ViewerControls& controls_;
    RenderScene& scene_;
    SceneSubscriber& subscriber_;
    const bool begins_by_itself_;
    PictureView view_;
    uint64_t offered_epoch_ = 0;  // run of the server in which the tool was offered last
    bool shows_model_ = false;    // the picture before showed the whole model
    bool was_holding_ = false;
    Clock::time_point begun_;                   // the hold
    std::optional<Clock::time_point> started_;  // the first picture
};

}  // namespace bonemill
