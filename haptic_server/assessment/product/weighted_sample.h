// Values that stand for areas: mean, spread and percentiles by area.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace bonemill {

class WeightedSample {
  public:
    void add(double value, double weight) { values_.push_back({value, weight}); }
    bool isEmpty() const noexcept { return values_.empty(); }

    double weight() const noexcept {
        double sum = 0;
        for (const auto& v : values_) sum += v.weight;
        return sum;
    }
    double mean() const noexcept {
        double sum = 0;
        for (const auto& v : values_) sum += v.weight * v.value;
        return sum / weight();
    }
    double deviation() const noexcept {
        const double middle = mean();
        double sum = 0;
        for (const auto& v : values_) sum += v.weight * (v.value - middle) * (v.value - middle);
        return std::sqrt(sum / weight());
    }
    // Of all weight, `share` (0 to 1) has values up to this one.
    double percentile(double share) const {
        std::vector<Value> sorted = values_;
        std::ranges::sort(sorted, {}, &Value::value);
        const double wanted = share * weight();
        double sum = 0;
        for (const Value& v : sorted)
            if ((sum += v.weight) >= wanted) return v.value;
        return sorted.back().value;
    }

  private:
    struct Value {
        double value, weight;
    };
    std::vector<Value> values_;
};

}  // namespace bonemill
