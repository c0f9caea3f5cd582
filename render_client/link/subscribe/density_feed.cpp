#include "render_client/link/subscribe/density_feed.h"

#include <algorithm>

#include "render_client/link/subscribe/payloads.h"

namespace bonemill {
namespace {

constexpr size_t kMaxTaken = 1024;    // bricks per update: some 30 ms of decoding
constexpr size_t kMaxWished = 16384;  // as many as a server listens to
constexpr int kMaxLackingSaid = 1024;

}  // namespace

void DensityFeed::update(DensityStore& store, const DensityRun& run, int64_t now_ns,
                         const std::function<void(const std::string&)>& drop) {
    follow(store, run);
    if (!store.wanted().empty()) {
        wanted_ns_ = now_ns;
        if (!reader_) reader_.emplace(wire_);
        if (!writer_) writer_.emplace(wire_);
    }
    if (!reader_) return;
    take(store, run, drop);
    say(store, now_ns);
    if (now_ns - wanted_ns_ < kFarewell_ns) return;
    reader_.reset();
    writer_.reset();
}

void DensityFeed::follow(DensityStore& store, const DensityRun& run) {
    if (run.epoch != epoch_) {
        store.clear();
        epoch_ = run.epoch;
        wished_.clear();
    }
    if (!run.info || !run.info->has_densities()) return;
    const DensityGrid grid = densityGridOf(run.info->densities());
    if (store.grid() != grid) wished_.clear();  // its numbers are of other bricks
    store.setGrid(grid);
    air_ = run.info->densities().air();
}

void DensityFeed::take(DensityStore& store, const DensityRun& run,
                       const std::function<void(const std::string&)>& drop) {
    reader_->take(kMaxTaken, [&](const dds::DensityBrickSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_ || !store.grid()) return;
        // What others wish comes here, too.
        if (!std::ranges::binary_search(wished_, sample.brick)) return;
        if (!run.is_its(reader_->participantOf(info.writer), info.writer)) return;
        const auto message = parseDensityBrick(dds::payloadOf(sample));
        if (message && message->epoch() != epoch_) return;
        if (!message || !apply(store, sample.brick, *message))
            drop("density brick " + std::to_string(sample.brick));
    });
}

// False says that it makes no sense.
bool DensityFeed::apply(DensityStore& store, uint32_t brick, const topics::DensityBrick& message) {
    const DensityBrick* const held = store.find(brick);
    if (held ? message.revision() <= held->revision : message.scanned().empty()) return true;
    DensityBrick next;
    next.revision = message.revision();
    if (held) {
        next.scanned = held->scanned;
        next.materials = held->materials;
    } else {
        auto scanned = decoder_.scanned(message.scanned(), store.grid()->brick_edge);
        if (!scanned) return false;
        auto materials = decoder_.materials(message.materials(), scanned->size());
        if (!materials) return false;
        next.scanned = std::move(*scanned);
        next.materials = std::move(*materials);
    }
    if (!message.change().empty()) {
        auto present = decoder_.present(message.change(), next.scanned);
        if (!present) return false;
        next.present = std::move(*present);
    }
    store.put(brick, std::move(next));
    ++taken_bricks_;
    return true;
}

bool DensityFeed::isAir(uint32_t brick) const {
    return uint8_t(air_[brick / 8]) >> brick % 8 & 1;
}

// What was scanned as air comes into the store at once: nobody sends it.
topics::DensityWish DensityFeed::wishOf(DensityStore& store) {
    topics::DensityWish wish;
    wish.set_epoch(epoch_);
    wish.set_sender(sender_);
    wished_ = store.wanted();
    if (wished_.size() > kMaxWished) wished_.resize(kMaxWished);
    const std::vector<uint32_t> by_importance = wished_;
    std::ranges::sort(wished_);
    wished_.erase(std::unique(wished_.begin(), wished_.end()), wished_.end());
    for (const uint32_t brick : by_importance) {
        if (store.find(brick)) continue;
        if (isAir(brick))
            store.put(brick, {std::vector<uint16_t>(brickVoxels(*store.grid())), {}, {}, 0});
        else if (wish.lacking_size() < kMaxLackingSaid)
            wish.add_lacking(brick);
    }
    uint32_t run = 0, end = 0;  // bricks of the last run, and the one behind it
    for (const uint32_t brick : wished_) {
        const DensityBrick* const held = store.find(brick);
        if (!held) continue;
        if (run > 0 && brick == end) {
            wish.set_held(wish.held_size() - 1, ++run);
        } else {
            wish.add_held(brick - end);
            wish.add_held(run = 1);
        }
        end = brick + 1;
        if (held->revision == 0) continue;
        wish.add_revisions(brick);
        wish.add_revisions(held->revision);
    }
    return wish;
}

void DensityFeed::say(DensityStore& store, int64_t now_ns) {
    if (now_ns - said_ns_ < kWishPeriod_ns || !store.grid() || reader_->matchedWriters() == 0) return;
    const bool is_over = store.wanted().empty();
    if (is_over && wished_.empty()) return;
    const std::string bytes = wishOf(store).SerializeAsString();
    if (bytes == said_ && now_ns - said_ns_ < kRepeat_ns) return;
    if (!writer_->write(session_, sender_, bytes)) return;
    said_ = bytes;
    said_ns_ = now_ns;
}

}  // namespace bonemill
