#include "render_client/link/subscribe/viewer_list.h"

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

}  // namespace bonemill
