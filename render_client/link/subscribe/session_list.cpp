#include "render_client/link/subscribe/session_list.h"

#include <ctime>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/link/subscribe/payloads.h"

namespace bonemill {

void SessionList::poll() {
    const auto now = std::chrono::steady_clock::now();
    std::erase_if(heard_, [now](const auto& entry) { return now - entry.second.at >= kTimeout; });
    reader_.take(kMaxSessions, [this](const dds::StatusSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data) return;
        const std::optional<topics::Status> status = parseStatus(dds::payloadOf(sample));
        if (!status || (heard_.size() >= kMaxSessions && !heard_.contains(sample.session))) return;
        Heard& heard = heard_[sample.session];
        const bool is_known = heard.session.epoch_ns == status->epoch() && !heard.session.host.empty();
        heard = {{sample.session, status->scene(), status->epoch(),
                  is_known ? heard.session.host : reader_.hostOf(info.writer)},
                 std::chrono::steady_clock::now()};
    });
}

std::vector<ListedSession> SessionList::sessions() const {
    std::vector<ListedSession> sessions;
    const auto now = std::chrono::steady_clock::now();
    for (const auto& [number, heard] : heard_)
        if (now - heard.at < kTimeout) sessions.push_back(heard.session);
    return sessions;
}

std::string sessionText(const ListedSession& session) {
    const auto start = std::time_t(session.epoch_ns / uint64_t(kNsPerSecond));
    std::tm local{};
    char since[32] = "?";
    if (localtime_r(&start, &local)) std::strftime(since, sizeof since, "%H:%M:%S", &local);
    const std::string number = std::to_string(session.session);
    if (session.host.empty()) return tr("session {1}: {2} since {3}", {number, session.scene, since});
    return tr("session {1}: {2} since {3} on {4}", {number, session.scene, since, session.host});
}

}  // namespace bonemill
