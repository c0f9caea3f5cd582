// What another program recorded (EEG, gaze, a force plate) as a table with a clock of its own, brought onto a
// session's clock by the beacons that it received (docs/reference/beacon.md). It is for one normal thread.
#pragma once

#include <string>

#include "haptic_server/recording/align/clock_fit.h"

namespace bonemill {

// FILE_aligned.csv of FILE.csv.
std::string alignedPathOf(const std::string& csv);

struct Alignment {
    ClockFit fit;
    size_t rows = 0;
    size_t other_beacons = 0;  // rows with a beacon of another recording, which do not count
    // For people.
    std::string text() const;
};

// Writes the table `csv` to `out` with one more column before all others, session_s. Its first line names the
// columns; `clock` is the one with its own time, the first one if empty. Rows in which beacon_session_ns
// holds a number give the pairs; where beacon_recording holds something it must be `journal_id`. Throws
// UserError: no such columns, a row without a time, no beacon of this recording, a file that cannot be read
// or written.
Alignment alignFile(const std::string& csv, const std::string& out, const std::string& clock,
                    const std::string& journal_id);

}  // namespace bonemill
