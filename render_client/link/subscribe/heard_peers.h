// Who is heard in a session: the server, and other viewers. It is for one thread.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

// When to join a DDS domain anew because nothing is heard there: a reader may have become deaf, also one that
// waits for its first server. For one thread.
class SilenceMonitor {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kFirstSilence{6000};
    static constexpr std::chrono::seconds kLongestSilence{30};

    // After so much silence, then twice as much and so on up to kLongestSilence.
    explicit SilenceMonitor(std::chrono::milliseconds first = kFirstSilence,
                            Clock::time_point now = Clock::now())
        : first_(first), patience_(first), since_(now) {}

    // Is to be told often that time passes. Returns how long the caller has slept in between, if it has:
    // silence in that time says nothing, and does not count.
    Clock::duration pass(Clock::time_point now) {
        const auto before = std::exchange(passed_, now).value_or(now);
        if (now - before < kSleep) return {};
        since_ += now - before;
        return now - before;
    }
    void hear(Clock::time_point now) {
        since_ = now;
        patience_ = first_;
    }
    // Returns true when the domain is to be joined anew, once for each silence.
    bool isDue(Clock::time_point now) {
        if (now - since_ < patience_) return false;
        patience_ = std::min<std::chrono::milliseconds>(2 * patience_, kLongestSilence);
        since_ = now;
        return true;
    }

  private:
    static constexpr std::chrono::seconds kSleep{1};

    std::chrono::milliseconds first_, patience_;
    Clock::time_point since_;  // it was joined, or something was heard
    std::optional<Clock::time_point> passed_;
};

// What a living server tells without a pause: its status, the tool while it ticks, nodes while some are
// missing. Each has a reader of its own, and each reader may become deaf by itself. For one thread.
class Hearing {
  public:
    using Clock = SilenceMonitor::Clock;
    enum Sense { kServer, kTool, kNodes, kSenses };

    explicit Hearing(std::chrono::milliseconds first = SilenceMonitor::kFirstSilence,
                     Clock::time_point now = Clock::now())
        : watches_{SilenceMonitor(first, now), SilenceMonitor(first, now), SilenceMonitor(first, now)} {}

    // As SilenceMonitor::pass().
    Clock::duration pass(Clock::time_point now) {
        Clock::duration slept{};
        for (SilenceMonitor& watch : watches_) slept = watch.pass(now);
        return slept;
    }
    // It was heard, or there is nothing to hear.
    void hear(Sense sense, Clock::time_point now) { watches_[sense].hear(now); }
    // Returns true when the domain is to be joined anew: once for each silence of any of them.
    bool isDue(Clock::time_point now) {
        bool is_due = false;
        for (SilenceMonitor& watch : watches_) is_due |= watch.isDue(now);
        return is_due;
    }

  private:
    std::array<SilenceMonitor, kSenses> watches_;
};

// Which server a writer belongs to: its DDS participant, also after the writer has gone.
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

// Which server's messages a viewer takes, where more than one gives the same session: two halves of a network
// that had been apart, or a stranger. A server is its DDS participant: all its writers are one. The viewer
// stays with the one it has for as long as that one lives; then it takes another that speaks as a server
// does, by Status, whatever its epoch.
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

// Who else is watching. It is bounded, whatever senders are invented: each participant speaks for few
// viewers, the last that it spoke for, and for none that another one speaks for; of too many the least recent
// goes of who has most.
class ViewerList {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kTimeout{4};
    static constexpr size_t kMaxViewers = 256;
    static constexpr size_t kMaxOfParticipant = 64;  // a gateway's guests

    // `participant` is who tells of this viewer (dds::Reader::participantOf).
    void hear(topics::Viewer viewer, uint64_t participant, Clock::time_point now);
    // Forgets those that were not heard within kTimeout.
    void forgetSilent(Clock::time_point now);
    // Returns them by sender.
    std::vector<topics::Viewer> viewers() const;

  private:
    struct Heard {
        topics::Viewer viewer;
        uint64_t participant = 0;
        Clock::time_point at;
    };
    std::map<uint64_t, Heard> heard_;  // by sender
};

}  // namespace bonemill
