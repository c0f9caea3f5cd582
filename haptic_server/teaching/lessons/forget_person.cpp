#include "haptic_server/teaching/lessons/forget_person.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/recording/journal/journal_file.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"
#include "haptic_server/teaching/lessons/class_table.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// Below the recordings; so `bonemill what-if` puts them.
constexpr char kWhatIfs[] = "what_if";

void forgetInTables(const ForgetOptions& options, Forgotten& forgotten) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(options.folder, error)) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".csv") continue;
        try {
            if (!ClassTable::isTable(path)) continue;
            if (const size_t lines = ClassTable::forget(path, options.pseudonym))
                forgotten.deleted.push_back(path + ": " + std::to_string(lines) + " lines");
        } catch (const UserError& problem) {
            forgotten.problems.emplace_back(problem.what());
        }
    }
}

std::set<std::string> traineesOf(const fs::path& journal) {
    std::set<std::string> trainees;
    for (const journal::Event& event : readJournalContent(journal, KeepInputs::kNo).events)
        if (event.has_attempt_began()) trainees.insert(event.attempt_began());
    return trainees;
}

void remove(const fs::path& file, Forgotten& forgotten) {
    std::error_code error;
    if (fs::remove(file, error))
        forgotten.deleted.push_back(file.string());
    else
        forgotten.problems.push_back(file.string() + ": cannot be deleted: " + error.message());
}

// What its writer has not yet written may be of any person.
void forgetRecording(const fs::path& file, const std::string& pseudonym, Forgotten& forgotten) {
    if (isJournalWritten(file)) {
        forgotten.problems.push_back(file.string() +
                                     ": is being written, or cannot be read; end its session, and try again");
        return;
    }
    const std::set<std::string> trainees = traineesOf(file);
    if (!trainees.contains(pseudonym)) return;
    if (trainees.size() > 1) {
        forgotten.problems.push_back(
            file.string() + ": holds other people's attempts, too; it is left, decide what to do with it");
        return;
    }
    remove(file, forgotten);
    std::error_code error;
    for (const char* ending : {".html", ".json"})  // of a what-if
        if (const fs::path page = fs::path(file).replace_extension(ending); fs::exists(page, error))
            remove(page, forgotten);
}

// A recording is one session's, which may have been several people's. It says itself whose it is, also where
// a session was killed before there was a result.
void forgetRecordings(const ForgetOptions& options, Forgotten& forgotten) {
    std::error_code error;
    std::vector<fs::path> files;
    const std::string& folder = options.recordings.empty() ? options.folder : options.recordings;
    for (const fs::path& part : {fs::path(folder), fs::path(folder) / kWhatIfs})
        for (const fs::directory_entry& entry : fs::directory_iterator(part, error))
            if (entry.path().extension() == ".mcap" && fs::is_regular_file(entry.symlink_status(error)))
                files.push_back(entry.path());
    std::ranges::sort(files);
    for (const fs::path& file : files) {
        try {
            forgetRecording(file, options.pseudonym, forgotten);
        } catch (const UserError& problem) {
            forgotten.problems.push_back(file.string() + ": whose it is cannot be read: " + problem.what());
        }
    }
}

}  // namespace

int forgetPerson(const ForgetOptions& options, std::ostream& out) {
    std::error_code error;
    if (options.pseudonym.empty()) throw UserError("forget: give the pseudonym of the person");
    if (!fs::is_directory(options.folder, error))
        throw UserError("--in " + options.folder + ": no such folder; give the one of the class table");
    if (!options.recordings.empty() && !fs::is_directory(options.recordings, error))
        throw UserError("--recordings " + options.recordings + ": no such folder");
    Forgotten forgotten = forgetResults(options.folder, options.pseudonym);
    forgetInTables(options, forgotten);
    forgetRecordings(options, forgotten);
    for (const std::string& what : forgotten.deleted) out << "deleted " << what << '\n';
    for (const std::string& problem : forgotten.problems) out << "not deleted: " << problem << '\n';
    if (forgotten.deleted.empty() && forgotten.problems.empty())
        out << "there is nothing of '" << options.pseudonym << "' in " << options.folder << '\n';
    return forgotten.problems.empty() ? 0 : 1;
}

}  // namespace bonemill
