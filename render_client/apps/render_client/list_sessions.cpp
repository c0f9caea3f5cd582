#include "render_client/apps/render_client/list_sessions.h"

#include <iostream>
#include <thread>

#include "render_client/apps/render_client/stop_signal.h"
#include "render_client/link/subscribe/session_list.h"

namespace bonemill {

int runListSessions(const ClientOptions& options) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kPatience{2000}, kSlice{20};
    SessionList list(options.subscriber.domain);
    for (const auto end = Clock::now() + kPatience; Clock::now() < end && !stopRequested();) {
        std::this_thread::sleep_for(kSlice);
        list.poll();
    }
    const std::vector<ListedSession> sessions = list.sessions();
    for (const ListedSession& session : sessions) std::cout << sessionText(session) << '\n';
    if (sessions.empty())
        std::cerr << "no session in domain " << options.subscriber.domain
                  << "; on other PCs they are found with --profile lab or classroom" << std::endl;
    return sessions.empty() ? 1 : 0;
}

}  // namespace bonemill
