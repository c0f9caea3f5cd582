// The gateway's side of a relay: dials out, proves itself, and opens a line for every guest that comes there.
// It has a thread of its own and dials again by itself when the relay is lost.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <thread>

#include "common/tcp/descriptor.h"
#include "common/tcp/listen.h"
#include "render_client/web/relay/relay_greeting.h"

namespace bonemill {

class RelayDialer {
  public:
    // Gets each guest's line, on the dialer's thread: a connected socket that does not block, whose next
    // bytes are the guest's first. The address is the relay's word.
    using Adopt = std::function<void(Descriptor line, const PeerAddress& guest)>;

    RelayDialer(RelayPlace relay, Adopt adopt);
    RelayDialer(const RelayDialer&) = delete;
    RelayDialer& operator=(const RelayDialer&) = delete;
    ~RelayDialer();

    // Any thread may ask.
    bool isConnected() const noexcept { return is_connected_; }

  private:
    using Clock = std::chrono::steady_clock;
    enum class Stage { kConnecting, kNonce, kAnswer };
    struct AskedGuest {
        GuestId id{};
        PeerAddress address{};
    };
    struct Dial {
        Descriptor socket;
        RelayAsk ask = RelayAsk::kControl;
        AskedGuest guest;
        Stage stage = Stage::kConnecting;
        std::string heard;
        Clock::time_point until;
    };
    enum class Progress { kGoesOn, kDone, kFailed };

    void run();
    void beginControl(Clock::time_point now);
    void loseControl(Clock::time_point now);
    void beginGuest(const AskedGuest& guest, Clock::time_point now);
    Progress advance(Dial& dial);
    void settle(Dial& dial, Progress progress, Clock::time_point now);
    void beControl(Descriptor socket, Clock::time_point now);
    void complain(const std::string& problem);
    bool hearControl(Clock::time_point now);

    RelayPlace relay_;
    Adopt adopt_;
    std::list<Dial> dials_;
    std::list<AskedGuest> asked_;  // they wait until there are fewer dials
    Descriptor control_;
    std::string heard_;
    std::string complaint_;  // that the log has; each is made once
    Clock::time_point control_heard_, next_try_{};
    std::chrono::milliseconds pause_{kShortestPause};
    static constexpr std::chrono::milliseconds kShortestPause{500}, kLongestPause{20000};
    std::atomic<bool> is_connected_ = false;
    Descriptor wake_;
    std::thread thread_;
};

}  // namespace bonemill
