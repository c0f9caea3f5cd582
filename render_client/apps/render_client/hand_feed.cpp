#include "render_client/apps/render_client/hand_feed.h"

#include <algorithm>
#include <utility>

#include "common/commands/role_rules.h"
#include "render_client/hand/controls/key_table.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kHintTime = 12s;      // then the hint fades
constexpr auto kHoldHintTime = 60s;  // that on the tool in the mouse, unless it mills before
constexpr auto kFadeTime = 2s;
constexpr auto kSettleTime = 700ms;  // so long the bone may take to be put back
constexpr double kUsualBurr = 1e-3;  // m, while the scene does not say
constexpr double kBurrItself = 1.5;  // burr radii around its centre, where the burr is seen and no bone

float hintOpacity(HandFeed::Clock::duration until_end) {
    const std::chrono::duration<float> left = until_end + kFadeTime, fade = kFadeTime;
    return std::clamp(left / fade, 0.0f, 1.0f);
}

}  // namespace

std::optional<HudNotice> RemarkFeed::update(const SessionView& session, Wishes& wishes) {
    if (wishes.note_at) wishes.note_place = scene_.pick(int(wishes.note_at->x), int(wishes.note_at->y));
    draw(session, wishes);
    return news(session);
}

void RemarkFeed::draw(const SessionView& session, Wishes& wishes) {
    StrokePen& pen = controls_.pen();
    for (const PixelPoint& at : pen.takeWay()) {
        const auto p_W = scene_.pick(int(at.x), int(at.y));
        p_W ? pen.add(*p_W) : pen.lift();
    }
    for (const topics::Command& order : pen.takeOrders(session.name))
        controls_.request(order, session, wishes);
    Stroke drawn;
    drawn.colour = strokeColour(colourOfAuthor(session.name));
    for (const Eigen::Vector3d& p_W : pen.points()) drawn.points_W.push_back(p_W.cast<float>());
    scene_.setDrawn(std::move(drawn));
}

// What was there when this viewer came is no news.
std::optional<HudNotice> RemarkFeed::news(const SessionView& session) {
    if (!session.remarks || !session.status) return std::nullopt;
    const bool is_first = std::exchange(seen_epoch_, session.status->epoch()) != session.status->epoch();
    if (is_first) seen_number_ = 0;
    const topics::Remark* newest = nullptr;
    for (const auto& [place, remark] : *session.remarks)
        if (remark.number() > (newest ? newest->number() : seen_number_)) newest = &remark;
    if (!newest) return std::nullopt;
    seen_number_ = newest->number();
    const bool is_old = newest->session_s() + 10 < session.status->session_s();
    if (is_first || is_old || newest->note().empty() || newest->author() == session.name) return std::nullopt;
    return HudNotice{watcherName(newest->author()) + ": " + newest->note(), HudTone::kPlain};
}

void HandFeed::lookAt(int width, int height) {
    const bool has_places = scene_.settings().stereo == StereoMode::kOff && !scene_.followsTool();
    view_ = {scene_.viewCamera(), width, height, has_places};
    controls_.toolHold().lookAt(view_);
}

std::optional<HudNotice> HandFeed::update(const SessionView& session, bool begin_now, Clock::time_point now) {
    rest(session, now);
    begin_now = takesOver(session) || begin_now;
    const bool has_seen_bone = std::exchange(shows_model_, session.is_complete);
    const bool is_offered = isOffered(session, has_seen_bone) && !controls_.toolHold().isHolding();
    const bool goes_on = goesOn(has_seen_bone, now);
    const std::string why_not = is_offered || goes_on ? whyNotHold(session) : "";
    std::optional<HudNotice> notice;
    if (!why_not.empty()) notice = {why_not, HudTone::kWarning};
    if (begin_now) notice = {tr("The mouse holds the tool"), HudTone::kPlain};
    if (begin_now || ((is_offered || goes_on) && why_not.empty())) begin(begin_now || goes_on_at_, now);
    if (goes_on) goes_on_at_.reset();
    if (!notice) notice = watch(session, now);
    tellDevice();
    showHand(session, now);
    return notice;
}

// The wish is of the old scene, or of the bone before: no hand may be drawn there.
void HandFeed::rest(const SessionView& session, Clock::time_point now) {
    const bool is_attempt = session.lesson && session.lesson->is_running();
    const int64_t attempt_ns = is_attempt ? session.lesson->start_stamp_ns() : seen_attempt_ns_;
    const bool is_other_attempt = std::exchange(seen_attempt_ns_, attempt_ns) != attempt_ns;
    const bool is_other_run = std::exchange(seen_epoch_, subscriber_.epoch()) != subscriber_.epoch();
    if (!controls_.toolHold().isHolding() || !(is_other_attempt || is_other_run)) return;
    controls_.toolHold().letGo();
    goes_on_at_ = now + kSettleTime;
}

bool HandFeed::goesOn(bool has_seen_bone, Clock::time_point now) const {
    return goes_on_at_ && now >= *goes_on_at_ && has_seen_bone && !controls_.toolHold().isHolding();
}

