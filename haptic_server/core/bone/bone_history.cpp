#include "haptic_server/core/bone/bone_history.h"

#include <chrono>
#include <cstring>
#include <thread>

namespace bonemill {
namespace {

constexpr int kVoxelsPerVersion = 4;  // a look at a leaf's version takes as long
constexpr int kVoxelsLookedAtPerTick =
    32'768;  // eight leaves of 16³, some 30 µs; at least one leaf, however large

}  // namespace

// Keeps the tick from writing, from when it has finished what it was writing.
class BoneHistory::Hold {
  public:
    explicit Hold(BoneHistory& history) : history_(history) {
        history_.is_held_.store(true);
        while (history_.is_writing_.load()) std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    ~Hold() { history_.is_held_.store(false); }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

  private:
    BoneHistory& history_;
};

BoneHistory::BoneHistory(const BoneModel& bone)
    : scanned_(bone.volume.withoutSpareBricks()),
      now_(size_t(bone.lattice.leafCells().x()) + 1 + VoxelVolume::kReadSlack),
      then_(now_.size()) {
    orders_.push_back(std::make_unique<const Order>(Order{0, nullptr}));
    order_ = orders_.back().get();
}

std::shared_ptr<const BoneSnapshot> BoneHistory::snapshot(const BoneModel& bone) {
    if (isRestoring()) {
        const auto& target = orders_.back()->target;
        return target ? target : std::make_shared<const BoneSnapshot>();
    }
    Copies& copies = last_copies_;
    copies.resize(bone.lattice.leafCount());
    copyChanged(bone, copies);
    auto snapshot = std::make_shared<BoneSnapshot>();
    const Moment moment = copyWhole(bone, copies);
    snapshot->missing_voxels = moment.missing_voxels;
    snapshot->ticks = moment.ticks;
    for (const auto& copy : copies)
        if (copy && !copy->densities.empty()) snapshot->leaves.push_back(copy);
    return snapshot;
}

// Is there while no tick writes.
std::optional<BoneHistory::Moment> BoneHistory::moment() const noexcept {
    const Moment moment{written_ticks_.load(), missingVoxels()};
    if (is_writing_.load() || written_ticks_.load() != moment.ticks) return std::nullopt;
    return moment;
}

// A look that finds no version but those of the copies says that the bone was as they are when it began:
// versions only grow.
BoneHistory::Moment BoneHistory::copyWhole(const BoneModel& bone, Copies& copies) {
    constexpr int kLooks = 64;
    for (int look = 0; look < kLooks; ++look) {
        const std::optional<Moment> before = moment();
        const bool is_as_copied = !copyChanged(bone, copies);
        if (before && is_as_copied) return *before;
        if (!before) std::this_thread::sleep_for(std::chrono::microseconds(20));
    }
    const Hold hold(*this);
    copyChanged(bone, copies);
    return {written_ticks_.load(), missingVoxels()};
}

// Copies the leaves whose version is not the copied one, but for those that are written meanwhile. False:
// there were none.
bool BoneHistory::copyChanged(const BoneModel& bone, Copies& copies) const {
    bool is_any = false;
    for (LeafId leaf = 0; leaf < copies.size(); ++leaf) {
        const uint32_t version = bone.lattice.version(leaf);
        if (version == 0 || (copies[leaf] && copies[leaf]->version == version)) continue;
        is_any = true;
        if (version % 2 == 1) continue;
        auto copy = copyOf(bone, leaf, version);
        // The voxels were read with acquire, so this read cannot be older than they are.
        if (bone.lattice.version(leaf) == version) copies[leaf] = std::move(copy);
    }
    return is_any;
}

std::shared_ptr<const LeafCopy> BoneHistory::copyOf(const BoneModel& bone, LeafId leaf,
                                                    uint32_t version) const {
    const IndexBox cells = bone.lattice.cellsOf(leaf), voxels = voxelsOf(cells);
    const int count = voxels.max.x() - voxels.min.x() + 1;
    auto copy = std::make_shared<LeafCopy>(LeafCopy{leaf, version, {}});
    copy->densities.resize(size_t(voxels.count()));
    std::vector<Density> scanned(size_t(count) + VoxelVolume::kReadSlack);
    bool is_scanned = true;
    forEachRow(voxels, [&](const Eigen::Vector3i& first) {
        Density* const row = copy->densities.data() + placeOf(cells, first);
        Density* out = row;
        bone.volume.forEachRun(first, count, [&](size_t offset, int n) {
            for (int i = 0; i < n; ++i) *out++ = bone.volume.at(offset + size_t(i));
        });
        scanned_.readRow(first, count, scanned.data());
        is_scanned &= std::equal(row, row + count, scanned.data());
    });
    if (is_scanned) copy->densities = {};
    return copy;
}

VoxelVolume BoneHistory::volumeOf(const BoneSnapshot& snapshot, const LeafLattice& lattice) const {
    VoxelVolume volume = scanned_;
    const Eigen::Vector3i last = volume.dims().array() - 1;
    for (const auto& copy : snapshot.leaves) {
        const IndexBox cells = lattice.cellsOf(copy->leaf);
        forEachIndex(voxelsOf(cells).clamped(Eigen::Vector3i::Zero(), last), [&](const Eigen::Vector3i& v) {
            const Density density = copy->densities[placeOf(cells, v)];
            if (volume.at(v.x(), v.y(), v.z()) != density) volume.set(v.x(), v.y(), v.z(), density);
        });
    }
    return volume;
}

uint64_t BoneHistory::restore(std::shared_ptr<const BoneSnapshot> snapshot) {
    if (isRestoring() && snapshot == orders_.back()->target) return orders_.back()->number;
    const uint64_t number = orders_.back()->number + 1;
    orders_.push_back(std::make_unique<const Order>(Order{number, std::move(snapshot)}));
    const Order* replaced = next_order_.exchange(orders_.back().get(), std::memory_order_release);
    if (replaced) orders_.erase(orders_.end() - 2);  // the tick has never seen it
    const uint64_t taken_up = taken_up_.load(std::memory_order_acquire);
    while (orders_.front()->number < taken_up) orders_.pop_front();
    return number;
}

bool BoneHistory::beginWrite(uint64_t tick) noexcept {
    is_writing_.store(true);
    tick_ = tick;
    if (!is_held_.load()) return true;
    is_writing_.store(false);
    return false;
}

void BoneHistory::endWrite(uint32_t removed_voxels, uint32_t added_voxels) noexcept {
    missing_voxels_.store(missingVoxels() + int64_t(removed_voxels) - int64_t(added_voxels),
                          std::memory_order_relaxed);
    written_ticks_.store(tick_ + 1);
    is_writing_.store(false);
}

bool BoneHistory::takeUpNewestOrder() noexcept {
    if (!next_order_.load(std::memory_order_relaxed)) return is_restoring_;
    order_ = next_order_.exchange(nullptr, std::memory_order_acquire);
    taken_up_.store(order_->number, std::memory_order_release);
    next_leaf_ = 0;
    next_copy_ = 0;
    return is_restoring_ = true;
}

// Leaves are asked for in ascending order, as the target has them.
bool BoneHistory::isInTarget(LeafId leaf) noexcept {
    if (!order_->target) return false;
    const auto& leaves = order_->target->leaves;
    while (next_copy_ < leaves.size() && leaves[next_copy_]->leaf < leaf) ++next_copy_;
    return next_copy_ < leaves.size() && leaves[next_copy_]->leaf == leaf;
}

void BoneHistory::finishOrder() noexcept {
    is_restoring_ = false;
    finished_.store(order_->number, std::memory_order_release);
}

bool BoneHistory::restoreSome(BoneModel& bone, bool& shell_is_complete) noexcept {
    shell_is_complete = true;
    if (!takeUpNewestOrder()) return false;
    const int voxels_per_leaf = bone.lattice.leafCells().prod();
    for (int looked_at = 0; looked_at < kVoxelsLookedAtPerTick;) {
        // A version of 0 means that nothing near the leaf was ever written; only a snapshot of an earlier run
        // of the session can differ there.
        for (; next_leaf_ < bone.lattice.leafCount() && bone.lattice.version(next_leaf_) == 0 &&
               !isInTarget(next_leaf_) && looked_at < kVoxelsLookedAtPerTick;
             ++next_leaf_)
            looked_at += kVoxelsPerVersion;
        if (next_leaf_ == bone.lattice.leafCount()) {
            finishOrder();
            break;
        }
        if (looked_at >= kVoxelsLookedAtPerTick || restoreLeaf(bone, next_leaf_++, shell_is_complete)) break;
        looked_at += voxels_per_leaf;
    }
    return true;
}

void BoneHistory::restoreAll(BoneModel& bone) noexcept {
    for (bool shell_is_complete = true; restoreSome(bone, shell_is_complete);) {
    }
}

void BoneHistory::startFrom(BoneModel& bone, const std::shared_ptr<const BoneSnapshot>& snapshot) {
    restore(snapshot);
    takeUpNewestOrder();
    bool shell_is_complete = true;  // the first tick that mills there says if it is not
    for (const auto& copy : snapshot->leaves) restoreLeaf(bone, copy->leaf, shell_is_complete);
    finishOrder();
}

bool BoneHistory::restoreLeaf(BoneModel& bone, LeafId leaf, bool& shell_is_complete) noexcept {
    VoxelVolume& volume = bone.volume;
    const IndexBox cells = bone.lattice.cellsOf(leaf), voxels = voxelsOf(cells);
    const Density* copy = order_->target ? order_->target->densitiesOf(leaf) : nullptr;
    const int count = voxels.max.x() - voxels.min.x() + 1;
    IndexBox changed;
    forEachRow(voxels, [&](const Eigen::Vector3i& first) {
        if (!readRows(bone, cells, copy, first, count)) return;
        for (int i = 0; i < count; ++i)
            if (now_[size_t(i)] != then_[size_t(i)]) changed.include(first + Eigen::Vector3i(i, 0, 0));
    });
    if (changed.isEmpty()) return false;
    const int width = changed.max.x() - changed.min.x() + 1;
    int64_t lost = 0;
    bone.lattice.beginWrite(changed);
    forEachRow(changed, [&](const Eigen::Vector3i& first) {
        if (!readRows(bone, cells, copy, first, width)) return;
        lost += lostVoxels(width, volume.iso());
        volume.writeRow(first, width, then_.data());
    });
    bone.lattice.endWrite(changed);
    missing_voxels_.store(missingVoxels() + lost, std::memory_order_relaxed);
    bone.lattice.refreshRanges(volume, changed);
    shell_is_complete = bone.shell.refresh(volume, bone.lattice, {&changed, 1});
    return true;
}

// Reads the row now and as it was, from the leaf's copy or (null) the scanned bone; false means that they are
// the same.
bool BoneHistory::readRows(const BoneModel& bone, const IndexBox& cells, const Density* copy,
                           const Eigen::Vector3i& first, int count) noexcept {
    bone.volume.readRow(first, count, now_.data());
    if (copy)
        std::memcpy(then_.data(), copy + placeOf(cells, first), size_t(count) * sizeof(Density));
    else
        scanned_.readRow(first, count, then_.data());
    return std::memcmp(now_.data(), then_.data(), size_t(count) * sizeof(Density)) != 0;
}

// Counts the voxels of the row in hand that go below the iso-value, less those that come up to it.
int64_t BoneHistory::lostVoxels(int count, Density iso) const noexcept {
    int64_t lost = 0;
    for (size_t i = 0; i < size_t(count); ++i) lost += int(now_[i] >= iso) - int(then_[i] >= iso);
    return lost;
}

}  // namespace bonemill
