#include "render_client/apps/render_client/remark_feed.h"

#include <algorithm>
#include <utility>

#include "render_client/look/hud/session_text.h"

namespace bonemill {

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

}  // namespace bonemill
