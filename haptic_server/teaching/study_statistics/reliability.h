// Whether items of a block, or raters, say the same. Pure; any thread may call them. A table has one row per
// person (or per rated thing), all of one length; what it cannot tell is NaN.
#pragma once

#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

using Table = std::vector<std::vector<double>>;

std::vector<double> columnOf(const Table& table, size_t column);

// Cronbach's (1951) alpha of the items in the columns.
double cronbachsAlpha(const Table& people_items);

// The agreement of raters in the columns, each rating all rows, as if each were alone: ICC(2,1) of Shrout and
// Fleiss (1979), two-way, random raters, absolute agreement.
double icc21(const Table& things_raters);

enum class KappaWeights { kNone, kQuadratic };

// Cohen's kappa of two raters on categories; with quadratic weights, the categories' values say how far apart
// they are.
double cohensKappa(Sample first, Sample second, KappaWeights weights);

}  // namespace bonemill::study
