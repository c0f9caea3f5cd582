// Decides which bricks of densities are written when, and makes their messages: what some viewer lacks or has
// of an older revision, in turns between the viewers, each brick no more often than a bound.
//
// It is for one normal thread; each call looks at a bounded number of bricks, however many are wished.
#pragma once

#include <functional>
#include <vector>

#include "common/density_codec/density_codec.h"
#include "haptic_server/surface/density_stream/density_source.h"
#include "haptic_server/surface/density_stream/density_wishes.h"

namespace bonemill {

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
