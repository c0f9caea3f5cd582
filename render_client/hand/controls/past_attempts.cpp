#include "render_client/hand/controls/past_attempts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace bonemill {
namespace {

constexpr size_t kMostPictureBytes = size_t(1) << 20;

// Empty where there is none.
std::string pictureAt(const std::string& file) {
    std::error_code error;
    const uintmax_t size = std::filesystem::file_size(file, error);
    if (error || size > kMostPictureBytes) return "";
    std::string bytes(size, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(bytes.data(), std::streamsize(size));
    return stream ? bytes : "";
}

}  // namespace

std::vector<PastAttempt> pastAttemptsOf(const std::string& lines) {
    std::vector<PastAttempt> attempts;
    std::istringstream stream(lines);
    for (std::string line; std::getline(stream, line);) {
        if (std::ranges::count(line, '\t') != 5) continue;
        std::array<std::string, 6> fields;
        std::istringstream rest(line);
        for (std::string& field : fields) std::getline(rest, field, '\t');
        const size_t ending = fields[0].rfind(".json");
        if (ending == std::string::npos || ending == 0) continue;
        PastAttempt& attempt = attempts.emplace_back();
        attempt.stem = fields[0].substr(0, ending);
        attempt.recording = std::move(fields[1]);
        attempt.start = std::move(fields[2]);
        attempt.scene = std::move(fields[3]);
        attempt.trainee = std::move(fields[4]);
        attempt.score = std::move(fields[5]);
        attempt.picture = pictureAt(attempt.stem + ".png");
    }
    return attempts;
}

std::vector<const PastAttempt*> comparableAttempts(const SessionView& session) {
    std::vector<const PastAttempt*> attempts;
    if (!session.same_scene) return attempts;
    const auto isOwn = [own =
                            std::filesystem::path(session.recording).filename()](const PastAttempt& attempt) {
        return std::filesystem::path(attempt.recording).filename() == own;
    };
    const bool has_several = std::ranges::count_if(*session.same_scene, isOwn) > 1;
    for (const PastAttempt& attempt : *session.same_scene)
        if (!attempt.recording.empty() && (has_several || !isOwn(attempt))) attempts.push_back(&attempt);
    return attempts;
}

std::string resultStemOf(const topics::Attempt& attempt, const SessionView& session) {
    const std::string& name = attempt.verdict().results();
    const bool is_name = !name.empty() && name.find('/') == std::string::npos;  // not a place elsewhere
    return is_name && !session.class_folder.empty() ? session.class_folder + "/results/" + name : "";
}

std::string AttemptEnds::take(const SessionView& session) {
    if (!session.lesson) return "";
    const topics::Lesson& lesson = *session.lesson;
    const std::string stem =
        lesson.attempts().empty() ? "" : resultStemOf(*lesson.attempts().rbegin(), session);
    if (!std::exchange(has_looked_, true)) told_ = stem;
    if (lesson.is_running() || !session.is_complete || stem == told_) return "";
    return told_ = stem;
}

}  // namespace bonemill
