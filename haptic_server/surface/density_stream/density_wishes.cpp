#include "haptic_server/surface/density_stream/density_wishes.h"

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

}  // namespace bonemill
