// Keeps the worst moments of an attempt, as many as a time-line can show. One normal thread; memory is
// bounded.
#pragma once

#include <algorithm>
#include <vector>

#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {

class WorstMoments {
  public:
    static constexpr size_t kMaxKept = 64;

    // When there are too many, the mildest goes.
    void add(Moment moment) {
        kept_.push_back(std::move(moment));
        if (kept_.size() <= kMaxKept) return;
        kept_.erase(std::ranges::min_element(kept_, {}, &Moment::severity));
    }
    std::vector<Moment> inOrder() const {
        std::vector<Moment> moments = kept_;
        std::ranges::stable_sort(moments, {}, &Moment::t_s);
        return moments;
    }

  private:
    std::vector<Moment> kept_;
};

// The `count` worst of them, the worst one first.
inline std::vector<Moment> worstOf(std::vector<Moment> moments, size_t count) {
    std::ranges::stable_sort(moments, std::ranges::greater{}, &Moment::severity);
    if (moments.size() > count) moments.resize(count);
    return moments;
}

}  // namespace bonemill
