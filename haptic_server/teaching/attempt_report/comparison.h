// An attempt beside those of experts in the same scene (how many standard deviations each figure is away, and
// the band in which experts are over the attempt) and beside the person's own (how a figure changes). It says
// what is different, not what is better. The functions are pure; any thread may call them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill {

// How a figure changes from attempt to attempt of one person: y_n = c + (y_1 - c) n^-b, where c is what it
// goes towards and b how fast.
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

struct ComparedFigure {
    std::string id;
    double z = 0;                    // (value - mean) / deviation
    double mean = 0, deviation = 0;  // of the experts
    size_t experts = 0;
};
// Of one column of the table "bucket": mean ± 2 deviations of the experts.
struct Envelope {
    std::string column_id;
    std::vector<double> low, high;  // NaN where experts have no such value
};
struct ExpertComparison {
    size_t experts = 0;
    std::vector<ComparedFigure> figures;
    std::vector<Envelope> envelopes;
};

inline constexpr size_t kMinExperts = 5;

// Of the results of experts only those of the same scene count, and of them figures of the same version.
// Nothing with fewer than kMinExperts; a figure that fewer have, or that is the same for all, is left out.
std::optional<ExpertComparison> compareWith(std::span<const AttemptResult> experts,
                                            const AttemptResult& result);

}  // namespace bonemill
