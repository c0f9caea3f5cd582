// What the study keeps of a run on the simulator: enough to say what was used, and no more. Pure but for the
// files that it reads; it is for one thread.
#pragma once

#include <optional>

#include "haptic_server/teaching/study/study_participant.h"

namespace bonemill::study {

struct RunRecord {
    std::string session, scene, scene_sha256, programs;
    std::map<std::string, double> figures;  // those of the server's report that kRunFigures names
    std::string recording;                  // the journal's or trace's file name, as told
};

// Taken from a report of haptic_server, when it has them.
inline constexpr const char* kRunFigures[] = {
    "duration_s",    "nominal_rate_hz", "mean_rate_hz", "slowest_second_hz",
    "dropped_ticks", "force_max_n",     "removed_mm3",  "ticks"};

// Reads the report that haptic_server wrote with --report. Throws UserError.
std::map<std::string, double> figuresOfReport(const std::filesystem::path& report);

std::string toJson(const RunRecord& run);
RunRecord parseRun(const Json& json, const std::string& file);

}  // namespace bonemill::study
