// One attempt as it is kept: whose it is (a pseudonym, never a name that the program could know for one),
// what it was about, and how it was judged; as JSON, one file per attempt, and as a statement for learning
// record stores. Plain values; the functions are pure and allocate, any thread may call them.
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
    std::string chain;          // its link that covers the attempt, 64 hexadecimal digits; empty: none
    bool is_exam = false;
    Assessment assessment;
};

// 2026-11-25T01:53:09Z; empty for 0.
std::string utcText(const AttemptResult& result);
// 20261125T015309Z_P07_3, a file's name without its ending: the letters and digits of ASCII of a pseudonym,
// and _ for all others.
std::string fileStemOf(const AttemptResult& result);

inline constexpr size_t kMaxResult = size_t(16) << 20;  // bytes

std::string resultJson(const AttemptResult& result);

// The text may be a stranger's. Throws UserError, which names the file, for what is no result of this kind:
// JSON of another shape, numbers that are not finite where they must be, more figures or rows than an attempt
// can have.
AttemptResult parseResult(const std::string& text, const std::string& file);

// An attempt as a statement for learning record stores: xAPI 1.0.3, one JSON object on one line. The actor is
// the pseudonym. The verb is passed or failed where the task has gates, else completed; a score is there
// where the teacher gave weights. The statement's id is a UUID of whose attempt at what it is and when
// (version 5), so that the same attempt told twice is one.
std::string xapiStatement(const AttemptResult& result);

}  // namespace bonemill
