// How a figure changes from attempt to attempt of one person: y_n = c + (y_1 - c) n^-b, where c is what it
// goes towards and b how fast. The function is pure; any thread may call it.
#pragma once

#include <optional>
#include <span>

namespace bonemill {

struct LearningCurve {
    // With fewer attempts there is no curve to speak of, only dots.
    static constexpr size_t kMinAttempts = 6;

    double first = 0, limit = 0, rate = 0;  // y_1, c, b
    double deviation = 0;                   // of the attempts from the curve, root of the mean square

    double at(double attempt) const;
};

// Attempt n is values[n - 1]. Nothing for too few, for values that are not finite, and where all are the
// same.
std::optional<LearningCurve> fitLearningCurve(std::span<const double> values);

}  // namespace bonemill
