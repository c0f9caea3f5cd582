// One connection to the gateway, from its Hello to its end, without the network: frames go in and out. What
// it is waited for, how much and how often it may say, is bounded here.
//
// For one thread; times are CLOCK_MONOTONIC unless they say otherwise.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "render_client/web/gateway/guest_list.h"
#include "render_client/web/gateway/guest_stream.h"
#include "render_client/web/gateway/guest_voice.h"

namespace bonemill::gateway {

int64_t unixSeconds();

// What all guests share. It outlives them.
struct Hall {
    const SessionState& state;
    GuestList& guests;
    GuestVoice& voice;
    double guest_bytes_per_s;
};

class Guest {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kHelloTime{5};
    static constexpr std::chrono::seconds kRefusalDelay{1};  // who guesses is slow
    static constexpr double kFramesPerSecond = 400, kMaxFramesAtOnce = 800;

    Guest(Hall& hall, GuestOrigin origin, Clock::time_point now);
    // The session learns that this hand has let go.
    ~Guest();
    Guest(const Guest&) = delete;
    Guest& operator=(const Guest&) = delete;

    // Takes one whole frame.
    void receive(std::string_view frame, Clock::time_point now);
    void note(const SessionChanges& changes) {
        if (stream_) stream_->note(changes);
    }
    bool isDue(Clock::time_point now);
    // Returns the frame that is due; empty: none.
    std::string nextFrame(Clock::time_point now);
    // Nothing is left to say and it is to be closed; `reason` says why, without secrets.
    bool shouldClose(Clock::time_point now);
    const std::string& reason() const noexcept { return reason_; }

    // It ends with this, which the guest is told; `is_final` says that it need not try again.
    void refuse(std::string reason, bool is_final, Clock::time_point due = {});
    bool isAdmitted() const noexcept { return admission_ && stream_; }
    // Ends at once and unsaid, for somebody else's sake.
    void makeRoom();
    // It has a place among those whose Hello was not heard, or not believed.
    bool isUnknown() const noexcept { return !isAdmitted() && !has_made_room_; }
    // Of its seat; empty before it is admitted.
    const std::string& seat() const;
    bool isInvited(int64_t now_s) const;
    // Its invitation says the same as when it came.
    bool isAsAdmitted() const { return !admission_ || hall_.guests.isAsAdmitted(*admission_); }
    // It came with a token that nobody was given.
    bool hasFailed() const noexcept { return has_failed_; }
    bool wishesBricks() const { return stream_ && stream_->wishesBricks(); }
    const GuestOrigin& origin() const noexcept { return origin_; }
    const Speaker& speaker() const noexcept { return speaker_; }
    const GuestStream* stream() const noexcept { return stream_ ? &*stream_ : nullptr; }

  private:
    bool mayTalk(Clock::time_point now);
    void greet(const Hello& hello, Clock::time_point now);
    void take(FromGuest& message, Clock::time_point now);
    void takeCommand(topics::Command& command);
    void takeHand(topics::HandPointer& hand);
    void takeWish(topics::DensityWish& wish);

    Hall& hall_;
    const GuestOrigin origin_;
    const Clock::time_point came_;
    std::optional<Admission> admission_;
    Speaker speaker_;
    std::optional<GuestStream> stream_;
    std::string welcome_;
    std::string refusal_;  // a frame
    std::string reason_;
    Clock::time_point refusal_due_;
    bool is_ending_ = false;
    bool has_made_room_ = false;
    bool has_failed_ = false;
    bool is_holding_ = false;
    topics::HandPointer last_hand_;
    double talk_credit_ = kMaxFramesAtOnce;
    Clock::time_point talked_;
};

}  // namespace bonemill::gateway
