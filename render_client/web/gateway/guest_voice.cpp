#include "render_client/web/gateway/guest_voice.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cmath>

#include "common/commands/role_rules.h"
#include "common/dds/topic_traits.h"

namespace bonemill::gateway {
namespace {

constexpr double kLargestNumber = 1e6;
constexpr double kUnitTolerance = 1e-3;
constexpr int kMaxWished = 16384;
constexpr std::chrono::seconds kDeafFor{1};

template <class Field>
bool areSane(const Field& field, int count) {
    return field.size() == count &&
           std::ranges::all_of(field, [](auto value) { return std::abs(value) <= kLargestNumber; });
}

bool isSane(const topics::Camera& camera) {
    return (!camera.has_target() || areSane(camera.target_m(), 3)) &&
           (camera.up().empty() || areSane(camera.up(), 3)) && camera.distance_m() >= 0 &&
           camera.distance_m() <= kLargestNumber && std::abs(camera.azimuth_rad()) <= kLargestNumber &&
           std::abs(camera.elevation_rad()) <= kLargestNumber;
}

bool isSane(const topics::Viewer& announce) {
    return announce.frame_rate_hz() >= 0 && announce.frame_rate_hz() <= kLargestNumber &&
           (announce.pointer_m().empty() || areSane(announce.pointer_m(), 3)) && isSane(announce.camera());
}

bool isSane(const topics::HandPointer& hand) {
    if (!hand.is_holding()) return true;
    if (!areSane(hand.p_wt_m(), 3) || !areSane(hand.q_wt(), 4)) return false;
    double square = 0;
    for (const double part : hand.q_wt()) square += part * part;
    return std::abs(std::sqrt(square) - 1) < kUnitTolerance;
}

// What few numbers name is as bounded as what they are.
bool isSane(const topics::DensityWish& wish) {
    if (wish.held_size() % 2 != 0 || wish.revisions_size() % 2 != 0) return false;
    uint64_t held = 0;
    for (int i = 1; i < wish.held_size(); i += 2) held += wish.held(i);
    return uint64_t(wish.lacking_size()) + held <= kMaxWished && wish.held_size() <= kMaxWished &&
           wish.revisions_size() <= 2 * kMaxWished;
}

bool isSane(const Hello& hello) {
    return hello.token().size() <= kMaxTokenBytes && hello.leaves_size() == hello.revisions_size();
}

bool isSane(const FromGuest& message) {
    switch (message.kind_case()) {
        case FromGuest::kHello:
            return isSane(message.hello());
        case FromGuest::kCommand:
            return message.command().action_case() != topics::Command::ACTION_NOT_SET &&
                   message.command().ByteSizeLong() <= dds::kLongestCommand;
        case FromGuest::kAnnounce:
            return isSane(message.announce());
        case FromGuest::kHand:
            return isSane(message.hand());
        case FromGuest::kReceived:
            return true;
        case FromGuest::kWish:
            return isSane(message.wish());
        case FromGuest::KIND_NOT_SET:
            break;
    }
    return false;
}

}  // namespace

std::optional<FromGuest> parseFromGuest(std::string_view frame) {
    const google::protobuf::LogSilencer silencer;
    FromGuest message;
    if (frame.size() > kMaxHelloBytes || !message.ParseFromArray(frame.data(), int(frame.size())) ||
        (frame.size() > kMaxFrameBytes && !message.has_hello()) || !isSane(message))
        return std::nullopt;
    message.DiscardUnknownFields();
    return message;
}

void GuestVoice::announce(const Speaker& speaker, topics::Viewer viewer) {
    viewer.set_sender(speaker.sender);
    viewer.set_name(speaker.name);
    viewer.set_role(speaker.role);
    viewer.set_link(speaker.link);
    if (!mayPoint(speaker.role)) viewer.clear_pointer_m();
    if (!mayHoldTool(speaker.role)) viewer.clear_is_holding();
    viewer.clear_eye(), viewer.clear_is_trainee();  // the trainee is in the building
    if (mouth_) mouth_->viewers.write(session_, viewer.sender(), viewer.SerializeAsString());
}

void GuestVoice::command(const Speaker& speaker, topics::Command command) {
    command.set_sender(speaker.sender);
    command.set_role(speaker.role);
    command.set_name(speaker.name);
    const auto now = std::chrono::steady_clock::now();
    if (!mouth_ || now < deaf_until_) return;
    if (!mouth_->commands.write(session_, command.sender(), command.SerializeAsString()))
        deaf_until_ = now + kDeafFor;
}

void GuestVoice::hand(const Speaker& speaker, topics::HandPointer hand) {
    hand.set_sender(speaker.sender);
    hand.set_role(speaker.role);
    if (mouth_) mouth_->hands.write(session_, hand.sender(), hand.SerializeAsString());
}

void GuestVoice::wish(const Speaker& speaker, topics::DensityWish wish) {
    wish.set_sender(speaker.sender);
    if (mouth_) mouth_->wishes.write(session_, wish.sender(), wish.SerializeAsString());
}

}  // namespace bonemill::gateway
