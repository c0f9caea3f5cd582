// The page of a class: for each scene how its attempts went, what was failed most and how each trainee came
// on. Self-contained HTML without scripts, which prints on A4. The function is pure; any thread may call it.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill {

inline constexpr char kClassPageName[] = "class.html";
inline constexpr size_t kMostOnPage = 400;  // attempts

// `results` are in the order of time. Links lead to the reports in `reports`, a folder beside the page.
std::string classPage(const std::vector<AttemptResult>& results, const std::string& reports);

}  // namespace bonemill
