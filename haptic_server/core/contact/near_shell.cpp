#include "haptic_server/core/contact/near_shell.h"

#include <algorithm>

#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

constexpr int kBatch = PointBatch<float>::kCapacity;

}  // namespace

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
}

void NearShell::begin(const PointShell& shell, int level, const ToolField& tool, const Pose& X_VT,
                      double reach) noexcept {
    if (&shell != shell_ || level != level_ || &tool != tool_) forget();
    shell_ = &shell, level_ = level, tool_ = &tool;
    const Vector6d way = between(X_VT_, X_VT);
    const double step = way.head<3>().norm() + way.tail<3>().norm() * tool.reach();
    travelled_ += step;
    pays_ = step < kSkin / kFewestUses;
    X_VT_ = X_VT, reach_ = reach;
    ++gathering_;
    next_ = 0;
    renewOldest();
}

// One copy is made anew before it must be, so that they are not all due in the same tick.
void NearShell::renewOldest() noexcept {
    KeptLeaf* oldest = nullptr;
    for (KeptLeaf& kept : leaves_)
        if (kept.has_points && (oldest == nullptr || kept.good_until < oldest->good_until)) oldest = &kept;
    if (oldest != nullptr && oldest->good_until < travelled_ + reach_ + kSkin / 2) oldest->good_until = 0;
}

void NearShell::end() noexcept {
    for (KeptLeaf& kept : leaves_)
        if (kept.gathering != gathering_) release(kept);
    std::erase_if(leaves_, [this](const KeptLeaf& kept) { return kept.gathering != gathering_; });
}

// Null: there is no copy. A leaf that has changed since the last gathering may change before each.
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
    if (kept->has_points && travelled_ + reach_ <= kept->good_until) return kept;
    return pays_ && copyNear(*kept) ? kept : nullptr;
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
    const auto within = float(reach_ + kSkin + 2 * tool_->distanceError());
    const IntoTool<float> into_tool(X_VT_, Eigen::Vector3d::Zero());
    PointBatch<float> batch;
    alignas(64) float distance[kBatch];
    uint32_t last = kNoBlock;
    bool has_room = true;
    shell_->forEachBlock(level_, kept.leaf, [&](const ShellBlock& block, uint32_t count) {
        const Eigen::Vector3f center(block.center[0], block.center[1], block.center[2]);
        const Eigen::Vector3d center_T = X_VT_.inverse() * center.cast<double>();
        if (!has_room || tool_->distanceBound(center_T) > double(block.radius + within)) return;
        into_tool.fill(batch, block.x, block.y, block.z, int(count));
        tool_->distances(batch, distance);
        point_tests_ += count;
        for (int i = 0; i < int(count) && has_room; ++i)
            if (distance[i] < within) has_room = append(kept, last, block, i);
    });
    if (!has_room) release(kept);
    kept.has_points = has_room;
    kept.good_until = travelled_ + reach_ + kSkin - kSlack;
    return has_room;
}

bool NearShell::append(KeptLeaf& kept, uint32_t& last, const ShellBlock& from, int point) noexcept {
    const uint32_t at = kept.count % ShellBlock::kCapacity;
    if (at == 0) {
        if (free_ == kNoBlock) return false;
        const uint32_t block = std::exchange(free_, blocks_[free_].next);
        (last == kNoBlock ? kept.first : blocks_[last].next) = block;
        blocks_[last = block].next = kNoBlock;
    }
    ShellBlock& to = blocks_[last];
    to.x[at] = from.x[point], to.y[at] = from.y[point], to.z[at] = from.z[point];
    to.nx[at] = from.nx[point], to.ny[at] = from.ny[point], to.nz[at] = from.nz[point];
    to.area[at] = from.area[point], to.key[at] = from.key[point];
    ++kept.count;
    return true;
}

void NearShell::release(KeptLeaf& kept) noexcept {
    while (kept.first != kNoBlock) {
        const uint32_t block = std::exchange(kept.first, blocks_[kept.first].next);
        blocks_[block].next = std::exchange(free_, block);
    }
    kept.count = 0;
    kept.has_points = false;
}

}  // namespace bonemill
