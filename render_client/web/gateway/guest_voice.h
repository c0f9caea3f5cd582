// What guests say: reads their frames, and says in the session, by DDS, what they ask for, as the guest list
// knows them. For one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "proto/topics.pb.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill::gateway {

// So the session knows a guest.
struct Speaker {
    uint64_t sender = 0;
    std::string name;
    topics::Viewer::Role role = topics::Viewer::VIEWER;
    std::string link;  // "browser", "viewer"
};

class GuestVoice {
  public:
    // It has joined no domain yet, and nobody hears it.
    explicit GuestVoice(uint32_t session) : session_(session) {}

    // The participant must outlive the object, or leave() comes before. Throws UserError.
    void join(const dds::Participant& participant) { mouth_.emplace(participant); }
    void leave() { mouth_.reset(); }

    void announce(const Speaker& speaker, topics::Viewer viewer);
    // The role must be one that may order it (role_rules.h). A server that does not take commands is not
    // waited for again and again, while all guests wait: they are dropped for a second.
    void command(const Speaker& speaker, topics::Command command);
    void hand(const Speaker& speaker, topics::HandPointer hand);
    void wish(const Speaker& speaker, topics::DensityWish wish);

  private:
    // What it speaks to the domain by.
    struct Mouth {
        explicit Mouth(const dds::Participant& participant)
            : viewers(participant), hands(participant), commands(participant), wishes(participant) {}

        Outlet<dds::ViewerSample> viewers;
        Outlet<dds::HandPointerSample> hands;
        Outlet<dds::CommandSample> commands;
        Outlet<dds::DensityWishSample> wishes;
    };

    const uint32_t session_;
    std::optional<Mouth> mouth_;
    std::chrono::steady_clock::time_point deaf_until_;
};

inline constexpr size_t kMaxFrameBytes = 16 << 10;
// A guest that comes again lists what it holds.
inline constexpr size_t kMaxHelloBytes = 256 << 10;
inline constexpr size_t kMaxTokenBytes = 128;

// Reads what guests send: any bytes. Returns what the frame says if its numbers are ones to compute with;
// nothing for all else. Thread-safe; never throws on any bytes (other than std::bad_alloc).
std::optional<FromGuest> parseFromGuest(std::string_view frame);

}  // namespace bonemill::gateway
