#include "haptic_server/teaching/study/study_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "common/digest/digest.h"
#include "common/files/require_file.h"
#include "common/files/whole_file.h"
#include "haptic_server/teaching/study/shipped_files.h"

namespace bonemill::study {
namespace {

namespace fs = std::filesystem;

// Held while a command changes the study.
class FolderLock {
  public:
    explicit FolderLock(const fs::path& folder)
        : file_(open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW,
                     S_IRUSR | S_IWUSR)) {
        if (file_ < 0 || flock(file_, LOCK_EX | LOCK_NB) != 0) {
            const int reason = errno;
            if (file_ >= 0) close(file_);
            throw UserError(folder.string() +
                            (reason == EWOULDBLOCK
                                 ? ": another command is changing this study; try again"
                                 : std::string(": cannot be written (") + std::strerror(reason) + ")"));
        }
    }
    ~FolderLock() { close(file_); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int file_;
};

std::string textOf(const fs::path& path) {
    requireFile(path);
    std::ifstream file(path, std::ios::binary);
    if (!file || fs::is_directory(path)) throw UserError(path.string() + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

void makeStudy(const fs::path& folder) {
    if (fs::exists(folder / "protocol.json"))
        throw UserError((folder / "protocol.json").string() + ": is there already; a study is made once");
    writePrivateFile(folder / "protocol.json", exampleProtocol());
    for (const ShippedFile& form : shippedForms())
        writePrivateFile(folder / "forms" / (std::string(form.name)), form.text);
    chmod(folder.c_str(), S_IRWXU);
}

StudyFolder::StudyFolder(const fs::path& folder) : path_(folder) {
    if (!fs::is_regular_file(folder / "protocol.json"))
        throw UserError(folder.string() +
                        ": is no study (it has no protocol.json); make one with: study init " +
                        folder.string());
    const std::string text = textOf(folder / "protocol.json");
    protocol_ = parseProtocol(text, (folder / "protocol.json").string());
    protocol_digest_ = sha256OfText(text);
    for (const std::string& id : protocol_.formIds()) {
        const fs::path file = folder / "forms" / (id + ".json");
        Form form = readForm(file);
        if (form.id != id)
            throw UserError(file.string() + ": is the form \"" + form.id + "\"; rename the file");
        forms_.emplace(id, std::move(form));
    }
}

const Form& StudyFolder::form(const std::string& id) const {
    const auto found = forms_.find(id);
    if (found == forms_.end()) throw UserError("the protocol has no form \"" + id + "\"");
    return found->second;
}

Enrolled StudyFolder::enrolled() const {
    const fs::path file = path_ / "enrolled.json";
    Enrolled enrolled;
    if (!fs::exists(file)) return enrolled;
    const Json parsed = readJson(file);
    const JsonObject json(parsed, file.string());
    json.allowOnly({"people", "removed", "places"});
    enrolled.people = json.whole("people", 0, 1'000'000);
    enrolled.removed = json.whole("removed", 0, 1'000'000);
    const JsonObject places = json.object("places");
    for (const Group& group : protocol_.groups)
        if (places.has(group.id)) enrolled.places[group.id] = places.whole(group.id, 0, 1'000'000);
    return enrolled;
}

void StudyFolder::write(const Enrolled& enrolled) const {
    const Json json = {
        {"people", enrolled.people}, {"removed", enrolled.removed}, {"places", enrolled.places}};
    writePrivateFile(path_ / "enrolled.json", json.dump(1) + "\n");
}

fs::path StudyFolder::folderOf(const std::string& pseudonym) const {
    if (!isIdentifier(pseudonym))
        throw UserError("a pseudonym has 1 to 40 letters, digits, - or _, as P001: this one has others");
    return path_ / "participants" / pseudonym;
}

std::vector<std::string> StudyFolder::pseudonyms() const {
    std::vector<std::string> all;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_ / "participants", error))
        if (fs::exists(entry.path() / "participant.json")) all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
}

Participant StudyFolder::participant(const std::string& pseudonym) const {
    const fs::path file = folderOf(pseudonym) / "participant.json";
    if (!fs::exists(file)) throw UserError("the study has no participant " + pseudonym);
    Participant participant = parseParticipant(readJson(file), file.string());
    if (participant.pseudonym != pseudonym)
        throw UserError(file.string() + ": is of " + participant.pseudonym + "; it lies in the wrong folder");
    return participant;
}

Participant StudyFolder::participantOf(const std::string& session) const {
    if (!isUuid(session)) throw UserError("a session is named by its UUID, as study next prints it");
    for (const std::string& pseudonym : pseudonyms())
        if (Participant candidate = participant(pseudonym); candidate.find(session)) return candidate;
    throw UserError("the study has no session " + session);
}

std::vector<std::string> StudyFolder::formsOf(const Session& session) const {
    if (session.period > 0) return protocol_.forms_after_each;
    std::vector<std::string> forms = protocol_.forms_before;
    forms.insert(forms.end(), protocol_.forms_after.begin(), protocol_.forms_after.end());
    return forms;
}

Answers StudyFolder::answers(const Participant& participant, const std::string& session,
                             const std::string& form_id) const {
    const Form& to = form(form_id);
    const fs::path file = folderOf(participant.pseudonym) / (session + "." + form_id + ".json");
    if (!fs::exists(file)) {
        Answers draft;
        draft.study = protocol_.id;
        draft.pseudonym = participant.pseudonym;
        draft.session = session;
        draft.form = form_id;
        draft.form_digest = to.digest;
        return draft;
    }
    Answers answers = parseAnswers(readJson(file), file.string(), to);
    if (answers.pseudonym != participant.pseudonym || answers.session != session || answers.form != form_id)
        throw UserError(file.string() + ": holds other answers than its name says");
    return answers;
}

std::optional<RunRecord> StudyFolder::run(const Participant& participant, const std::string& session) const {
    const fs::path file = folderOf(participant.pseudonym) / (session + ".run.json");
    if (!fs::exists(file)) return {};
    return parseRun(readJson(file), file.string());
}

Participant StudyFolder::enrol(const std::string& group, const std::string& pseudonym) {
    if (!protocol_.findGroup(group)) throw UserError("the protocol has no group \"" + group + "\"");
    const FolderLock lock(path_);
    Enrolled counted = enrolled();
    ++counted.people;
    Participant participant;
    participant.pseudonym = pseudonym;
    if (pseudonym.empty()) {
        const std::string number = std::to_string(counted.people);
        participant.pseudonym = "P" + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number;
    }
    if (fs::exists(folderOf(participant.pseudonym)))
        throw UserError("there is a participant " + participant.pseudonym + " already");
    participant.group = group;
    participant.place = counted.places[group]++;
    participant.has_consent = true;
    participant.sessions.push_back({newUuid(), 0, "", "", 0});
    for (const PlannedSession& planned : plannedSessions(protocol_, group, participant.place))
        participant.sessions.push_back(
            {newUuid(), participant.sessions.size(), planned.condition, planned.task, planned.attempt});
    write(counted);  // first: a place that no participant has is better than one that two have
    writePrivateFile(folderOf(participant.pseudonym) / "participant.json", toJson(participant));
    return participant;
}

void StudyFolder::withdraw(const std::string& pseudonym, const std::string& reason) {
    if (!isPlainText(reason) || reason.size() > kMaxLetters)
        throw UserError("--reason: at most 1000 letters without control characters");
    const FolderLock lock(path_);
    Participant leaving = participant(pseudonym);
    leaving.has_withdrawn = true;
    leaving.withdrawal_reason = reason;
    writePrivateFile(folderOf(pseudonym) / "participant.json", toJson(leaving));
}

void StudyFolder::remove(const std::string& pseudonym) {
    const fs::path folder = folderOf(pseudonym);
    const FolderLock lock(path_);
    if (!fs::is_directory(folder) || fs::is_symlink(folder))
        throw UserError("the study has no participant " + pseudonym);
    Enrolled counted = enrolled();
    ++counted.removed;
    fs::remove_all(folder);
    write(counted);
}

void StudyFolder::save(const Answers& answers) {
    const FolderLock lock(path_);
    const fs::path folder = folderOf(answers.pseudonym);
    if (!fs::exists(folder / "participant.json"))
        throw UserError("the study has no participant " + answers.pseudonym + " (removed meanwhile?)");
    writePrivateFile(folder / (answers.session + "." + answers.form + ".json"), toJson(answers));
}

void StudyFolder::save(const std::string& pseudonym, const RunRecord& run) {
    const FolderLock lock(path_);
    writePrivateFile(folderOf(pseudonym) / (run.session + ".run.json"), toJson(run));
}

Answers StudyFolder::take(const fs::path& file, bool replace) {
    const Json json = readJson(file);
    const Answers taken = parseAnswers(json, file.string(), form(formOfAnswers(json, file.string())));
    if (taken.study != protocol_.id)
        throw UserError(file.string() + ": is of the study \"" + taken.study + "\", not of this one");
    const Participant owner = participantOf(taken.session);
    if (owner.pseudonym != taken.pseudonym)
        throw UserError(file.string() + ": names " + taken.pseudonym +
                        " with a session of another participant");
    const std::vector<std::string> asked = formsOf(*owner.find(taken.session));
    if (std::find(asked.begin(), asked.end(), taken.form) == asked.end())
        throw UserError(file.string() + ": the protocol does not ask for \"" + taken.form +
                        "\" in this session");
    const Answers before = answers(owner, taken.session, taken.form);
    const bool has_others = (!before.values.empty() || !before.left_out.empty()) &&
                            (before.values != taken.values || before.left_out != taken.left_out);
    if (has_others && !replace)
        throw UserError(file.string() +
                        ": this form has been answered otherwise in this session; use --replace "
                        "to put these answers in their place");
    save(taken);
    return taken;
}

}  // namespace bonemill::study
