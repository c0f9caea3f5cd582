#include "render_client/hand/controls/mouse_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/dds/remark_bounds.h"
#include "render_client/look/slices/slice_image.h"

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

void StrokePen::begin(const PixelPoint& at) {
    *this = {};
    is_down_ = true;
    way_.push_back(last_ = at);
}

void StrokePen::move(const PixelPoint& to) {
    if (!is_down_) return;
    const double right = to.x - last_.x, down = to.y - last_.y;
    const int steps = int(std::min(std::hypot(right, down) / kPixelsApart, double(kMaxPixels)));
    for (int n = 1; n <= steps && pixels_ < kMaxPixels; ++n, ++pixels_)
        way_.push_back({last_.x + right * n / steps, last_.y + down * n / steps});
    if (steps > 0) last_ = to;
}

void StrokePen::add(const Eigen::Vector3d& p_W) {
    const bool is_apart = is_lifted_ || strokes_.empty() || (strokes_.back().back() - p_W).norm() > kMaxApart;
    if (is_apart && strokes_.size() == kMaxStrokes) return;
    is_lifted_ = false;
    if (is_apart)
        strokes_.push_back({p_W});
    else if ((strokes_.back().back() - p_W).norm() >= kApart)
        strokes_.back().push_back(p_W);
}

const std::vector<Eigen::Vector3d>& StrokePen::points() const {
    static const std::vector<Eigen::Vector3d> kNone;
    return strokes_.empty() ? kNone : strokes_.back();
}

std::vector<topics::Command> StrokePen::takeOrders(const std::string& author) {
    std::vector<topics::Command> orders;
    if (!has_ended_ || !way_.empty()) return orders;
    has_ended_ = false;
    for (const std::vector<Eigen::Vector3d>& stroke : std::exchange(strokes_, {})) {
        if (stroke.size() < 2) continue;
        topics::Remark& remark = *orders.emplace_back().mutable_add_remark();
        for (const Eigen::Vector3d& p_W : thinned(stroke))
            for (const double value : p_W) remark.add_points_m(float(value));
        remark.set_color(colourOfAuthor(author));
    }
    return orders;
}

uint32_t colourOfAuthor(const std::string& author) {
    constexpr std::array<uint32_t, 8> kColours{0xffd23f, 0x3fa7ff, 0x52d273, 0xff7a3f,
                                               0xc77dff, 0x2ee6d6, 0xff5f8f, 0xb7e34a};
    uint32_t hash = 2166136261u;  // FNV-1a
    for (const char letter : author) hash = (hash ^ uint8_t(letter)) * 16777619u;
    return kColours[hash % kColours.size()];
}

std::vector<Eigen::Vector3d> thinned(std::vector<Eigen::Vector3d> points) {
    while (points.size() > size_t(kMaxRemarkPoints)) {
        const Eigen::Vector3d last = points.back();
        size_t kept = 0;
        for (size_t n = 0; n < points.size(); n += 2) points[kept++] = points[n];
        points.resize(kept);
        if (points.back() != last) points.push_back(last);
    }
    return points;
}

}  // namespace bonemill
