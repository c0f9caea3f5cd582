// What the user does in the picture with the mouse. It belongs to the thread of the OpenGL context.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "render_client/hand/controls/tool_hold.h"
#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/look/render_scene/render_scene.h"

namespace bonemill {

// The tool in this viewer's mouse: begins to hold it, tells the device where it is wanted, and lets the
// user see how. In another scene and in a new attempt, which begin with the tool elsewhere, the hold rests
// until the bone is there.
class HandFeed {
  public:
    using Clock = std::chrono::steady_clock;

    // Everything must outlive the feed. With `begins_by_itself` the tool is held as soon as it can be, also
    // where the session says nothing of its device; otherwise only where it says that this is a mouse.
    HandFeed(ViewerControls& controls, RenderScene& scene, SceneSubscriber& subscriber, bool begins_by_itself)
        : controls_(controls), scene_(scene), subscriber_(subscriber), begins_by_itself_(begins_by_itself) {}

    // Once per picture, before its events: the mouse means what the user has seen.
    void lookAt(int width, int height);
    // Once per picture, after its events; `begin` says that the user asks for the tool now. Returns what the
    // user should notice; mostly nothing.
    std::optional<HudNotice> update(const SessionView& session, bool begin, Clock::time_point now);

  private:
    void rest(const SessionView& session, Clock::time_point now);
    bool takesOver(const SessionView& session);
    bool isOffered(const SessionView& session, bool has_seen_bone);
    bool goesOn(bool has_seen_bone, Clock::time_point now) const;
    std::optional<HudNotice> watch(const SessionView& session, Clock::time_point now);
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
    bool has_taken_over_ = false;  // from a scripted hand, as this viewer has asked
    uint64_t seen_epoch_ = 0;
    int64_t seen_attempt_ns_ = 0;                  // start of the newest attempt
    std::optional<Clock::time_point> goes_on_at_;  // the hold that rests in a new scene or attempt
    uint32_t placements_ = 0;                      // that the device was asked for
    HoldMonitor watch_;
    Clock::time_point begun_;                   // the hold
    std::optional<Clock::time_point> started_;  // the first picture
    std::optional<Clock::time_point> milled_;   // first, in the mouse
};

// What people write and draw: makes strokes and the places of notes of what the mouse does over the last
// picture, and tells of what others write.
class RemarkFeed {
  public:
    // Both must outlive the feed.
    RemarkFeed(ViewerControls& controls, RenderScene& scene) : controls_(controls), scene_(scene) {}

    // Once per picture, after its events and before the wishes are carried out. Returns what the user should
    // notice: a note that another person wrote just now.
    std::optional<HudNotice> update(const SessionView& session, Wishes& wishes);

  private:
    void draw(const SessionView& session, Wishes& wishes);
    std::optional<HudNotice> news(const SessionView& session);

    ViewerControls& controls_;
    RenderScene& scene_;
    uint64_t seen_epoch_ = 0;
    uint32_t seen_number_ = 0;  // the highest one, in that run of the server
};

}  // namespace bonemill
