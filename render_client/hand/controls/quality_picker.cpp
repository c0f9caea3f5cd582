#include "render_client/hand/controls/quality_picker.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace bonemill {

void QualityPicker::take(double picture_s, bool is_whole, double now_s) {
    if (!std::exchange(has_begun_, true)) since_s_ = now_s;
    if (!is_whole && quality_ == Quality::kQuick) return;
    times_.push_back(picture_s);
    if (times_.size() > kPictures) times_.pop_front();
    quality_ == Quality::kFull ? fall(now_s) : rise(now_s);
}

double QualityPicker::median() const {
    if (times_.size() < kPictures) return 0;
    std::vector<double> sorted(times_.begin(), times_.end());
    std::ranges::nth_element(sorted, sorted.begin() + kPictures / 2);
    return sorted[kPictures / 2];
}

void QualityPicker::fall(double now_s) {
    const bool is_trial = now_s - since_s_ < kTrial;
    if (!is_trial) wait_s_ = kFirstWait;
    // The first picture of a quality makes what it needs, and tells nothing.
    const bool is_hopeless = is_trial && times_.size() > 1 && times_.back() > kHopeless;
    if (median() > kSlow || is_hopeless) change(Quality::kQuick, now_s);
}

void QualityPicker::rise(double now_s) {
    if (now_s - since_s_ < wait_s_ || median() == 0 || *std::ranges::max_element(times_) > kFast) return;
    wait_s_ = std::min(wait_s_ * kLongerWait, kLongestWait);
    change(Quality::kFull, now_s);
}

void QualityPicker::change(Quality to, double now_s) {
    quality_ = to;
    since_s_ = now_s;
    times_.clear();
}

}  // namespace bonemill
