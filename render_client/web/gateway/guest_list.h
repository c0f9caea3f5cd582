// Who may come in: the invitations of the guests' file, which is read again when it changes, and the seats
// that were taken with them, which a file beside it keeps. For one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "proto/gateway.pb.h"

namespace bonemill::gateway {

// $XDG_CONFIG_HOME/bonemill, or ~/.config/bonemill.
std::filesystem::path configFolder();

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
