#include "haptic_server/server/replay/compared_attempt.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>
#include <vector>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

void requireSameScene(const Recording& other, const Recording& shown) {
    const journal::Manifest &its = other.manifest(), &wanted = shown.manifest();
    const std::string name = other.path().string(), scene = printableLine(its.scene_name());
    if (its.scene_hash() != wanted.scene_hash())
        throw UserError(name + ": is of the scene '" + scene + "'" +
                        (its.scene_name() == wanted.scene_name()
                             ? " in another version than what is replayed"
                             : ", what is replayed of '" + printableLine(wanted.scene_name()) + "'") +
                        ": compare attempts of the same scene");
    for (const journal::File& file : wanted.files()) {
        if (file.path() == wanted.scene_path()) continue;
        const auto is_same = [&](const journal::File& of_other) {
            return of_other.what() == file.what() && of_other.sha256() == file.sha256();
        };
        if (std::ranges::none_of(its.files(), is_same))
            throw UserError(
                name + ": its " + printableLine(file.what()) +
                " was another file than that of what is replayed: compare attempts on the same scan");
    }
}

RecordedAttempt attemptOfNumber(const Recording& recording, uint32_t number) {
    std::vector<RecordedAttempt> attempts = recordedAttempts(recording.content());
    if (number > attempts.size())
        throw UserError(recording.path().string() + ": the session has " + std::to_string(attempts.size()) +
                        " attempts, not " + std::to_string(number) + ": name one of them");
    if (attempts.empty()) return {};
    return std::move(number == 0 ? attempts.back() : attempts[number - 1]);
}

// A recording says no time of day of its attempts. Two of one person that took the same time to the
// millisecond are not told apart.
bool isOf(const AttemptResult& result, const RecordedAttempt& attempt) {
    constexpr double kSameS = 1e-3;
    return attempt.trainee == result.pseudonym &&
           (!attempt.time_s || std::abs(*attempt.time_s - result.duration_s) < kSameS);
}

RecordedAttempt attemptOfResult(const Recording& recording, const AttemptResult& result,
                                const fs::path& file) {
    std::vector<RecordedAttempt> attempts = recordedAttempts(recording.content());
    const auto found =
        std::ranges::find_if(attempts, [&](const RecordedAttempt& attempt) { return isOf(result, attempt); });
    if (found == attempts.end())
        throw UserError(file.string() + ": its attempt is not in " + recording.path().string() +
                        ": the recording is another one, or not whole");
    return std::move(*found);
}

fs::path recordingOf(const AttemptResult& result, const fs::path& file, const fs::path& recordings) {
    if (result.journal.empty())
        throw UserError(file.string() + ": the attempt was not recorded: choose one that was");
    const fs::path recording = recordings / fs::path(result.journal).filename();
    std::error_code error;
    if (!fs::is_regular_file(recording, error))
        throw UserError(file.string() + ": its recording " + printableLine(recording.string()) +
                        " is not there: choose an attempt that has one");
    return recording;
}

// By the server's CLOCK_REALTIME, from when the journal was begun on.
std::string textOf(const ComparedAttempt& compared) {
    const Recording& recording = *compared.recording;
    const double begin_s = recording.secondsOf(std::min(compared.attempt.begin, recording.ticks() - 1));
    const std::time_t start = recording.manifest().start_stamp_ns() / kNsPerSecond + std::time_t(begin_s);
    std::tm parts{};
    char when[32] = "";
    if (localtime_r(&start, &parts)) std::strftime(when, sizeof when, ", %Y-%m-%d %H:%M", &parts);
    const std::string who =
        compared.attempt.trainee.empty() ? recording.path().filename().string() : compared.attempt.trainee;
    return printableLine(who) + when;
}

}  // namespace

fs::path resultOfName(const AttemptFolders& folders, const std::string& name) {
    std::error_code error;
    for (const fs::directory_entry& of_class : fs::directory_iterator(folders.classes, error))
        for (const fs::path& part :
             {ResultFolder(of_class.path()).results(), ResultFolder(of_class.path()).experts()})
            if (fs::path file = part / (name + ".json"); fs::is_regular_file(file, error)) return file;
    throw UserError("no attempt called '" + repeatedText(name) + "' has left a result in " +
                    folders.classes.string() + ": choose one that `bonemill sessions` lists");
}

ComparedAttempt openCompared(const AttemptName& name, const AttemptFolders& folders, const Recording& shown) {
    ComparedAttempt compared;
    if (name.file.extension() == ".json") {
        const AttemptResult result = readResultFile(name.file);
        compared.recording =
            std::make_unique<const Recording>(recordingOf(result, name.file, folders.recordings));
        compared.attempt = attemptOfResult(*compared.recording, result, name.file);
    } else {
        compared.recording = std::make_unique<const Recording>(name.file);
        compared.attempt = attemptOfNumber(*compared.recording, name.number);
    }
    requireSameScene(*compared.recording, shown);
    compared.text = textOf(compared);
    return compared;
}

}  // namespace bonemill
