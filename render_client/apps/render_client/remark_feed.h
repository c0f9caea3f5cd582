// What people write and draw: makes strokes and the places of notes of what the mouse does over the last
// picture, and tells of what others write. It belongs to the thread of the OpenGL context.
#pragma once

#include <optional>

#include "render_client/hand/controls/viewer_controls.h"
#include "render_client/look/render_scene/render_scene.h"

namespace bonemill {

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
