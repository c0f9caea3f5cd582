// What viewers want to see of the densities, and what they have of it (DensityWish of proto/densities.proto):
// the newest wish of each sender, within bounds, whatever arrives. It is for one thread and not RT-safe.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace bonemill {

inline constexpr uint32_t kLackingBrick = std::numeric_limits<uint32_t>::max();  // as a revision

struct WishedBrick {
    uint32_t brick;
    uint32_t held;  // the revision that the sender has, or kLackingBrick
    bool operator==(const WishedBrick&) const = default;
};

// Returns the wish of this sender and epoch for a grid of N bricks, what is lacking first; nothing for
// other bytes, and for wishes that are larger than any viewer's. It never throws on any bytes.
std::optional<std::vector<WishedBrick>> parseDensityWish(std::span<const uint8_t> payload, uint64_t sender,
                                                         uint64_t epoch, uint32_t brick_count);

class DensityWishes {
  public:
    static constexpr size_t kMaxSenders = 128;  // of more, the least recent of who has most is forgotten
    static constexpr size_t kMaxOfParticipant =
        64;  // a gateway's guests; of more, its least recent is forgotten
    static constexpr int64_t kSilence_ns = 5'000'000'000;  // whoever says nothing for so long shows nothing

    struct Wish {
        uint64_t sender;
        uint64_t participant;
        int64_t heard_ns;
        std::vector<WishedBrick> bricks;
        size_t next = 0;          // of them: those before were looked at
        int64_t last_end_ns = 0;  // all of them had been looked at then
    };

    // It replaces the sender's wish before, if that was of the same participant (dds::Reader::participantOf);
    // another one speaks for the sender only when it has fallen silent.
    void receive(uint64_t sender, uint64_t participant, std::vector<WishedBrick> bricks, int64_t now_ns);
    void forgetSilent(int64_t now_ns);

    std::vector<Wish>& wishes() { return wishes_; }

  private:
    std::vector<Wish> wishes_;
};

}  // namespace bonemill
