// The folder of a class' results: beside the class table, one JSON file and one report per attempt, the
// picture that a window may have left of its bone (STEM.png), and the statements for learning record stores.
// They say who did what, so that they are their user's alone. Normal threads; it waits for the disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "haptic_server/teaching/attempt_report/class_page.h"
#include "haptic_server/teaching/attempt_report/html_report.h"

namespace bonemill {

struct Forgotten {
    std::vector<std::string> deleted;   // one line for people per file or entry
    std::vector<std::string> problems;  // what could not be deleted, with its reason
};

// Deletes results, reports, pictures and statements of this pseudonym in the folders `results` and `experts`
// of a class' folder, whatever the files' names are.
Forgotten forgetResults(const std::filesystem::path& class_folder, const std::string& pseudonym);

// Throws UserError, which names the file, if it is no result that can be read.
AttemptResult readResultFile(const std::filesystem::path& file);

class ResultFolder {
  public:
    // `class_folder` is the class table's. The folder `results` in it is made with the first result; experts'
    // results lie in `experts`, where the teacher puts them.
    explicit ResultFolder(std::filesystem::path class_folder) : class_folder_(std::move(class_folder)) {}

    std::filesystem::path results() const { return class_folder_ / "results"; }
    std::filesystem::path experts() const { return class_folder_ / "experts"; }
    std::filesystem::path statements() const { return results() / "xapi.jsonl"; }
    std::filesystem::path classPage() const { return class_folder_ / kClassPageName; }

    // Writes STEM.json and STEM.html, each whole or not at all, and adds the statement. The report shows this
    // person's attempts before, and experts', as they lie there. `begin_s` is the attempt's in the session.
    // Throws UserError.
    void write(const AttemptResult& result, std::vector<ReportPicture> pictures, double begin_s) const;
    // The class' page, of the newest results that lie there: reading them takes a while. Throws UserError.
    void writeClassPage() const;

    // The results of one scene (by its hash) or of all with an empty hash, and of one person, or of everyone
    // with an empty pseudonym, in the order of time. A person's are looked for by the files' names. What is
    // no result is passed over: a person's edit must not cost the others theirs. At most kMaxRead files are
    // read, the newest by name.
    static constexpr size_t kMaxRead = kMostOnPage;
    static std::vector<AttemptResult> read(const std::filesystem::path& folder, const std::string& scene_hash,
                                           const std::string& pseudonym);

  private:
    std::filesystem::path class_folder_;
};

}  // namespace bonemill
