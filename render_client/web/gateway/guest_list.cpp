#include "render_client/web/gateway/guest_list.h"

#include <google/protobuf/text_format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "common/base/user_error.h"
#include "common/files/file_stamp.h"
#include "common/files/whole_file.h"
#include "common/secrets/secrets.h"
#include "common/text/foreign_text.h"

namespace bonemill::gateway {
namespace {

constexpr const char* kAskAgain = "Ask for a new invitation.";

template <class Message>
bool readText(const std::filesystem::path& file, Message& message) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return google::protobuf::TextFormat::ParseFromString(text.str(), &message);
}

bool isInvitation(const Invitation& invitation) {
    const std::string& hash = invitation.token_sha256();
    return hash.size() == 64 && hash.find_first_not_of("0123456789abcdef") == std::string::npos &&
           !invitation.name().empty() && invitation.name().size() <= 64 &&
           !hasUnprintable(invitation.name()) && invitation.people() <= GuestList::kMaxPeople &&
           topics::Viewer::Role_IsValid(invitation.role());
}

uint32_t peopleOf(const Invitation& invitation) {
    return std::max(invitation.people(), 1u);
}

bool hasExpired(const Invitation& invitation, int64_t now_s) {
    return invitation.expires_s() != 0 && now_s >= invitation.expires_s();
}

Admission refusal(std::string reason) {
    Admission admission;
    admission.refusal = std::move(reason);
    admission.is_final = true;
    return admission;
}

}  // namespace

GuestList::GuestList(std::filesystem::path file) : file_(std::move(file)), seats_file_(file_) {
    seats_file_ += ".seats";
    stamp_ = stampOf(file_);
    if (!stamp_.empty() && !read())
        throw UserError(file_.string() + ": is no list of guests; make it with deploy/security/invite");
    if (!readText(seats_file_, seats_)) {
        spdlog::warn("{}: makes no sense; those who were here come in again with their links",
                     seats_file_.string());
        seats_.Clear();
    }
}

bool GuestList::read() {
    Guests guests;
    if (!readText(file_, guests) || guests.invitations_size() > kMaxInvitations ||
        !std::ranges::all_of(guests.invitations(), isInvitation))
        return false;
    guests_ = std::move(guests);
    return true;
}

bool GuestList::reread() {
    const std::string stamp = stampOf(file_);
    if (std::exchange(stamp_, stamp) == stamp) return false;
    if (stamp.empty()) {
        guests_.Clear();
    } else if (!read()) {
        spdlog::warn("{}: is no list of guests; the one before stays in force", file_.string());
        return false;
    }
    spdlog::info("{} invitations are in force", size());
    return true;
}

// Every invitation is compared, so that the time tells nothing of the right one.
const Invitation* GuestList::find(const std::string& token_sha256) const {
    const Invitation* found = nullptr;
    for (const Invitation& invitation : guests_.invitations())
        if (isSameSecret(invitation.token_sha256(), token_sha256)) found = &invitation;
    return found;
}

bool GuestList::isInvited(const std::string& token_sha256, int64_t now_s) const {
    const Invitation* const invitation = find(token_sha256);
    return invitation && !hasExpired(*invitation, now_s);
}

bool GuestList::isAsAdmitted(const Admission& admission) const {
    const Invitation* const invitation = find(admission.token_sha256);
    return invitation && invitation->role() == admission.role &&
           invitation->expires_s() == admission.expires_s;
}

Admission GuestList::admit(const std::string& token, int64_t now_s) {
    reread();
    const std::string hash = sha256Hex(token);
    const Seat* known = nullptr;
    for (const Seat& seat : seats_.seats())
        if (isSameSecret(seat.ticket_sha256(), hash)) known = &seat;
    const Invitation* const invitation = find(known ? known->token_sha256() : hash);
    if (!invitation) {
        Admission unknown = refusal(std::string("This link is not valid, or it was withdrawn. ") + kAskAgain);
        unknown.is_unknown = true;
        return unknown;
    }
    if (hasExpired(*invitation, now_s)) return refusal(std::string("This link has expired. ") + kAskAgain);
    if (known) return admitTo(*known, *invitation, token);
    const auto of_invitation = [&](const Seat& seat) { return seat.token_sha256() == hash; };
    const auto taken = uint32_t(std::ranges::count_if(seats_.seats(), of_invitation));
    if (taken >= peopleOf(*invitation))
        return refusal(std::string("This link is already used, by another browser or viewer. ") + kAskAgain);
    const std::string ticket = randomToken();
    Seat seat;
    seat.set_token_sha256(hash);
    seat.set_ticket_sha256(sha256Hex(ticket));
    seat.set_number(taken + 1);
    // Seats of invitations that are gone are nobody's any more.
    auto& seats = *seats_.mutable_seats();
    seats.erase(std::remove_if(seats.begin(), seats.end(),
                               [this](const Seat& old) { return !find(old.token_sha256()); }),
                seats.end());
    *seats.Add() = seat;
    writeSeats();
    return admitTo(seat, *invitation, ticket);
}

Admission GuestList::admitTo(const Seat& seat, const Invitation& invitation, std::string ticket) const {
    Admission admission;
    admission.ticket = std::move(ticket);
    admission.ticket_sha256 = seat.ticket_sha256();
    admission.token_sha256 = seat.token_sha256();
    admission.name = invitation.name();
    if (peopleOf(invitation) > 1) admission.name += " " + std::to_string(seat.number());
    admission.role = invitation.role();
    admission.expires_s = invitation.expires_s();
    return admission;
}

void GuestList::writeSeats() const {
    std::string text;
    google::protobuf::TextFormat::PrintToString(seats_, &text);
    try {
        writePrivateFile(seats_file_, text);
    } catch (const std::exception& error) {
        spdlog::warn("{}; a gateway started anew will not know who was here", error.what());
    }
}

}  // namespace bonemill::gateway
