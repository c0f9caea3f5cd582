#include "render_client/app/hand_feed.h"

#include <algorithm>
#include <utility>

#include "render_client/controls/help_rows.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kHintTime = 12s;  // then the hint fades
constexpr auto kFadeTime = 2s;
constexpr double kUsualBurr = 1e-3;  // m, while the scene does not say
constexpr double kBurrItself = 1.5;  // burr radii around its centre, where the burr is seen and no bone

float hintOpacity(HandFeed::Clock::duration age) {
    const std::chrono::duration<float> left = kHintTime + kFadeTime - age, fade = kFadeTime;
    return std::clamp(left / fade, 0.0f, 1.0f);
}

}  // namespace

void HandFeed::lookAt(int width, int height) {
    view_ = {scene_.viewCamera(), width, height};
    controls_.toolHold().lookAt(view_);
}

std::string HandFeed::update(const SessionView& session, bool begin_now, Clock::time_point now) {
    const bool is_offered = isOffered(session) && !controls_.toolHold().isHolding();
    const std::string why_not = is_offered ? whyNotHold(session) : "";
    if (begin_now || (is_offered && why_not.empty())) begin(begin_now, now);
    tellDevice();
    showHand(session, now);
    return why_not;
}

// Once in each run of the server: a user who has let the tool go, or whom somebody else was faster than, is
// not asked again.
bool HandFeed::isOffered(const SessionView& session) {
    const bool has_seen_bone = std::exchange(shows_model_, session.is_complete);
    const bool is_wanted = begins_by_itself_ || isHeldByMouse(session);
    if (!has_seen_bone || !is_wanted || session.role == topics::Viewer::VIEWER) return false;
    return std::exchange(offered_epoch_, subscriber_.epoch()) != subscriber_.epoch();
}

void HandFeed::begin(bool is_at_cursor, Clock::time_point now) {
    const double burr_radius = scene_.burrRadius() > 0 ? scene_.burrRadius() : kUsualBurr;
    const bool comes_to_cursor = scene_.settings().stereo == StereoMode::kOff;
    const Eigen::Vector3d surface_W = surfaceInView(is_at_cursor);
    const std::optional<Pose> X_WT = scene_.devicePose();
    const bool is_burr_under_cursor =
        is_at_cursor && X_WT && (X_WT->position - surface_W).norm() < kBurrItself * burr_radius;
    controls_.toolHold().begin(
        is_burr_under_cursor ? *X_WT : beginInFrontOf(surface_W, view_.camera, burr_radius, X_WT),
        burr_radius, comes_to_cursor);
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

void HandFeed::tellDevice() {
    const ToolHold& hold = controls_.toolHold();
    const bool was_holding = std::exchange(was_holding_, hold.isHolding());
    if (hold.isHolding()) {
        subscriber_.wantTool(hold.wish(), hold.buttons());
    } else if (was_holding) {
        subscriber_.letToolGo();
    }
}

void HandFeed::showHand(const SessionView& session, Clock::time_point now) {
    const ToolHold& hold = controls_.toolHold();
    scene_.setPull(hold.isHolding() ? std::optional(hold.wish().position) : std::nullopt);
    if (!started_) started_ = now;
    const float opacity = hintOpacity(now - (hold.isHolding() ? begun_ : *started_));
    scene_.setHint(opacity > 0 ? std::optional(HudHint{hold.isHolding() ? hintRows() : startRows(), opacity})
                               : std::nullopt);
    scene_.setHelp(helpGroups(hold.isHolding()         ? HelpFor::kHolding
                              : isHeldByMouse(session) ? HelpFor::kMayHold
                                                       : HelpFor::kLooking));
}

}  // namespace bonemill
