// Attempts that have left a result on this PC: those of before, as the launcher lists them, and the one that
// has just ended. Plain values, for any thread.
#pragma once

#include <string>
#include <vector>

#include "render_client/hand/controls/session_view.h"

namespace bonemill {

// Reads what `bonemill sessions --tab-separated` prints, and the pictures that lie beside the results; a line
// that is none of its is passed over. It waits for the disk. Never throws.
std::vector<PastAttempt> pastAttemptsOf(const std::string& lines);

// Those of the same scene that a replay of this recording can be compared with: recorded ones, and of the
// recording itself only where it holds several.
std::vector<const PastAttempt*> comparableAttempts(const SessionView& session);

// Where the attempt's result and what belongs to it lie, without the ending: STEM.json, STEM.html, STEM.png.
// Empty where they are not on this PC, or not there yet.
std::string resultStemOf(const topics::Attempt& attempt, const SessionView& session);

// Tells of each attempt that ends while it watches, once the bone that it left is on the screen.
class AttemptEnds {
  public:
    // Once per picture. Returns the stem of the attempt that has just ended; empty: none has. An attempt that
    // is ended by the start of another has taken its bone along.
    std::string take(const SessionView& session);

  private:
    bool has_looked_ = false;
    std::string told_;
};

}  // namespace bonemill
