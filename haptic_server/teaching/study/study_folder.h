// A study on disk:
//
//   protocol.json             what was planned
//   forms/NAME.json           its questionnaires
//   enrolled.json             how many of each group came, so that no place and no pseudonym is given twice
//   participants/P001/        all that there is of a person: removed, it is gone
//     participant.json, SESSION.FORM.json, SESSION.run.json
//
// Everything is readable for its user alone, and whole or not there. One command at a time changes a study:
// it holds the lock of the folder. It is for one thread. Everything throws UserError.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "haptic_server/teaching/study/study_participant.h"

namespace bonemill::study {

// Makes the folder with the example's protocol and the shipped forms. Refuses a folder that has a protocol.
void makeStudy(const std::filesystem::path& folder);

// What was enrolled, and what of it is no longer there.
struct Enrolled {
    std::map<std::string, size_t> places;  // by group
    size_t people = 0;
    size_t removed = 0;
};

class StudyFolder {
  public:
    explicit StudyFolder(const std::filesystem::path& folder);

    const std::filesystem::path& path() const { return path_; }
    const Protocol& protocol() const { return protocol_; }
    const std::string& protocolDigest() const { return protocol_digest_; }
    const std::map<std::string, Form>& forms() const { return forms_; }
    const Form& form(const std::string& id) const;

    Enrolled enrolled() const;
    std::vector<std::string> pseudonyms() const;  // sorted
    Participant participant(const std::string& pseudonym) const;
    // Finds whose session it is.
    Participant participantOf(const std::string& session) const;

    // The forms of a session, in the order of the protocol.
    std::vector<std::string> formsOf(const Session& session) const;
    // An empty draft when there is nothing yet.
    Answers answers(const Participant& participant, const std::string& session,
                    const std::string& form_id) const;
    std::optional<RunRecord> run(const Participant& participant, const std::string& session) const;

    // They change the study.
    Participant enrol(const std::string& group, const std::string& pseudonym);
    void withdraw(const std::string& pseudonym, const std::string& reason);
    void remove(const std::string& pseudonym);
    void save(const Answers& answers);
    void save(const std::string& pseudonym, const RunRecord& run);
    // Takes in what a page saved. Refuses to replace other answers unless `replace`.
    Answers take(const std::filesystem::path& file, bool replace);

  private:
    std::filesystem::path folderOf(const std::string& pseudonym) const;
    void write(const Enrolled& enrolled) const;

    std::filesystem::path path_;
    Protocol protocol_;
    std::string protocol_digest_;
    std::map<std::string, Form> forms_;
};

}  // namespace bonemill::study
