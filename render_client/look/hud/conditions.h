// Says in words what stands in the way of the session now, and what to do, and keeps what was a fault. The
// functions are pure, for any thread; a list is for one.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "render_client/look/hud/hud.h"
#include "render_client/look/hud/hud_lines.h"

namespace bonemill {

struct Condition {
    std::string id;    // the same while it lasts, whatever its words
    std::string text;  // UTF-8, a sentence or two; a plain fault is listed, but not said
    HudTone tone = HudTone::kPlain;
    bool is_fault = false;  // it stays in the list of faults
    bool lasts = true;      // false: it has happened since the server began, how often is unknown
};

// Puts the faults that the server names into words. Takes Status.fault_text, names with commas between them;
// of a name that this version does not know the text is the name. Repeated names count once. A plain one is a
// limit that did what it is for.
std::vector<Condition> faultWords(const std::string& names);

// The worst comes first.
std::vector<Condition> conditionsOf(const HudInput& input);

// A fault in the list.
struct FaultEntry {
    std::string text;
    HudTone tone = HudTone::kPlain;
    double first_s = 0;  // clock of the session
    double last_s = 0;
    int count = 0;
    bool lasts = false;  // it is not over
};

// Says what stands in the way: once, until it is over, and then fades. What was a fault stays in a list, with
// its time and how often it came. It is a plain value, for one thread.
class FaultList {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kShown{5000};  // at least
    static constexpr std::chrono::milliseconds kFade{1500};
    static constexpr size_t kMaxShown = 2;
    static constexpr size_t kMaxKept = 64;  // bounds what invented names can take

    // Takes what stands in the way at this time; session_s is the session's clock.
    void observe(const std::vector<Condition>& conditions, double session_s, Clock::time_point now);
    // Another session begins.
    void clear() { kept_.clear(); }

    // Returns what is to be said now: what lasts before what fades, the worst first, at most kMaxShown; of
    // more, the last one says how many.
    std::vector<HudNotice> said(Clock::time_point now) const;
    // The first fault comes first.
    std::vector<FaultEntry> faults() const;

  private:
    struct Kept {
        Condition condition;
        FaultEntry entry;
        bool is_present = false;  // in the last observation
        Clock::time_point began, ended;
    };
    Kept* find(const std::string& id);
    static bool isSaid(const Kept& kept);
    static float opacity(const Kept& kept, Clock::time_point now);
    static void begin(Kept& kept, double session_s, Clock::time_point now);

    std::vector<Kept> kept_;
};

}  // namespace bonemill
