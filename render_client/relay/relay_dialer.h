// The gateway's side of a relay: dials out, proves itself, and opens a line for every guest that comes there.
// It has a thread of its own and dials again by itself when the relay is lost.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <string>
#include <thread>

#include "render_client/relay/descriptor.h"
#include "render_client/relay/relay_greeting.h"

namespace bonemill {

struct RelayPlace {
    std::string host;
    uint16_t port = 0;
};

class RelayDialer {
  public:
    // Gets each guest's line, on the dialer's thread: a connected socket that does not block, whose next
    // bytes are the guest's first.
    using Adopt = std::function<void(Descriptor line)>;

    RelayDialer(RelayPlace relay, std::string secret, Adopt adopt);
    RelayDialer(const RelayDialer&) = delete;
    RelayDialer& operator=(const RelayDialer&) = delete;
    ~RelayDialer();

    // Any thread may ask.
    bool isConnected() const noexcept { return is_connected_; }

  private:
    using Clock = std::chrono::steady_clock;
    enum class Stage { kConnecting, kNonce, kAnswer };
    struct Dial {
        Descriptor socket;
        RelayAsk ask = RelayAsk::kControl;
        GuestId guest{};
        Stage stage = Stage::kConnecting;
        std::string heard;
        Clock::time_point until;
    };
    enum class Progress { kGoesOn, kDone, kFailed };

    void run();
    void beginControl(Clock::time_point now);
    void loseControl(Clock::time_point now);
    void dial(RelayAsk ask, const GuestId& guest, Clock::time_point now);
    Progress advance(Dial& dial);
    void settle(Dial& dial, Progress progress, Clock::time_point now);
    bool hearControl(Clock::time_point now);

    RelayPlace relay_;
    std::string secret_;
    Adopt adopt_;
    std::list<Dial> dials_;
    std::list<GuestId> asked_;  // guests that wait until there are fewer dials
    Descriptor control_;
    std::string heard_;
    Clock::time_point control_heard_, next_try_{};
    std::chrono::milliseconds pause_{kShortestPause};
    static constexpr std::chrono::milliseconds kShortestPause{500}, kLongestPause{20000};
    std::atomic<bool> is_connected_ = false;
    Descriptor wake_;
    std::thread thread_;
};

}  // namespace bonemill
