// The gateway without its network: the session on one side, guests on the other. For one thread; nothing
// waits.
#pragma once

#include <chrono>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/dds/participant.h"
#include "render_client/link/subscribe/heard_peers.h"
#include "render_client/web/gateway/gateway_options.h"
#include "render_client/web/gateway/guest.h"
#include "render_client/web/gateway/guest_list.h"
#include "render_client/web/gateway/guest_log.h"
#include "render_client/web/gateway/session_mirror.h"

namespace bonemill::gateway {

class Gateway {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr CrowdBounds kMaxUnknown{64, 16, 48};  // before their Hello
    static constexpr int kMaxFailures = 10;                // of one address within kFailuresLast
    static constexpr std::chrono::seconds kFailuresLast{60};

    // Throws UserError.
    explicit Gateway(const GatewayOptions& options);

    // Somebody has connected from there; returns nullptr where there are too many, and nobody makes room. It
    // stays until leave().
    Guest* come(const GuestOrigin& origin, Clock::time_point now);
    void leave(Guest* guest);
    // Somebody from there wanted what is not his: it is for the log.
    void noteComplaint(const GuestOrigin& origin, const std::string& complaint);
    // Takes one whole frame of the guest.
    void receive(Guest& guest, std::string_view frame, Clock::time_point now);
    // Takes what is new from the session, and looks after the guests: often.
    void step(Clock::time_point now);

    const SessionMirror& mirror() const { return mirror_; }
    const GuestList& list() const { return list_; }
    // How often it has joined the domain anew, as nothing was heard there.
    uint64_t rejoinings() const { return rejoinings_; }

  private:
    size_t admittedCount() const;
    bool findPlaceFor(const GuestOrigin& comer);
    void welcome(Guest& guest);
    void noteFailure(const GuestOrigin& origin, Clock::time_point now);
    void lookAtList(Clock::time_point now);
    void join();
    void rejoinIfDeaf(Clock::time_point now);

    struct Failures {
        int count = 0;
        Clock::time_point since;
    };
    const size_t most_guests_;
    const uint32_t domain_;
    std::optional<dds::Participant> participant_;
    SessionMirror mirror_;
    GuestVoice voice_;
    GuestList list_;
    Hall hall_;
    std::list<std::unique_ptr<Guest>> guests_;
    std::map<GuestOrigin, Failures> failures_;
    GuestLog log_;
    Clock::time_point looked_;
    uint64_t epoch_ = 0;  // of the run that is shown
    SilenceMonitor deaf_watch_;
    std::optional<Clock::time_point> heard_;  // our server, the last time
    uint64_t rejoinings_ = 0;
};

}  // namespace bonemill::gateway
