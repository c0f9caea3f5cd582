// Which server's messages a viewer takes, where more than one gives the same session: two halves of a network
// that had been apart, or a stranger. The viewer stays with the one it has for as long as that one lives. For
// one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>

namespace bonemill {

class ServerChoice {
  public:
    using Clock = std::chrono::steady_clock;
    enum class Verdict {
        kOurs,   // of the server that is shown from now on
        kOlder,  // of a run before it, or of a server that is older
        kOther,  // of a newer server, while ours lives
    };

    // Judges a message of this epoch (unix ns, > 0) from this writer (dds::SampleInfo::writer); `is_alive`
    // says whether the server that is shown lives. One that begins a new epoch is known by its writers.
    Verdict judge(uint64_t epoch, uint64_t writer, bool is_alive, Clock::time_point now);

    // What this writer removes is not ours.
    bool isOther(uint64_t writer) const { return others_.contains(writer); }
    // Messages of a newer server were refused: they must be asked for again before it can be shown.
    bool hasRefused() const { return has_refused_; }
    // Messages of our own server were refused: its writers were not all known when it began a new epoch.
    bool hasLost() const { return has_lost_; }
    // The readers are new, and so are the writers' numbers; who answers is not known yet.
    void forgetWriters();
    // Another server of the session was heard for a while, and just now.
    bool hasOther(Clock::time_point now) const;

  private:
    static constexpr std::chrono::seconds kOtherFor{1}, kOtherUntil{3};
    static constexpr size_t kMostWriters = 256;  // bounds what invented ones can take

    void hearOther(Clock::time_point now);

    uint64_t epoch_ = 0;
    std::set<uint64_t> ours_, before_, others_;  // writers: of our server, of the run before, of others
    bool has_refused_ = false;
    bool has_lost_ = false;
    std::optional<Clock::time_point> other_since_, other_last_;
};

}  // namespace bonemill
