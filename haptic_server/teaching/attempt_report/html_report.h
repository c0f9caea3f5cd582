// The one page that people get of an attempt: self-contained HTML without scripts, which prints on A4. The
// function is pure; any thread may call it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "haptic_server/teaching/attempt_report/comparison.h"

namespace bonemill {

struct ReportPicture {
    std::string caption;
    std::string media_type;  // "image/png" or "image/svg+xml"
    std::string data;        // the file's bytes
};

struct ReportExtras {
    std::vector<ReportPicture> pictures;         // of over- and under-cut, for instance
    std::vector<AttemptResult> own;              // this person's in this scene, in order, this one the last
    std::optional<ExpertComparison> comparison;  // with experts
    double begin_s = 0;  // where the attempt begins in the session: moments count from there
};

// How all pages of a class begin, up to the body's content. `title` is any text.
std::string pageHead(const std::string& title);

std::string htmlReport(const AttemptResult& result, const ReportExtras& extras);

}  // namespace bonemill
