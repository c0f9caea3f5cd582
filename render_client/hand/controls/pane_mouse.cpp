#include "render_client/hand/controls/pane_mouse.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/look/slices/grey_window.h"

namespace bonemill {
namespace {

constexpr double kZoomPerPane = 8;            // factor of a drag over the pane's height
constexpr double kPaneDoubleClickTime = 0.4;  // s
constexpr double kPaneDoubleClickRadius = 6;  // pixels

}  // namespace

const Pane* PaneMouse::paneAt(const PixelPoint& at) const {
    if (!seen_) return nullptr;
    for (const Pane& pane : seen_->panes)
        if (pane.rect.holds(at.x, at.y)) return &pane;
    return nullptr;
}

bool PaneMouse::handle(const WindowEvent& event, bool is_other_drag, SliceSettings& settings) {
    if (const auto* button = std::get_if<MouseButtonEvent>(&event))
        return (!is_other_drag || dragged_) && onButton(*button, settings);
    if (const auto* move = std::get_if<MouseMoveEvent>(&event)) return onMove(*move, is_other_drag, settings);
    if (const auto* scroll = std::get_if<ScrollEvent>(&event)) return onScroll(*scroll, settings);
    return false;
}

bool PaneMouse::onButton(const MouseButtonEvent& event, SliceSettings& settings) {
    mouse_ = event.at;
    if (!event.is_down) {
        if (dragged_ != event.button) return dragged_.has_value();
        dragged_.reset();
        return true;
    }
    const Pane* const pane = paneAt(event.at);
    if (!pane || dragged_) return dragged_.has_value();
    dragged_ = event.button;
    if (event.button != MouseButton::kLeft) return true;
    const auto first = std::exchange(last_click_, event);
    if (first && event.time - first->time < kPaneDoubleClickTime &&
        std::hypot(event.at.x - first->at.x, event.at.y - first->at.y) < kPaneDoubleClickRadius) {
        settings.positions[pane->axis].reset();
        settings.window.reset();
        settings.zoom = 1;
        last_click_.reset();
    }
    return true;
}

bool PaneMouse::onMove(const MouseMoveEvent& event, bool is_other_drag, SliceSettings& settings) {
    const PixelPoint from = std::exchange(mouse_, event.to);
    if (!dragged_) return !is_other_drag && paneAt(event.to);
    if (!seen_) return true;
    const double edge = seen_->panes[0].rect.height;
    const double right = (event.to.x - from.x) / edge, down = (event.to.y - from.y) / edge;
    if (*dragged_ == MouseButton::kLeft)
        settings.window = draggedWindow(settings.window.value_or(seen_->window), seen_->grid, right, down);
    if (*dragged_ == MouseButton::kRight)
        settings.zoom =
            std::clamp(settings.zoom * std::pow(kZoomPerPane, -down), 1.0, SliceSettings::kMaxZoom);
    return true;
}

bool PaneMouse::onScroll(const ScrollEvent& event, SliceSettings& settings) const {
    const Pane* const pane = paneAt(mouse_);
    if (!pane) return false;
    std::optional<double>& position = settings.positions[pane->axis];
    const double moved = position.value_or(pane->position_W) + event.steps * pane->slice_step;
    position = std::clamp(moved, pane->first_slice_W, pane->last_slice_W);
    return true;
}

}  // namespace bonemill
