#include "haptic_server/core/contact/near_shell.h"

#include <cmath>

#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {

NearShell::NearShell(size_t most_points) : blocks_(most_points / ShellBlock::kCapacity + 1) {
    leaves_.reserve(kMostLeaves);
    for (ShellBlock& block : blocks_) {
        for (float& at : block.center) at = 0;
        block.radius = INFINITY;  // all its points are looked at
        block.next = std::exchange(free_, uint32_t(&block - blocks_.data()));
    }
}

void NearShell::forget() noexcept {
    for (KeptLeaf& kept : leaves_) release(kept);
    leaves_.clear();
    next_ = 0;
    travelled_ = 0;
}

// A fast tool, or one that must look far, would use a copy once or twice.
void NearShell::begin(const Gathering& g) noexcept {
    const Vector6d way = between(X_VT_, g.X_VT);
    const double step = way.head<3>().norm() + way.tail<3>().norm() * g.tool.reach();
    if (&g.shell != shell_ || g.level != level_ || &g.tool != tool_ || !(step < kFar))
        forget();
    else
        travelled_ += step;
    const bool pays = kFewestUses * step < kSkin && kFewestUses * g.margin < 2 * kSkin;
    allowance_ = pays ? kMostForCopies : 0;
    shell_ = &g.shell, level_ = g.level, tool_ = &g.tool, X_VT_ = g.X_VT, reach_ = g.reach;
    ++gathering_;
    next_ = 0;
}

void NearShell::end() noexcept {
    for (KeptLeaf& kept : leaves_)
        if (kept.gathering != gathering_) release(kept);
    std::erase_if(leaves_, [this](const KeptLeaf& kept) { return kept.gathering != gathering_; });
}

// Null: there is no copy. A leaf that has changed since the last gathering may change before each. A copy is
// made anew before it must be, so that they are not all due in the same tick.
const NearShell::KeptLeaf* NearShell::keep(LeafId leaf) noexcept {
    const uint32_t revision = shell_->revision(level_, leaf);
    KeptLeaf* kept = find(leaf);
    if (kept == nullptr) return nullptr;
    const bool was_known = kept->gathering != 0 && kept->revision == revision;
    kept->gathering = gathering_;
    if (!was_known) {
        release(*kept);
        kept->revision = revision;
        return nullptr;
    }
    const double left = kept->has_points ? kept->good_until - travelled_ - reach_ : -1;
    if (left < kSkin / 2 && allowance_ > 0) return copyNear(*kept) ? kept : nullptr;
    if (left < 0) return nullptr;
    point_tests_ += kept->looked_at - kept->count;
    return kept;
}

// Null: there is no room for one more.
NearShell::KeptLeaf* NearShell::find(LeafId leaf) noexcept {
    size_t at = next_;
    while (at < leaves_.size() && leaves_[at].leaf != leaf) ++at;
    if (at == leaves_.size()) {
        if (at == kMostLeaves) return nullptr;
        at = next_;
        leaves_.insert(leaves_.begin() + ptrdiff_t(at), {.leaf = leaf});
    }
    next_ = at + 1;
    return &leaves_[at];
}

// False: there is no room for them.
bool NearShell::copyNear(KeptLeaf& kept) noexcept {
    release(kept);
    constexpr int kBatch = PointBatch<float>::kCapacity;
    const auto within = float(reach_ + kSkin + 2 * tool_->distanceError());
    const Pose X_TV = X_VT_.inverse();
    const IntoTool<float> into_tool(X_VT_, Eigen::Vector3d::Zero());
    PointBatch<float> batch;
    alignas(64) float distance[kBatch];
    uint32_t last = kNoBlock;
    bool has_room = true;
    shell_->forEachBlock(level_, kept.leaf, [&](const ShellBlock& block, uint32_t count) {
        const Eigen::Vector3f center(block.center[0], block.center[1], block.center[2]);
        if (!has_room || tool_->distanceBound(X_TV * center.cast<double>()) > double(block.radius + within))
            return;
        into_tool.fill(batch, block.x, block.y, block.z, int(count));
        tool_->distances(batch, distance);
        kept.looked_at += count;
        for (uint32_t i = 0; i < count && has_room; ++i)
            if (distance[i] < within) has_room = append(kept, last, block, i);
    });
    point_tests_ += kept.looked_at;
    allowance_ = has_room ? allowance_ - std::min<size_t>(allowance_, kept.looked_at) : 0;
    if (!has_room) release(kept);
    kept.has_points = has_room;
    kept.good_until = travelled_ + reach_ + kSkin - kSlack;
    return has_room;
}

bool NearShell::append(KeptLeaf& kept, uint32_t& last, const ShellBlock& from, uint32_t point) noexcept {
    const uint32_t at = kept.count % ShellBlock::kCapacity;
    if (at == 0) {
        if (free_ == kNoBlock) return false;
        const uint32_t block = std::exchange(free_, blocks_[free_].next);
        (last == kNoBlock ? kept.first : blocks_[last].next) = block;
        blocks_[last = block].next = kNoBlock;
    }
    copyPoint(from, point, blocks_[last], at);
    ++kept.count;
    return true;
}

void NearShell::release(KeptLeaf& kept) noexcept {
    while (kept.first != kNoBlock) {
        const uint32_t block = std::exchange(kept.first, blocks_[kept.first].next);
        blocks_[block].next = std::exchange(free_, block);
    }
    kept.count = kept.looked_at = 0;
    kept.has_points = false;
}

}  // namespace bonemill
