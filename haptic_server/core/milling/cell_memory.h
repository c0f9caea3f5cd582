// Remembers something of cells from tick to tick: most of those that a burr mills are the same ones. The
// volume is tiled by cubes of kEdge³ cells, and cells at the same place of theirs share an entry, which the
// last one has.
//
// Construction allocates; all else is RT-safe, for one thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace bonemill {

template <class Value>
class CellMemory {
  public:
    static constexpr int kEdge = 32;

    CellMemory() : entries_(size_t(kEdge) * kEdge * kEdge) {}

    // The value that was remembered of this cell, or nullptr.
    const Value* find(const Eigen::Vector3i& cell) const noexcept {
        const Entry& entry = entries_[placeOf(cell)];
        return entry.era == era_ && entry.cell == cell ? &entry.value : nullptr;
    }
    const Value& remember(const Eigen::Vector3i& cell, const Value& value) noexcept {
        Entry& entry = entries_[placeOf(cell)];
        entry = {value, cell, era_};
        return entry.value;
    }
    void forgetAll() noexcept { ++era_; }

  private:
    struct Entry {
        Value value{};
        Eigen::Vector3i cell = Eigen::Vector3i::Zero();
        uint64_t era = 0;
    };
    static size_t placeOf(const Eigen::Vector3i& cell) noexcept {
        constexpr int kIn = kEdge - 1;  // cells lie at -1 and beyond
        return size_t((cell.x() & kIn) + kEdge * ((cell.y() & kIn) + kEdge * (cell.z() & kIn)));
    }

    std::vector<Entry> entries_;
    uint64_t era_ = 1;
};

}  // namespace bonemill
