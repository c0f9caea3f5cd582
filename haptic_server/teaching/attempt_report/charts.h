// The pictures of a report as SVG that stands in its HTML. They show the same on paper: no colour carries
// what a line or a word does not say too. The functions are pure; any thread may call them.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "haptic_server/teaching/attempt_report/comparison.h"

namespace bonemill {

// Force, removal and, where structures are protected, the distance to them over the time of the attempt, with
// the worst moments marked by their numbers. `begin_s` is where the attempt begins in the session. Empty
// without a table "second".
std::string timeLineSvg(const Assessment& assessment, std::span<const Moment> marked, double begin_s);

// A score from 0 to 1 as a bar.
std::string scoreBarSvg(double score);

// One dot per attempt, the last one filled, and the curve if there is one. `unit` as figures have it.
std::string attemptsSvg(std::span<const double> values, const std::string& unit,
                        const std::optional<LearningCurve>& curve);

// How many of these values lie in each tenth of their range: of 0 to 100 where they have no unit, else of 0
// to their largest.
std::string distributionSvg(std::span<const double> values, const std::string& unit);

// A column of the table "bucket" over the fifths of what was removed, and the band of the experts; empty if
// either is not there.
std::string envelopeSvg(const Assessment& assessment, const ExpertComparison& comparison,
                        const std::string& column_id);

}  // namespace bonemill
