// Who may come in: the invitations of the guests' file, which is read again when it changes, and the seats
// that were taken with them, which a file beside it keeps. For one thread.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proto/gateway.pb.h"

namespace bonemill::gateway {

// Where guests come from, and how many may come from there. Of those who come through a relay the address is
// the relay's word: it tells them apart, and all of them together leave room for others, whatever the relay
// says.
struct GuestOrigin {
    std::string address;
    bool is_relayed = false;

    auto operator<=>(const GuestOrigin&) const = default;
    std::string text() const { return address + (is_relayed ? " through the relay" : ""); }
};

// So many at once.
struct CrowdBounds {
    size_t all;
    size_t of_address;
    size_t relayed;
};

// Those who are there, in the order in which they came, and one who comes.
class Crowd {
  public:
    explicit Crowd(GuestOrigin comer) : comer_(std::move(comer)) {}
    void add(const GuestOrigin& one) { there_.push_back(one); }
    bool hasPlace(const CrowdBounds& bounds) const {
        return countOfComer() < bounds.of_address && there_.size() < bounds.all && !isRelayFull(bounds);
    }
    // Where there is no place: which of them, counted from 0, is to go instead, so that nobody keeps others
    // out by many connections. It is the first of the address that has most of these places; nobody, where
    // the comer's has as many, or its share.
    std::optional<size_t> whoMakesRoom(const CrowdBounds& bounds) const {
        if (countOfComer() >= bounds.of_address) return std::nullopt;
        std::map<GuestOrigin, size_t> counts;
        for (const GuestOrigin& one : there_)
            if (one.is_relayed || !isRelayFull(bounds)) ++counts[one];
        const auto most = std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; });
        if (most == counts.end() || most->second <= countOfComer()) return std::nullopt;
        return size_t(std::ranges::find(there_, most->first) - there_.begin());
    }
    // True: there is a place, if need be once send_away(n) has made it.
    template <class SendAway>
    bool findPlace(const CrowdBounds& bounds, SendAway&& send_away) const {
        if (hasPlace(bounds)) return true;
        const auto leaver = whoMakesRoom(bounds);
        if (leaver) send_away(*leaver);
        return leaver.has_value();
    }

  private:
    size_t countOfComer() const { return size_t(std::ranges::count(there_, comer_)); }
    bool isRelayFull(const CrowdBounds& bounds) const {
        return comer_.is_relayed &&
               size_t(std::ranges::count_if(there_, &GuestOrigin::is_relayed)) >= bounds.relayed;
    }

    const GuestOrigin comer_;
    std::vector<GuestOrigin> there_;
};

struct Admission {
    std::string refusal;      // a sentence for the guest; empty: welcome
    bool is_final = false;    // trying again cannot help
    bool is_unknown = false;  // nobody was given this token
    std::string ticket;
    std::string ticket_sha256;  // tells seats apart
    std::string token_sha256;   // the invitation's
    std::string name;
    topics::Viewer::Role role = topics::Viewer::VIEWER;
    int64_t expires_s = 0;  // unix time; 0: does not end
};

class GuestList {
  public:
    static constexpr int kMaxInvitations = 1000;
    static constexpr uint32_t kMaxPeople = 64;  // per invitation

    // A file that is not there yet invites nobody. Throws UserError for one that cannot be read as a guest
    // list.
    explicit GuestList(std::filesystem::path file);

    // Looks whether the file is another one; returns true when it was read, which is logged. So is a file
    // that makes no sense: what was read before stays.
    bool reread();
    // Somebody comes with an invitation's token, which takes a seat, or with the ticket of a seat. It looks
    // at the file first.
    Admission admit(const std::string& token, int64_t now_s);
    // Whoever was admitted with this is still invited.
    bool isInvited(const std::string& token_sha256, int64_t now_s) const;
    // Nothing of what it was told then has changed in its invitation: the role, and when it ends.
    bool isAsAdmitted(const Admission& admission) const;
    int size() const { return guests_.invitations_size(); }

  private:
    bool read();
    const Invitation* find(const std::string& token_sha256) const;
    Admission admitTo(const Seat& seat, const Invitation& invitation, std::string ticket) const;
    void writeSeats() const;

    std::filesystem::path file_;
    std::filesystem::path seats_file_;
    std::string stamp_;  // of the file that was read
    Guests guests_;
    Seats seats_;
};

}  // namespace bonemill::gateway
