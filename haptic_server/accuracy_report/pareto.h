// Which settings are worth having: error against time.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace bonemill {

struct ParetoPoint {
    double error = 0;
    double time = 0;
    bool is_candidate =
        true;  // false: its error is not one (thesis_2012); never on the front, never proposed
};

// For each point: no other candidate is at least as good in both and better in one. Equal points are both on
// the front.
std::vector<bool> paretoFront(std::span<const ParetoPoint> points);

// The most accurate candidate with time <= budget; of equals the faster one.
std::optional<size_t> bestWithin(std::span<const ParetoPoint> points, double budget);

// The fastest candidate on the front with a smaller error than `from`.
std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from);

}  // namespace bonemill
