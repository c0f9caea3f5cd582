#include "render_client/web/gateway/guest.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>
#include <utility>

#include "common/commands/role_rules.h"
#include "render_client/link/subscribe/remote_session.h"

namespace bonemill::gateway {
namespace {

uint64_t randomGuestSender() {
    std::random_device device;
    uint64_t sender = 0;
    while (sender == 0) sender = (uint64_t(device()) << 32) | device();
    return sender;
}

std::unordered_set<uint32_t> bricksOf(const topics::DensityWish& wish) {
    std::unordered_set<uint32_t> bricks(wish.lacking().begin(), wish.lacking().end());
    uint32_t next = 0;
    for (int i = 0; i + 1 < wish.held_size(); i += 2) {
        next += wish.held(i);
        for (uint32_t n = 0; n < wish.held(i + 1); ++n) bricks.insert(next++);
    }
    return bricks;
}

}  // namespace

int64_t unixSeconds() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::seconds>(now).count();
}

Guest::Guest(Hall& hall, GuestOrigin origin, Clock::time_point now)
    : hall_(hall), origin_(std::move(origin)), came_(now), talked_(now) {}

Guest::~Guest() {
    if (!is_holding_) return;
    last_hand_.set_is_holding(false);
    last_hand_.set_sequence(last_hand_.sequence() + 1);
    hall_.voice.hand(speaker_, last_hand_);
}

const std::string& Guest::seat() const {
    static const std::string kNone;
    return admission_ ? admission_->ticket_sha256 : kNone;
}

bool Guest::isInvited(int64_t now_s) const {
    return !admission_ || hall_.guests.isInvited(admission_->token_sha256, now_s);
}

bool Guest::mayTalk(Clock::time_point now) {
    const std::chrono::duration<double> passed = now - std::exchange(talked_, now);
    talk_credit_ = std::min(talk_credit_ + kFramesPerSecond * passed.count(), kMaxFramesAtOnce);
    return --talk_credit_ >= 0;
}

void Guest::refuse(std::string reason, bool is_final, Clock::time_point due) {
    if (is_ending_) return;
    is_ending_ = true;
    ToGuest frame;
    frame.mutable_refusal()->set_reason(reason);
    frame.mutable_refusal()->set_is_final(is_final);
    refusal_ = frame.SerializeAsString();
    refusal_due_ = due;
    reason_ = std::move(reason);
}

void Guest::makeRoom() {
    has_made_room_ = is_ending_ = true;
    refusal_.clear();
    reason_ = "others were waiting";
}

void Guest::receive(std::string_view frame, Clock::time_point now) {
    if (is_ending_) return;
    if (!mayTalk(now)) return refuse("Too many messages.", false);
    std::optional<FromGuest> message = parseFromGuest(frame);
    if (!message || message->has_hello() == isAdmitted())
        return refuse("This message makes no sense to the gateway; reload the page.", false);
    if (message->has_hello())
        greet(message->hello(), now);
    else
        take(*message, now);
}

void Guest::greet(const Hello& hello, Clock::time_point now) {
    if (hello.version() != kProtocolVersion)
        return refuse("The gateway is of another version; reload the page, or update the viewer.", true);
    Admission admission = hall_.guests.admit(hello.token(), unixSeconds());
    if (!admission.refusal.empty()) {
        has_failed_ = admission.is_unknown;
        return refuse(admission.refusal, admission.is_final, now + kRefusalDelay);
    }
    speaker_ = {randomGuestSender(), admission.name, admission.role,
                hello.link() == "viewer" ? "viewer" : "browser"};
    ToGuest frame;
    Welcome& welcome = *frame.mutable_welcome();
    welcome.set_ticket(admission.ticket);
    welcome.set_name(admission.name);
    welcome.set_role(admission.role);
    welcome.set_sender(speaker_.sender);
    welcome.set_version(kProtocolVersion);
    welcome.set_expires_ns(admission.expires_s * 1'000'000'000);
    welcome_ = frame.SerializeAsString();
    admission.ticket.clear();
    admission_ = std::move(admission);
    stream_.emplace(hall_.state, hello, hall_.guest_bytes_per_s, now);
}

void Guest::take(FromGuest& message, Clock::time_point now) {
    switch (message.kind_case()) {
        case FromGuest::kCommand:
            return takeCommand(*message.mutable_command());
        case FromGuest::kAnnounce:
            return hall_.voice.announce(speaker_, std::move(*message.mutable_announce()));
        case FromGuest::kHand:
            return takeHand(*message.mutable_hand());
        case FromGuest::kReceived:
            if (!stream_->acknowledge(message.received().bytes(), now))
                refuse("This message makes no sense to the gateway; reload the page.", false);
            return;
        case FromGuest::kWish:
            return takeWish(*message.mutable_wish());
        default:
            return;
    }
}

void Guest::takeCommand(topics::Command& command) {
    if (const std::string why_not = whyNotOrder(speaker_.role, command.action_case()); !why_not.empty())
        return stream_->answer(speaker_.sender, command.sequence(), Answer::refused(why_not));
    hall_.voice.command(speaker_, std::move(command));
}

void Guest::takeHand(topics::HandPointer& hand) {
    if (!mayHoldTool(speaker_.role)) return;
    is_holding_ = hand.is_holding();
    last_hand_ = hand;
    hall_.voice.hand(speaker_, std::move(hand));
}

void Guest::takeWish(topics::DensityWish& wish) {
    stream_->wishBricks(wish.epoch() == hall_.state.epoch ? bricksOf(wish) : std::unordered_set<uint32_t>());
    hall_.voice.wish(speaker_, std::move(wish));
}

bool Guest::isDue(Clock::time_point now) {
    if (is_ending_) return !refusal_.empty() && now >= refusal_due_;
    return stream_ && (!welcome_.empty() || stream_->isDue(now));
}

std::string Guest::nextFrame(Clock::time_point now) {
    if (is_ending_) return now < refusal_due_ ? "" : std::exchange(refusal_, "");
    if (!stream_) return {};
    if (!welcome_.empty()) {
        stream_->sent(welcome_.size(), now);
        return std::exchange(welcome_, "");
    }
    return stream_->next(now);
}

bool Guest::shouldClose(Clock::time_point now) {
    if (!is_ending_ && !stream_ && now - came_ > kHelloTime) refuse("No Hello came.", false);
    if (!is_ending_ && stream_ && stream_->isStalled(now)) {
        is_ending_ = true;  // it would not hear why
        reason_ = "nothing was acknowledged for too long";
    }
    return is_ending_ && refusal_.empty();
}

}  // namespace bonemill::gateway
