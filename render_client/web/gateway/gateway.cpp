#include "render_client/web/gateway/gateway.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/files/config_folder.h"

namespace bonemill::gateway {
namespace {

constexpr size_t kMaxAddresses = 4096;  // that failed
constexpr double kBitsPerByte = 8;
constexpr std::chrono::milliseconds kLookEvery{250};  // what was withdrawn is over within 1 s

const char* wordOf(topics::Viewer::Role role) {
    switch (role) {
        case topics::Viewer::OPERATOR:
            return "operator";
        case topics::Viewer::INSTRUCTOR:
            return "instructor";
        case topics::Viewer::EXAMINER:
            return "examiner";
        default:
            return "observer";
    }
}

}  // namespace

Gateway::Gateway(const GatewayOptions& options)
    : most_guests_(options.most_guests),
      domain_(options.domain),
      mirror_(options.session),
      voice_(options.session),
      list_(options.guests.empty() ? configFolder() / "guests.textproto" : options.guests),
      hall_{mirror_.state(), list_, voice_, options.guest_mbit_per_s * kMega / kBitsPerByte},
      deaf_watch_(options.rejoin_after) {
    join();
}

void Gateway::join() {
    participant_.emplace(domain_);
    mirror_.join(*participant_);
    voice_.join(*participant_);
}

// Guests keep their places and what they are shown; the session sees them as if they had just come.
void Gateway::rejoinIfDeaf(Clock::time_point now) {
    const auto slept = deaf_watch_.pass(now);
    if (mirror_.lastHeard() != heard_) deaf_watch_.hear(now);
    mirror_.forgive(slept);
    heard_ = mirror_.lastHeard();
    if (!deaf_watch_.isDue(now)) return;
    ++rejoinings_;
    mirror_.leave();
    voice_.leave();
    participant_.reset();  // before the new one, or Cyclone would go on with what it has of this domain
    try {
        join();
    } catch (const UserError& error) {
        mirror_.leave();
        voice_.leave();
        spdlog::warn("the session cannot be joined anew: {}", error.what());
    }
}

bool Gateway::findPlaceFor(const GuestOrigin& comer) {
    Crowd crowd(comer);
    std::vector<Guest*> unknown;
    for (const auto& guest : guests_) {
        if (!guest->isUnknown()) continue;
        crowd.add(guest->origin());
        unknown.push_back(guest.get());
    }
    return crowd.findPlace(kMaxUnknown, [&](size_t n) { unknown[n]->makeRoom(); });
}

Guest* Gateway::come(const GuestOrigin& origin, Clock::time_point now) {
    if (!findPlaceFor(origin)) return nullptr;
    Guest* const guest = guests_.emplace_back(std::make_unique<Guest>(hall_, origin, now)).get();
    const auto failures = failures_.find(origin);
    if (failures != failures_.end() && now - failures->second.since < kFailuresLast &&
        failures->second.count >= kMaxFailures)
        guest->refuse("Too many wrong links came from this address: wait a minute.", false,
                      now + Guest::kRefusalDelay);
    return guest;
}

void Gateway::leave(Guest* guest) {
    if (guest->isAdmitted())
        log_.say(GuestLog::Level::kInfo, guest->speaker().name,
                 "guest " + guest->speaker().name + " has left" +
                     (guest->reason().empty() ? "" : ": " + guest->reason()),
                 Clock::now());
    std::erase_if(guests_, [guest](const auto& one) { return one.get() == guest; });
}

size_t Gateway::admittedCount() const {
    return size_t(std::ranges::count_if(guests_, [](const auto& guest) { return guest->isAdmitted(); }));
}

void Gateway::receive(Guest& guest, std::string_view frame, Clock::time_point now) {
    const bool was_admitted = guest.isAdmitted();
    if (!was_admitted && admittedCount() >= most_guests_)
        guest.refuse("There are as many guests as the gateway can serve: try again later.", false);
    guest.receive(frame, now);
    if (!was_admitted && guest.isAdmitted()) welcome(guest);
    if (!was_admitted && guest.hasFailed()) noteFailure(guest.origin(), now);
}

void Gateway::welcome(Guest& guest) {
    log_.say(GuestLog::Level::kInfo, guest.speaker().name,
             "guest " + guest.speaker().name + " (" + wordOf(guest.speaker().role) + ") has come from " +
                 guest.origin().text(),
             Clock::now());
    for (const auto& other : guests_)
        if (other.get() != &guest && other->seat() == guest.seat())
            other->refuse("This session goes on in another window.", true);
}

void Gateway::noteFailure(const GuestOrigin& origin, Clock::time_point now) {
    std::erase_if(failures_, [&](const auto& one) { return now - one.second.since >= kFailuresLast; });
    if (failures_.size() >= kMaxAddresses && !failures_.contains(origin)) return;
    Failures& failures = failures_[origin];
    if (++failures.count == 1) failures.since = now;
    if (failures.count <= kMaxFailures) noteComplaint(origin, "a wrong link came");
}

void Gateway::noteComplaint(const GuestOrigin& origin, const std::string& complaint) {
    log_.say(GuestLog::Level::kWarning, origin.text(), complaint + ", from " + origin.text(), Clock::now());
}

void Gateway::step(Clock::time_point now) {
    const bool wants_bricks =
        std::ranges::any_of(guests_, [](const auto& guest) { return guest->wishesBricks(); });
    mirror_.hearBricks(wants_bricks);
    const SessionChanges changes = mirror_.poll();
    if (!changes.isEmpty())
        for (const auto& guest : guests_) guest->note(changes);
    // Guests know newer runs by their number; to an older one they come as if for the first time.
    if (mirror_.state().epoch < std::exchange(epoch_, mirror_.state().epoch))
        for (const auto& guest : guests_)
            guest->refuse(
                "Another server's session is shown from now on: reload the page, or start the viewer again.",
                true);
    if (now - looked_ >= kLookEvery) lookAtList(now);
    rejoinIfDeaf(now);
}

void Gateway::lookAtList(Clock::time_point now) {
    looked_ = now;
    list_.reread();
    for (const auto& guest : guests_) {
        if (!guest->isInvited(unixSeconds()))
            guest->refuse("This invitation has ended. Ask for a new one.", true);
        else if (!guest->isAsAdmitted())  // from here on he orders nothing; his ticket opens what he may now
            guest->refuse("This invitation was changed: come in again.", false);
    }
}

}  // namespace bonemill::gateway
