// Picks the quality of the pictures by how long they take, where nobody chose one. It is for any one thread;
// not RT-safe.
#pragma once

#include <cstddef>
#include <deque>

#include "render_client/look/camera/view_settings.h"

namespace bonemill {

// Full pictures that are slow become quick ones at once. Quick ones that would leave time for full ones
// become full on trial; each trial that fails makes the next one wait longer, so that the picture does not
// flap.
class QualityPicker {
  public:
    static constexpr double kSlow = 0.050;        // s a picture: 20 Hz, below which a moving burr jumps
    static constexpr double kHopeless = 0.150;    // s: one such picture ends a trial
    static constexpr double kFast = 0.025;        // s: half of kSlow, so that there is room between both
    static constexpr size_t kPictures = 15;       // that are judged
    static constexpr double kFirstWait = 5;       // s from a fall to the first trial
    static constexpr double kLongerWait = 4;      // factor after each trial that failed
    static constexpr double kLongestWait = 1280;  // s
    static constexpr double kTrial = 60;          // s that full pictures must last to be trusted

    // Software draws quickly at first, a graphics card in full.
    explicit QualityPicker(bool is_software) : quality_(is_software ? Quality::kQuick : Quality::kFull) {}

    // Takes how long (s) the last picture took, whether all of it was drawn (while the view rests only what
    // changed is, and that quick pictures are fast then tells nothing of full ones), and the time (s) by any
    // clock that goes on.
    void take(double picture_s, bool is_whole, double now_s);

    Quality quality() const { return quality_; }
    // Returns the median of the pictures that are judged (s); 0 while there are too few.
    double median() const;

  private:
    void fall(double now_s);
    void rise(double now_s);
    void change(Quality to, double now_s);

    Quality quality_;
    std::deque<double> times_;  // s, of the newest pictures of this quality
    double since_s_ = 0;        // when this quality began
    bool has_begun_ = false;
    double wait_s_ = kFirstWait;
};

}  // namespace bonemill
