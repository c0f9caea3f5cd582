#include "render_client/controls/attempts_csv.h"

#include <cstdio>
#include <ctime>

namespace bonemill {
namespace {

constexpr char kHeader[] =
    "attempt,trainee,scene,start_utc,time_s,removed_mm3,max_force_n,structures_touched,damaged_mm3,"
    "least_distance_mm,max_protected_force_n,necrotic_mm3,max_temperature_c\n";

std::string cell(const std::string& text) {
    const bool is_formula = !text.empty() && std::string("=+-@\t\r").find(text[0]) != std::string::npos;
    std::string quoted = is_formula ? "\"'" : "\"";
    for (const char sign : text) {
        if (sign == '"') quoted += '"';
        quoted += sign;
    }
    return quoted + '"';
}

std::string cell(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", number);
    return text;
}

std::string startCell(int64_t stamp_ns) {
    const std::time_t seconds = std::time_t(stamp_ns / 1'000'000'000);
    std::tm utc{};
    char text[32] = "";
    if (stamp_ns > 0 && gmtime_r(&seconds, &utc))
        std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

template <class Names>
std::string joined(const Names& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : "; ") + name;
    return text;
}

std::string lineOf(const topics::Attempt& attempt) {
    const topics::Training& training = attempt.training();
    const auto known = [](bool has, double number) { return has ? cell(number) : std::string(); };
    return std::to_string(attempt.number()) + ',' + cell(attempt.trainee()) + ',' + cell(attempt.scene_id()) +
           ',' + startCell(attempt.start_stamp_ns()) + ',' + cell(attempt.time_s()) + ',' +
           cell(attempt.removed_mm3()) + ',' + cell(attempt.max_force_n()) + ',' +
           cell(joined(attempt.structures_touched())) + ',' +
           known(training.has_damaged_mm3(), training.damaged_mm3()) + ',' +
           known(training.has_least_distance_mm(), training.least_distance_mm()) + ',' +
           known(training.has_max_protected_force_n(), training.max_protected_force_n()) + ',' +
           known(training.has_necrotic_mm3(), training.necrotic_mm3()) + ',' +
           known(training.has_max_temperature_c(), training.max_temperature_c()) + '\n';
}

}  // namespace

std::string attemptsCsv(const topics::Lesson& lesson) {
    std::string text = kHeader;
    for (const topics::Attempt& attempt : lesson.attempts()) text += lineOf(attempt);
    return text;
}

}  // namespace bonemill
