// What the mouse does but to the view and the tool: it draws on the bone, and scrolls slices. It belongs to
// the render thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// Makes a stroke on the bone of the way that the mouse takes over a picture: the owner says what lies under
// the pixels on that way. Places are in W, m; pixels count from the picture's upper left.
class StrokePen {
  public:
    static constexpr double kPixelsApart = 3;    // of the places that the owner is asked for
    static constexpr double kApart = 0.5e-3;     // m: what is nearer to the last point is left out
    static constexpr double kMaxApart = 6e-3;    // m: farther away, another stroke begins
    static constexpr size_t kMaxStrokes = 8;     // of one drag
    static constexpr size_t kMaxPixels = 20000;  // of one drag

    void begin(const PixelPoint& at);
    void move(const PixelPoint& to);
    void end() { has_ended_ = has_ended_ || is_down_, is_down_ = false; }

    // Returns the pixels on the way since the last call.
    std::vector<PixelPoint> takeWay() { return std::exchange(way_, {}); }
    void add(const Eigen::Vector3d& p_W);
    // Nothing lies under a pixel: there the stroke is parted.
    void lift() { is_lifted_ = true; }
    // Returns the points of the stroke that is being drawn; none when nothing is.
    const std::vector<Eigen::Vector3d>& points() const;
    // Returns the orders that show it to everyone, after the drag has ended and its way was taken; mostly
    // none.
    std::vector<topics::Command> takeOrders(const std::string& author);

  private:
    std::vector<std::vector<Eigen::Vector3d>> strokes_;
    std::vector<PixelPoint> way_;
    PixelPoint last_;
    size_t pixels_ = 0;
    bool is_down_ = false, has_ended_ = false, is_lifted_ = true;
};

// Returns the colour (0xRRGGBB) in which this author draws: the same for everyone and always.
uint32_t colourOfAuthor(const std::string& author);

// Returns every second point, and again, until there are no more than kMaxRemarkPoints; the ends stay.
std::vector<Eigen::Vector3d> thinned(std::vector<Eigen::Vector3d> points);

// Over the panes with slices through the scan the wheel scrolls the pane that the cursor is over, left drag
// changes window (right is wider) and level (down is higher), right drag zooms (up is larger), and a double
// click goes back to how it was at the start.
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
