// The sessions that servers give in a DDS domain, to choose from. It is for one thread, and not for the tick.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/dds/endpoint.h"

namespace bonemill {

struct ListedSession {
    uint32_t session = 0;
    std::string scene;      // as the server calls it
    uint64_t epoch_ns = 0;  // unix time of the server's start
    std::string host;       // the PC's name; empty: not known
};

class SessionList {
  public:
    // Throws UserError when the DDS domain cannot be joined.
    explicit SessionList(uint32_t domain) : participant_(domain), reader_(participant_) {}

    // Takes what has arrived. Never waits. Of two servers of a session the newest message counts.
    void poll();
    // Returns those whose server was heard within kTimeout, by number.
    std::vector<ListedSession> sessions() const;
    static constexpr std::chrono::seconds kTimeout{3};

  private:
    static constexpr size_t kMaxSessions = 256;  // bounds what invented ones can take

    struct Heard {
        ListedSession session;
        std::chrono::steady_clock::time_point at;
    };
    dds::Participant participant_;
    dds::Reader<dds::StatusSample> reader_;
    std::map<uint32_t, Heard> heard_;
};

// Returns one line for people: "session 3: tooth_corridor since 14:05:09 on lab-pc-2".
std::string sessionText(const ListedSession& session);

}  // namespace bonemill
