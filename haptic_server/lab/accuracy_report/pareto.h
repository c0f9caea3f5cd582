// Finds the settings that are worth having: error against time.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace bonemill {

struct ParetoPoint {
    double error = 0;
    double time = 0;
    bool is_candidate =
        true;  // false: its error is not one (another law); never on the front, never proposed
};

// Says of each point whether no other candidate is at least as good in both and better in one. Equal points
// are both on the front.
std::vector<bool> paretoFront(std::span<const ParetoPoint> points);

// Errors that differ by less than this part are the same for a choice.
inline constexpr double kSameError = 0.02;

// This is the most accurate candidate with time <= budget, and of those with the same error the fastest one.
std::optional<size_t> bestWithin(std::span<const ParetoPoint> points, double budget);

// This is the fastest candidate whose error is smaller than that of `from`, and not the same.
std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from);

}  // namespace bonemill
