// Decides which bricks of densities are written when, and makes their messages: what some viewer lacks or has
// of an older revision, in turns between the viewers, each brick no more often than a bound.
//
// It is for one normal thread; each call looks at a bounded number of bricks, however many are wished.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/density_codec/density_codec.h"
#include "haptic_server/surface/density_stream/density_source.h"

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

// What viewers want to see of the densities, and what they have of it (DensityWish of proto/densities.proto):
// the newest wish of each sender, within bounds, whatever arrives. It is for one thread and not RT-safe.
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

class DensityStream {
  public:
    static constexpr int64_t kChangePeriod_ns = 100'000'000;  // a brick that is milled goes out so often
    static constexpr int64_t kRepeat_ns = 1'000'000'000;      // it was on its way to all: whoever still lacks
                                                              // it gets it again after so long

    // `steps` are those of DensityEncoder. The source must outlive this object.
    DensityStream(const DensitySource& source, uint64_t epoch, uint16_t steps);

    // Payloads that are no wish of this epoch, or name what is not there, change nothing.
    void receive(uint64_t sender, uint64_t participant, std::span<const uint8_t> payload, int64_t now_ns);
    // Returns true if a viewer has said lately that it shows densities.
    bool isWished(int64_t now_ns);

    // Calls write(brick, payload) for bricks that are due, until it returns false, none is due, or enough was
    // looked at for now.
    using Write = std::function<bool(uint32_t brick, const std::string& payload)>;
    void round(int64_t now_ns, const Write& write);

  private:
    struct Brick {
        uint32_t current = 0;  // revision, as looked at last
        int64_t looked_ns = 0;
        uint32_t written = 0;    // revision
        int64_t written_ns = 0;  // 0: never
        int64_t whole_ns = 0;    // with the scanned part; 0: never
    };
    bool turn(DensityWishes::Wish& wish, int64_t now_ns, size_t& looks, const Write& write, bool& goes_on);
    bool isDue(const WishedBrick& wished, int64_t now_ns);
    std::string messageOf(uint32_t brick, bool is_whole, int64_t now_ns);

    const DensitySource& source_;
    uint64_t epoch_;
    DensityEncoder encoder_;
    DensityWishes wishes_;
    std::vector<Brick> bricks_;
    size_t turn_ = 0;  // of the wishes, whose it is
};

}  // namespace bonemill
