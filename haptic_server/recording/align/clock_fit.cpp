#include "haptic_server/recording/align/clock_fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/assert.h"

namespace bonemill {

// About the means: clocks may count from 1970, and the sums would lose what matters.
ClockFit fitClock(std::span<const ClockPair> pairs) {
    BONEMILL_ASSERT(!pairs.empty());
    ClockFit fit;
    fit.pairs = pairs.size();
    const auto count = double(pairs.size());
    for (const ClockPair& pair : pairs) {
        fit.foreign_mean += (pair.foreign - pairs[0].foreign) / count;
        fit.session_mean_s += (pair.session_s - pairs[0].session_s) / count;
    }
    fit.foreign_mean += pairs[0].foreign;
    fit.session_mean_s += pairs[0].session_s;
    double across = 0, squares = 0;
    for (const ClockPair& pair : pairs) {
        const double foreign = pair.foreign - fit.foreign_mean;
        across += foreign * (pair.session_s - fit.session_mean_s);
        squares += foreign * foreign;
    }
    if (squares > 0) fit.rate = across / squares;
    for (const ClockPair& pair : pairs) {
        const double off_s = std::abs(pair.session_s - fit.sessionOf(pair.foreign));
        fit.rms_s += off_s * off_s / count;
        fit.max_s = std::max(fit.max_s, off_s);
    }
    fit.rms_s = std::sqrt(fit.rms_s);
    return fit;
}

}  // namespace bonemill
