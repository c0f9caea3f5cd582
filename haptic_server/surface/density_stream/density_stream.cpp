#include "haptic_server/surface/density_stream/density_stream.h"

#include <algorithm>

#include "proto/topics.pb.h"

namespace bonemill {
namespace {

constexpr size_t kMaxLooks = 4096;  // per round: some tens of microseconds
constexpr size_t kLooksPerTurn = 512;

}  // namespace

DensityStream::DensityStream(const DensitySource& source, uint64_t epoch, uint16_t steps)
    : source_(source), epoch_(epoch), encoder_(steps), bricks_(source.brickCount()) {}

void DensityStream::receive(uint64_t sender, uint64_t participant, std::span<const uint8_t> payload,
                            int64_t now_ns) {
    auto bricks = parseDensityWish(payload, sender, epoch_, source_.brickCount());
    if (bricks) wishes_.receive(sender, participant, std::move(*bricks), now_ns);
}

bool DensityStream::isWished(int64_t now_ns) {
    wishes_.forgetSilent(now_ns);
    return !wishes_.wishes().empty();
}

void DensityStream::round(int64_t now_ns, const Write& write) {
    wishes_.forgetSilent(now_ns);
    auto& wishes = wishes_.wishes();
    size_t looks = 0;
    bool goes_on = true;
    // It ends when all had a turn in which there was nothing to do for them.
    for (size_t idle = 0; goes_on && idle < wishes.size() && looks < kMaxLooks; ++turn_)
        idle = turn(wishes[turn_ % wishes.size()], now_ns, looks, write, goes_on) ? 0 : idle + 1;
}

// Writes one brick for this viewer at most; false says that there is none to look at any more for now.
bool DensityStream::turn(DensityWishes::Wish& wish, int64_t now_ns, size_t& looks, const Write& write,
                         bool& goes_on) {
    if (wish.next == 0 && now_ns - wish.last_end_ns < kChangePeriod_ns / 2) return false;
    const size_t end = std::min(wish.bricks.size(), wish.next + kLooksPerTurn);
    while (wish.next < end) {
        WishedBrick& wished = wish.bricks[wish.next++];
        ++looks;
        if (!isDue(wished, now_ns)) continue;
        const std::string message = messageOf(wished.brick, wished.held == kLackingBrick, now_ns);
        if (message.empty()) continue;  // it is just being milled: the next time
        goes_on = write(wished.brick, message);
        wished.held = bricks_[wished.brick].written;  // until the sender says otherwise
        break;
    }
    if (wish.next == wish.bricks.size()) {
        wish.next = 0;
        wish.last_end_ns = now_ns;
    }
    return true;
}

bool DensityStream::isDue(const WishedBrick& wished, int64_t now_ns) {
    Brick& brick = bricks_[wished.brick];
    if (wished.held == kLackingBrick) return brick.whole_ns == 0 || now_ns - brick.whole_ns >= kRepeat_ns;
    if (now_ns - brick.looked_ns >= kChangePeriod_ns / 2) {
        brick.current = source_.revision(wished.brick).value_or(brick.current);
        brick.looked_ns = now_ns;
    }
    if (wished.held == brick.current) return false;
    const bool was_written = brick.written_ns != 0 && brick.written == brick.current;
    return brick.written_ns == 0 ||
           now_ns - brick.written_ns >= (was_written ? kRepeat_ns : kChangePeriod_ns);
}

std::string DensityStream::messageOf(uint32_t brick, bool is_whole, int64_t now_ns) {
    topics::DensityBrick message;
    message.set_epoch(epoch_);
    const std::vector<Density> scanned = source_.scanned(brick);
    if (source_.revision(brick) != 0u) {
        const auto present = source_.present(brick);
        if (!present) return {};
        message.set_revision(present->revision);
        message.set_change(encoder_.change(scanned, present->densities));
    }
    if (is_whole) {
        message.set_scanned(encoder_.scanned(scanned, DensitySource::kBrickVoxels));
        message.set_materials(encoder_.materials(source_.materials(brick)));
    }
    Brick& state = bricks_[brick];
    state.written = message.revision();
    state.written_ns = now_ns;
    if (is_whole) state.whole_ns = now_ns;
    return message.SerializeAsString();
}

}  // namespace bonemill
