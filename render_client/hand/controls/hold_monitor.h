// Watches a tool that a mouse holds: has the bone caught it, and does it mill in the air?
//
// Units are s and m; any clock that goes on will do. It is a plain value, for one thread, and never throws.
#pragma once

#include <algorithm>
#include <cstdint>

namespace bonemill {

class HoldMonitor {
  public:
    static constexpr double kPatience = 2;    // s that the tool is caught, or mills in the air
    static constexpr double kFar = 6e-3;      // m from where it is wanted: more is caught
    static constexpr double kFarBurrs = 4;    // the same in burr radii, if that is more
    static constexpr int kMaxRescues = 2;     // in a row; then only the user can help
    static constexpr double kLongestGap = 1;  // s between two looks; what was in a longer one is not known

    enum class Advice {
        kNone,
        kFree,   // it is caught: to be put in front of the bone
        kHelp,   // that has not helped
        kTouch,  // the burr mills in the air
    };
    struct Sight {
        double now = 0;          // s
        double burr_radius = 0;  // m
        double from_wish = 0;    // m, of the simulated tool
        bool presses = false;    // the user mills, or adds
        bool touches = false;    // the simulated tool has contacts
        bool can_mill = true;    // it is not paused
    };

    // Looks at a tool that is held, once per picture. Each advice comes once.
    Advice look(const Sight& sight) {
        if (sight.now - seen_ > kLongestGap) caught_since_ = pressed_since_ = sight.now;
        seen_ = sight.now;
        const bool is_near = sight.from_wish <= std::max(kFar, kFarBurrs * sight.burr_radius);
        if (is_near) rescues_ = 0;
        if (is_near || sight.presses) caught_since_ = sight.now;
        if (!sight.presses) is_told_ = false;
        if (!sight.presses || sight.touches || !sight.can_mill) pressed_since_ = sight.now;
        if (sight.now - caught_since_ > kPatience && rescues_ <= kMaxRescues) {
            caught_since_ = sight.now;
            return ++rescues_ <= kMaxRescues ? Advice::kFree : Advice::kHelp;
        }
        if (is_told_ || sight.now - pressed_since_ <= kPatience) return Advice::kNone;
        is_told_ = true;
        return Advice::kTouch;
    }

  private:
    double seen_ = -1e9, caught_since_ = 0, pressed_since_ = 0;
    int rescues_ = 0;
    bool is_told_ = false;
};

}  // namespace bonemill
