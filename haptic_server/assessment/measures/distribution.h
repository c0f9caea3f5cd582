// The distribution of a quantity that is never negative, in bounded memory: means and extremes are exact,
// quantiles right to half of kResolution of their value. One normal thread; add() allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace bonemill {

class Distribution {
  public:
    static constexpr double kResolution = 0.01;
    // Values below count as zero, those above as this much: 0.1 mN or µm to 100 kN, whatever the unit.
    static constexpr double kSmallest = 1e-7, kLargest = 1e5;

    // `weight` > 0, for instance the time for which the value held.
    void add(double value, double weight = 1) noexcept {
        if (!(weight > 0) || !std::isfinite(value)) return;
        bins_[binOf(value)] += weight;
        weight_ += weight;
        sum_ += value * weight;
        max_ = std::max(max_, value);
    }

    double weight() const noexcept { return weight_; }
    double sum() const noexcept { return sum_; }  // of value * weight
    // Those below are NaN of an empty distribution.
    double mean() const noexcept { return sum_ / weight_; }
    double max() const noexcept { return weight_ > 0 ? max_ : std::numeric_limits<double>::quiet_NaN(); }
    // The value below which this share (0 to 1) of all weight lies.
    double quantile(double share) const noexcept {
        if (!(weight_ > 0)) return std::numeric_limits<double>::quiet_NaN();
        double below = 0;
        for (size_t bin = 0; bin < kBins; ++bin) {
            below += bins_[bin];
            if (below >= share * weight_) return std::min(valueOf(bin), max_);
        }
        return max_;
    }
    double median() const noexcept { return quantile(0.5); }

  private:
    static constexpr size_t kBins = 2780;  // ln(kLargest / kSmallest) / ln(1 + kResolution), and one for zero

    static size_t binOf(double value) noexcept {
        if (!(value >= kSmallest)) return 0;
        const double bin = 1 + std::log(value / kSmallest) / std::log1p(kResolution);
        return std::min(kBins - 1, size_t(bin));
    }
    static double valueOf(size_t bin) noexcept {
        return bin == 0 ? 0 : kSmallest * std::exp((double(bin) - 0.5) * std::log1p(kResolution));
    }

    std::array<double, kBins> bins_{};
    double weight_ = 0, sum_ = 0;
    double max_ = 0;
};

}  // namespace bonemill