std::optional<HudNotice> HandFeed::watch(const SessionView& session, Clock::time_point now) {
    const ToolHold& hold = controls_.toolHold();
    const auto X_WT = scene_.toolPose();
    if (!hold.isHolding() || !session.has_server || !X_WT) return std::nullopt;
    const HoldMonitor::Advice advice =
        watch_.look({.now = std::chrono::duration<double>(now.time_since_epoch()).count(),
                     .burr_radius = scene_.burrRadius(),
                     .from_wish = (X_WT->position - hold.wish().position).norm(),
                     .presses = hold.buttons() != 0,
                     .touches = scene_.contacts() > 0,
                     .can_mill = !(session.status && session.status->is_milling_paused())});
    switch (advice) {
        case HoldMonitor::Advice::kNone:
            return std::nullopt;
        case HoldMonitor::Advice::kFree:
            begin(true, now);
            return HudNotice{tr("The bone had caught the tool: it is in front of it again"), HudTone::kPlain};
        case HoldMonitor::Advice::kHelp:
            return HudNotice{tr("The tool is caught: turn the view, then press {1} twice",
                                {keyLabelOf(Action::kHoldTool)}),
                             HudTone::kWarning};
        case HoldMonitor::Advice::kTouch:
            return HudNotice{tr("Not touching the bone: the wheel, or {1}, brings the tool nearer",
                                {keyLabelOf(Action::kToolDeeper)}),
                             HudTone::kWarning};
    }
    return std::nullopt;
}

// The mouse that comes in the place of a scripted hand is that of who has asked for it; with the script, or
// another scene, the hold ends.
bool HandFeed::takesOver(const SessionView& session) {
    const bool has_taken_over = isTakenOver(session) && isHeldByMouse(session) &&
                                session.status->device().script().taken_over_by() == subscriber_.sender();
    const bool had_taken_over = std::exchange(has_taken_over_, has_taken_over);
    if (had_taken_over && !has_taken_over) {
        controls_.toolHold().letGo();
        goes_on_at_.reset();
    }
    return has_taken_over && !had_taken_over && !controls_.toolHold().isHolding();
}

// Once in each run of the server: a user who has let the tool go, or whom another user was faster than, is
// not asked again.
bool HandFeed::isOffered(const SessionView& session, bool has_seen_bone) {
    const bool is_wanted = begins_by_itself_ || isHeldByMouse(session);
    if (!has_seen_bone || !is_wanted || !mayHoldTool(session.role)) return false;
    // The mouse of a take-over is that of who has asked for it, and nobody's when the script goes on.
    if (isTakenOver(session)) offered_epoch_ = subscriber_.epoch();
    return std::exchange(offered_epoch_, subscriber_.epoch()) != subscriber_.epoch();
}

void HandFeed::begin(bool is_at_cursor, Clock::time_point now) {
    const double burr_radius = scene_.burrRadius() > 0 ? scene_.burrRadius() : kUsualBurr;
    const Eigen::Vector3d surface_W = surfaceInView(is_at_cursor);
    const std::optional<Pose> X_WT = scene_.devicePose();
    const bool is_burr_under_cursor =
        is_at_cursor && X_WT && (X_WT->position - surface_W).norm() < kBurrItself * burr_radius;
    // By a way there it might be caught behind bone.
    if (!is_burr_under_cursor) ++placements_;
    controls_.toolHold().begin(
        is_burr_under_cursor ? *X_WT : beginInFrontOf(surface_W, view_.camera, burr_radius, X_WT),
        burr_radius);
    begun_ = now;
    goes_on_at_.reset();
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
        subscriber_.wantTool(hold.wish(), hold.buttons(), placements_);
    } else if (was_holding) {
        subscriber_.letToolGo();
    }
}

void HandFeed::showHand(const SessionView& session, Clock::time_point now) {
    const ToolHold& hold = controls_.toolHold();
    scene_.setPull(hold.isHolding() ? std::optional(hold.wish().position) : std::nullopt);
    if (!started_) started_ = now;
    if (!milled_ && hold.buttons() != 0) milled_ = now;
    Clock::time_point hint_end = *started_ + kHintTime;
    if (hold.isHolding()) hint_end = std::min(begun_ + kHoldHintTime, milled_.value_or(now + kHintTime));
    const float opacity = hintOpacity(hint_end - now);
    scene_.setHint(opacity > 0 ? std::optional(HudHint{hold.isHolding() ? hintRows() : startRows(), opacity})
                               : std::nullopt);
    scene_.setHelp(helpGroups(hold.isHolding()                                  ? HelpFor::kHolding
                              : isReplay(session)                               ? HelpFor::kReplay
                              : isHeldByMouse(session) || hasHandEnded(session) ? HelpFor::kMayHold
                                                                                : HelpFor::kLooking,
                              session.lesson != nullptr));
}

}  // namespace bonemill
