#include "haptic_server/surface/density_stream/density_stream.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>

#include "common/base/make_room.h"
#include "proto/topics.pb.h"

namespace bonemill {
namespace {

constexpr size_t kLongestWish = 64u << 10;  // bytes
constexpr size_t kMaxWanted = 16384;        // bricks: five planes of a scan of 900² voxels
constexpr int kMaxLacking = 1024;           // of them, in one message

bool readLacking(const topics::DensityWish& wish, uint32_t count, std::vector<WishedBrick>& bricks) {
    if (wish.lacking_size() > kMaxLacking) return false;
    for (const uint32_t brick : wish.lacking()) {
        if (brick >= count) return false;
        bricks.push_back({brick, kLackingBrick});
    }
    return true;
}

bool readHeld(const topics::DensityWish& wish, uint32_t count, std::vector<WishedBrick>& bricks) {
    if (wish.held_size() % 2 != 0) return false;
    uint64_t next = 0;
    for (int i = 0; i < wish.held_size(); i += 2) {
        const uint64_t first = next + wish.held(i), end = first + wish.held(i + 1);
        if (end > count || bricks.size() + (end - first) > kMaxWanted) return false;
        for (uint64_t brick = first; brick < end; ++brick) bricks.push_back({uint32_t(brick), 0});
        next = end;
    }
    return true;
}

// They name held bricks, in ascending order.
bool readRevisions(const topics::DensityWish& wish, std::span<WishedBrick> held) {
    if (wish.revisions_size() % 2 != 0) return false;
    auto at = held.begin();
    for (int i = 0; i < wish.revisions_size(); i += 2) {
        while (at != held.end() && at->brick < wish.revisions(i)) ++at;
        if (at == held.end() || at->brick != wish.revisions(i) || wish.revisions(i + 1) == kLackingBrick)
            return false;
        at->held = wish.revisions(i + 1);
    }
    return true;
}

constexpr size_t kMaxLooks = 4096;  // per round: some tens of microseconds
constexpr size_t kLooksPerTurn = 512;

}  // namespace

std::optional<std::vector<WishedBrick>> parseDensityWish(std::span<const uint8_t> payload, uint64_t sender,
                                                         uint64_t epoch, uint32_t brick_count) {
    const google::protobuf::LogSilencer silencer;
    topics::DensityWish wish;
    if (payload.size() > kLongestWish ||
        !wish.ParseFromArray(payload.data(), static_cast<int>(payload.size())) || wish.sender() != sender ||
        sender == 0 || wish.epoch() != epoch)
        return {};
    std::vector<WishedBrick> bricks;
    if (!readLacking(wish, brick_count, bricks)) return {};
    const size_t lacking = bricks.size();
    if (!readHeld(wish, brick_count, bricks) || !readRevisions(wish, std::span(bricks).subspan(lacking)))
        return {};
    return bricks;
}

void DensityWishes::receive(uint64_t sender, uint64_t participant, std::vector<WishedBrick> bricks,
                            int64_t now_ns) {
    auto wish = std::ranges::find(wishes_, sender, &Wish::sender);
    if (wish == wishes_.end()) {
        makeRoomFor(participant, wishes_, {kMaxSenders, kMaxOfParticipant}, &Wish::participant,
                    &Wish::heard_ns);
        wish = wishes_.insert(wishes_.end(), Wish{sender, participant, now_ns, {}});
    } else if (wish->participant != participant) {
        return;
    }
    *wish = {sender, participant, now_ns, std::move(bricks)};
}

void DensityWishes::forgetSilent(int64_t now_ns) {
    std::erase_if(wishes_, [now_ns](const Wish& wish) {
        return wish.bricks.empty() || now_ns - wish.heard_ns > kSilence_ns;
    });
}

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
