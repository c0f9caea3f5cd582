// Which server's messages a viewer takes, where more than one gives the same session: two halves of a network
// that had been apart, or a stranger. A server is its DDS participant: all its writers are one. The viewer
// stays with the one it has for as long as that one lives; then it takes another that speaks as a server
// does, by Status, whatever its epoch. For one thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

namespace bonemill {

// Which server a writer belongs to: its DDS participant, also after the writer has gone. For one thread.
class ServerNumbers {
  public:
    // `participant` is that of the writer (dds::Reader::participantOf), 0 if it is not matched. A writer that
    // has gone is known from before; one that never was known stands for itself.
    uint64_t of(uint64_t participant, uint64_t writer) {
        const auto known = participants_.find(writer);
        if (participant == 0) return known == participants_.end() ? writer : known->second;
        if (participants_.size() >= kMaxWriters && known == participants_.end()) participants_.clear();
        participants_[writer] = participant;
        return participant;
    }
    void clear() { participants_.clear(); }

  private:
    static constexpr size_t kMaxWriters = 1024;  // bounds what invented ones can take

    std::map<uint64_t, uint64_t> participants_;  // by writer
};

class ServerChoice {
  public:
    using Clock = std::chrono::steady_clock;
    enum class Verdict {
        kOurs,   // of the server that is shown from now on, in epoch()
        kOlder,  // of a run of it that is over
        kOther,  // of another server
    };
    struct Message {
        uint64_t epoch = 0;   // unix ns, > 0
        uint64_t server = 0;  // who wrote it (dds::Reader::participantOf)
        bool is_status = false;
    };

    // `is_alive` says whether the server that is shown lives.
    Verdict judge(const Message& message, bool is_alive, Clock::time_point now);

    bool isOurs(uint64_t server) const { return has_server_ && server == ours_; }
    uint64_t epoch() const { return epoch_; }  // 0: none yet
    // Returns, once, whether messages of the server that is shown now were refused before.
    bool takeLost();
    // Returns whether another server spoke and was refused, which may be shown when ours is gone.
    bool hasCandidate() const;
    // The readers are new: what was refused comes again.
    void forgetRefused();
    // Another server of the session was heard for a while, and just now.
    bool hasOther(Clock::time_point now) const;

  private:
    static constexpr std::chrono::seconds kOtherFor{1}, kOtherUntil{3};
    static constexpr size_t kMaxOthers = 64;  // bounds what invented ones can take
    struct Other {
        bool speaks = false;  // by Status
        bool was_refused = false;
    };

    bool mayTake(const Message& message, bool is_alive) const;
    void take(const Message& message);
    void refuse(const Message& message, Clock::time_point now);

    bool has_server_ = false, has_spoken_ = false, has_lost_ = false;
    uint64_t ours_ = 0;
    uint64_t epoch_ = 0;
    std::map<uint64_t, Other> others_;
    std::optional<Clock::time_point> other_since_, other_last_;
};

}  // namespace bonemill
