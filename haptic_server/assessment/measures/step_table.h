// What happened in steps of a coordinate that only grows (time, or the removed volume), in bounded memory:
// when all rows are taken, two and two become one and steps are twice as wide. One normal thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace bonemill {

// Sums over one step, SI; temperatures in °C.
struct StepSums {
    double time = 0, contact_time = 0;                              // s
    double impulse = 0, max_force = 0;                              // N s in contact, N
    double way = 0;                                                 // m
    double removed = 0, seen = 0, unseen = 0;                       // m³
    double distance = std::numeric_limits<double>::infinity();      // m, least to a structure
    double temperature = -std::numeric_limits<double>::infinity();  // °C, highest

    void add(const StepSums& other) noexcept {
        time += other.time, contact_time += other.contact_time;
        impulse += other.impulse, max_force = std::max(max_force, other.max_force);
        way += other.way;
        removed += other.removed, seen += other.seen, unseen += other.unseen;
        distance = std::min(distance, other.distance);
        temperature = std::max(temperature, other.temperature);
    }
};

class StepTable {
  public:
    static constexpr size_t kMaxRows = 2048;

    // A row is `step` wide, > 0, at first.
    explicit StepTable(double step) : step_(step) {}

    // `at` >= 0; what is smaller than before belongs to the newest row.
    void add(double at, const StepSums& sums) {
        while (at / step_ >= double(kMaxRows)) widen();
        const size_t row = std::max(size_t(at / step_), rows_.empty() ? 0 : rows_.size() - 1);
        if (row >= rows_.size()) rows_.resize(row + 1);
        rows_[row].add(sums);
    }

    double step() const noexcept { return step_; }
    const std::vector<StepSums>& rows() const noexcept { return rows_; }

  private:
    void widen() {
        for (size_t row = 0; 2 * row < rows_.size(); ++row) {
            StepSums sums = rows_[2 * row];
            if (2 * row + 1 < rows_.size()) sums.add(rows_[2 * row + 1]);
            rows_[row] = sums;
        }
        rows_.resize((rows_.size() + 1) / 2);
        step_ *= 2;
    }

    double step_;
    std::vector<StepSums> rows_;
};

}  // namespace bonemill
