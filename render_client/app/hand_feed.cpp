#include "render_client/app/hand_feed.h"

#include <algorithm>

#include "render_client/controls/help_rows.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kLeastPause = 8ms;  // between two messages: no window needs more than 125 per second
constexpr auto kFarewell = 500ms;  // so long the viewer goes on saying that it has let go
constexpr auto kHintTime = 12s;    // then the hint fades
constexpr auto kFadeTime = 2s;
constexpr double kUsualBurr = 1e-3;  // m, while the scene does not say

float hintOpacity(HandFeed::Clock::duration age) {
    const std::chrono::duration<float> left = kHintTime + kFadeTime - age, fade = kFadeTime;
    return std::clamp(left / fade, 0.0f, 1.0f);
}

}  // namespace

HandFeed::~HandFeed() {
    if (controls_.toolHold().isHolding()) subscriber_.letToolGo();
}

void HandFeed::lookAt(int width, int height) {
    view_ = {scene_.viewCamera(), width, height};
    controls_.toolHold().lookAt(view_);
}

void HandFeed::update(const SessionView& session, bool begin_now, Clock::time_point now) {
    const bool by_itself = shouldBeginByItself(session);
    if (begin_now || by_itself) begin(begin_now, now);
    tellDaemon(now);
    showHand(session, now);
}

// A user who has let the tool go, or whom somebody else was faster than, is not asked again.
bool HandFeed::shouldBeginByItself(const SessionView& session) {
    const bool is_wanted = begins_by_itself_ || isHeldByMouse(session);
    if (!is_wanted || !session.is_complete || offered_epoch_ == subscriber_.epoch()) return false;
    offered_epoch_ = subscriber_.epoch();
    return !controls_.toolHold().isHolding() && whyNotHold(session).empty();
}

void HandFeed::begin(bool is_at_cursor, Clock::time_point now) {
    const double burr_radius = scene_.burrRadius() > 0 ? scene_.burrRadius() : kUsualBurr;
    const Pose X_WT =
        beginInFrontOf(surfaceInView(is_at_cursor), view_.camera, burr_radius, scene_.devicePose());
    const bool comes_to_cursor = scene_.settings().stereo == StereoMode::kOff;
    controls_.toolHold().begin(X_WT, burr_radius, comes_to_cursor);
    begun_ = now;
}

// The bone under the cursor, or else the bone on the line of sight through its middle.
Eigen::Vector3d HandFeed::surfaceInView(bool is_at_cursor) const {
    const auto pick = [&](const PixelPoint& at) { return scene_.pick(int(at.x), int(at.y)); };
    const auto& cursor = controls_.toolHold().cursor();
    if (is_at_cursor && cursor)
        if (const auto p_W = pick(*cursor)) return *p_W;
    const Eigen::AlignedBox3d bone_W = scene_.bone_W();
    if (bone_W.isEmpty()) return view_.camera.target_W();
    if (const auto p_W = pick(view_.pixelOf(bone_W.center()))) return *p_W;
    const Eigen::Vector3d towards_eye = (view_.camera.eye_W - bone_W.center()).normalized();
    return bone_W.center() + bone_W.diagonal().norm() / 2 * towards_eye;
}

void HandFeed::tellDaemon(Clock::time_point now) {
    const ToolHold& hold = controls_.toolHold();
    if (hold.isHolding()) held_last_ = now;
    const bool has_changed = hold.buttons() != told_buttons_ || hold.isHolding() != was_holding_;
    if (now - held_last_ > kFarewell || (!has_changed && now - told_ < kLeastPause)) return;
    told_ = now;
    told_buttons_ = hold.buttons();
    if (hold.isHolding()) {
        subscriber_.wantTool(hold.wish(), hold.buttons());
    } else {
        subscriber_.letToolGo();
    }
}

void HandFeed::showHand(const SessionView& session, Clock::time_point now) {
    const ToolHold& hold = controls_.toolHold();
    was_holding_ = hold.isHolding();
    scene_.setPull(hold.isHolding() ? std::optional(hold.wish().position) : std::nullopt);
    const float opacity = hold.isHolding() ? hintOpacity(now - begun_) : 0;
    scene_.setHint(opacity > 0 ? std::optional(HudHint{holdRows(), opacity}) : std::nullopt);
    scene_.setHelp(helpRows(hold.isHolding()         ? HelpFor::kHolding
                            : isHeldByMouse(session) ? HelpFor::kMayHold
                                                     : HelpFor::kLooking));
}

}  // namespace bonemill
