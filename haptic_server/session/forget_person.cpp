#include "haptic_server/session/forget_person.h"

#include <algorithm>
#include <filesystem>

#include "common/user_error.h"
#include "haptic_server/assessment_report/forget.h"
#include "haptic_server/session/class_table.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

void forgetInTables(const ForgetOptions& options, Forgotten& forgotten) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(options.folder, error)) {
        const std::string path = entry.path().string();
        if (entry.path().extension() != ".csv" || !ClassTable::isTable(path)) continue;
        try {
            if (const size_t lines = ClassTable::forget(path, options.pseudonym))
                forgotten.deleted.push_back(path + ": " + std::to_string(lines) + " lines");
        } catch (const UserError& problem) {
            forgotten.problems.emplace_back(problem.what());
        }
    }
}

// A recording is one session's, which may have been several people's.
void forgetRecordings(const ForgetOptions& options, Forgotten& forgotten) {
    const fs::path folder = options.recordings.empty() ? options.folder : options.recordings;
    const std::vector<std::string> of_others = recordingsOfOthers(options.folder);
    for (const std::string& name : forgotten.recordings) {
        const fs::path file = folder / fs::path(name).filename();
        std::error_code error;
        // A result may have been made by anybody, and name anything.
        if (file.extension() != ".mcap" || !fs::is_regular_file(fs::symlink_status(file, error))) continue;
        const auto isThis = [&](const std::string& other) {
            return fs::path(other).filename() == file.filename();
        };
        if (std::ranges::any_of(of_others, isThis))
            forgotten.problems.push_back(
                file.string() +
                ": holds other people's attempts, too; it is left, decide what to do with it");
        else if (fs::remove(file, error))
            forgotten.deleted.push_back(file.string());
        else
            forgotten.problems.push_back(file.string() + ": cannot be deleted: " + error.message());
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
