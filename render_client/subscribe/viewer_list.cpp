#include "render_client/subscribe/viewer_list.h"

#include <algorithm>
#include <utility>

namespace bonemill {

void ViewerList::hear(topics::Viewer viewer, uint64_t writer, Clock::time_point now) {
    const auto known = heard_.find(viewer.sender());
    if (known == heard_.end()) {
        const auto is_its = [writer](const auto& entry) { return entry.second.writer == writer; };
        if (heard_.size() >= kMostViewers || size_t(std::ranges::count_if(heard_, is_its)) >= kMostOfWriter)
            return;
    } else if (known->second.writer != writer) {
        return;  // until the other writer falls silent
    }
    const uint64_t sender = viewer.sender();
    heard_[sender] = {std::move(viewer), writer, now};
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
