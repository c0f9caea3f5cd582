#include "render_client/link/subscribe/heard_peers.h"

#include <algorithm>
#include <utility>

#include "common/base/make_room.h"

namespace bonemill {

void ViewerList::hear(topics::Viewer viewer, uint64_t participant, Clock::time_point now) {
    const auto known = heard_.find(viewer.sender());
    if (known == heard_.end())
        makeRoomFor(
            participant, heard_, {kMaxViewers, kMaxOfParticipant},
            [](const auto& entry) { return entry.second.participant; },
            [](const auto& entry) { return entry.second.at; });
    else if (known->second.participant != participant)
        return;  // until the other one falls silent
    const uint64_t sender = viewer.sender();
    heard_[sender] = {std::move(viewer), participant, now};
}

void ViewerList::forgetSilent(Clock::time_point now) {
    std::erase_if(heard_, [now](const auto& entry) { return now - entry.second.at > kTimeout; });
}

std::vector<topics::Viewer> ViewerList::viewers() const {
    std::vector<topics::Viewer> viewers;
    for (const auto& [sender, heard] : heard_) viewers.push_back(heard.viewer);
    return viewers;
}

ServerChoice::Verdict ServerChoice::judge(const Message& message, bool is_alive, Clock::time_point now) {
    if (!isOurs(message.server)) {
        if (!mayTake(message, is_alive)) {
            refuse(message, now);
            return Verdict::kOther;
        }
        take(message);
    }
    if (message.epoch < epoch_) return Verdict::kOlder;
    epoch_ = message.epoch;
    has_spoken_ = has_spoken_ || message.is_status;
    return Verdict::kOurs;
}

// The first of all may say anything; but who has never spoken as a server does makes room for one that does.
bool ServerChoice::mayTake(const Message& message, bool is_alive) const {
    if (!has_server_) return true;
    if (is_alive && has_spoken_) return false;
    const auto known = others_.find(message.server);
    return message.is_status || (!is_alive && known != others_.end() && known->second.speaks);
}

void ServerChoice::take(const Message& message) {
    const auto known = others_.find(message.server);
    has_lost_ = known != others_.end() && known->second.was_refused;
    has_server_ = true;
    has_spoken_ = false;
    ours_ = message.server;
    epoch_ = message.epoch;
    others_.clear();
}

void ServerChoice::refuse(const Message& message, Clock::time_point now) {
    if (others_.size() < kMaxOthers || others_.contains(message.server)) {
        Other& other = others_[message.server];
        other.was_refused = true;
        other.speaks = other.speaks || message.is_status;
    }
    if (!message.is_status) return;
    if (!other_last_ || now - *other_last_ > kOtherUntil) other_since_ = now;
    other_last_ = now;
}

bool ServerChoice::takeLost() {
    return std::exchange(has_lost_, false);
}

bool ServerChoice::hasCandidate() const {
    return std::ranges::any_of(others_,
                               [](const auto& o) { return o.second.speaks && o.second.was_refused; });
}

void ServerChoice::forgetRefused() {
    has_lost_ = false;
    for (auto& [server, other] : others_) other.was_refused = false;
}

bool ServerChoice::hasOther(Clock::time_point now) const {
    return other_last_ && now - *other_last_ < kOtherUntil && *other_last_ - *other_since_ >= kOtherFor;
}

}  // namespace bonemill
