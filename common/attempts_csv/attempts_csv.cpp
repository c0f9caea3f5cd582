#include "common/attempts_csv/attempts_csv.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <ctime>

#include "common/text/csv_text.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

constexpr char kByteOrderMark[] = "\xEF\xBB\xBF";

std::string utcText(int64_t stamp_ns) {
    const std::time_t seconds = std::time_t(stamp_ns / 1'000'000'000);
    std::tm utc{};
    char text[32] = "";
    if (stamp_ns > 0 && gmtime_r(&seconds, &utc))
        std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text;
}

std::string asNoFormula(const std::string& text) {
    return !text.empty() && std::strchr("=+-@\t\r", text[0]) ? '\'' + text : text;
}

template <class Texts>
std::string joined(const Texts& texts) {
    std::string all;
    for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
    return all;
}

}  // namespace

std::string sceneTitle(const topics::Lesson& lesson, const std::string& id) {
    for (const topics::SceneChoice& scene : lesson.scenes())
        if (scene.id() == id && !scene.title().empty()) return scene.title();
    return id;
}

std::string attemptsHeaderLine() {
    return std::string(kByteOrderMark) + kAttemptsHeader + "\n";
}

size_t attemptColumns(const std::string& line) {
    const std::string all = kAttemptsHeader;
    const std::string header = line.starts_with(kByteOrderMark) ? line.substr(3) : line;
    const bool is_whole = header == all;
    if (!is_whole && !all.starts_with(header + ",")) return 0;
    const auto columns = size_t(1 + std::ranges::count(header, ','));
    return columns >= kFirstColumns ? columns : 0;
}

std::string attemptLine(const topics::Attempt& attempt, const std::string& scene, const std::string& chain,
                        size_t columns) {
    const topics::Training& training = attempt.training();
    const bool has_structures = training.has_damaged_mm3() || training.has_least_distance_mm() ||
                                training.has_max_protected_force_n();
    const auto orNone = [](bool is_measured, const std::string& text) {
        return text.empty() && is_measured ? std::string("none") : text;
    };
    const auto ifAny = [](bool is_there, double value) {
        return is_there ? printed("%.6g", value) : std::string();
    };
    const topics::Verdict& verdict = attempt.verdict();
    const std::array<std::string, kAttemptColumns> cells = {
        std::to_string(attempt.number()),
        utcText(attempt.start_stamp_ns()),
        csvText(attempt.trainee()),
        csvText(scene),
        printed("%.6g", attempt.time_s()),
        ifAny(!attempt.is_exam(), attempt.removed_mm3()),
        ifAny(!attempt.is_exam(), attempt.max_force_n()),
        ifAny(training.has_damaged_mm3(), training.damaged_mm3()),
        orNone(has_structures, ifAny(training.has_least_distance_mm(), training.least_distance_mm())),
        ifAny(training.has_max_protected_force_n(), training.max_protected_force_n()),
        ifAny(training.has_necrotic_mm3(), training.necrotic_mm3()),
        ifAny(training.has_max_temperature_c(), training.max_temperature_c()),
        csvText(orNone(has_structures, joined(attempt.structures_touched()))),
        csvText(orNone(attempt.has_training(), joined(training.warnings()))),
        verdict.has_passed() ? verdict.passed() ? "yes" : "no" : "",
        csvText(orNone(verdict.has_passed(), joined(verdict.failed_gates()))),
        ifAny(verdict.has_score_percent(), verdict.score_percent()),
        csvText(verdict.results()),
        chain};
    CsvLine line;
    for (size_t n = 0; n < std::min(columns, cells.size()); ++n) line.field(cells[n]);
    return line.text();
}

bool isAttemptOf(const std::string& line, const std::string& trainee) {
    constexpr size_t kTraineeColumn = 2;
    size_t column = 0;
    std::string cell;
    bool is_quoted = false;
    for (size_t at = 0; at < line.size(); ++at) {
        const char c = line[at];
        if (c == '"' && is_quoted && at + 1 < line.size() && line[at + 1] == '"') {
            cell += line[++at];
        } else if (c == '"') {
            is_quoted = !is_quoted;
        } else if (!is_quoted && (c == ',' || c == '\n' || c == '\r')) {
            if (column++ == kTraineeColumn) break;
            cell.clear();
        } else {
            cell += c;
        }
    }
    if (column < kTraineeColumn) return false;
    return cell == trainee || cell == asNoFormula(trainee);
}

std::string attemptsCsv(const topics::Lesson& lesson) {
    std::string text = attemptsHeaderLine();
    for (const topics::Attempt& attempt : lesson.attempts())
        text += attemptLine(attempt, sceneTitle(lesson, attempt.scene_id())) + "\n";
    return text;
}

}  // namespace bonemill
