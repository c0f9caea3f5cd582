// The mouse does this to the panes with slices through the scan. It belongs to the render thread. Never
// throws.
#pragma once

#include <optional>

#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/panes.h"

namespace bonemill {

// The wheel scrolls the pane that the cursor is over, left drag changes window (right is wider) and level
// (down is higher), right drag zooms (up is larger), and a double click goes back to how it was at the start.
class PaneMouse {
  public:
    // Nothing: no panes are shown, or they show no scan.
    void lookAt(std::optional<SeenPanes> seen) { seen_ = std::move(seen); }

    // Returns true when the event was meant for a pane and nobody else is to act on it. While something else
    // is dragged, moves and releases are not.
    bool handle(const WindowEvent& event, bool is_other_drag, SliceSettings& settings);

  private:
    bool onButton(const MouseButtonEvent& event, SliceSettings& settings);
    bool onMove(const MouseMoveEvent& event, bool is_other_drag, SliceSettings& settings);
    bool onScroll(const ScrollEvent& event, SliceSettings& settings) const;
    const Pane* paneAt(const PixelPoint& at) const;

    std::optional<SeenPanes> seen_;
    PixelPoint mouse_{-1, -1};
    std::optional<MouseButton> dragged_;
    std::optional<MouseButtonEvent> last_click_;
};

}  // namespace bonemill
