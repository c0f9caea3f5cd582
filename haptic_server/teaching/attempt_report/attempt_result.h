// One attempt as it is kept: whose it is (a pseudonym, never a name that the program could know for one),
// what it was about, and how it was judged. Plain values.
#pragma once

#include <cstdint>
#include <string>

#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {

struct AttemptResult {
    std::string pseudonym;
    uint32_t number = 0;  // since the server's start
    std::string scene_id, scene_title;
    std::string scene_hash;     // 16 hexadecimal digits, sceneHashOf()
    int64_t start_unix_ns = 0;  // CLOCK_REALTIME
    double duration_s = 0;      // without pauses
    std::string journal;        // the recording's file name; empty: there is none
    bool is_exam = false;
    Assessment assessment;
};

// 2026-11-25T01:53:09Z; empty for 0.
std::string utcText(const AttemptResult& result);
// 20261125T015309Z_P07_3, a file's name without its ending: the letters and digits of ASCII of a pseudonym,
// and _ for all others.
std::string fileStemOf(const AttemptResult& result);

}  // namespace bonemill
