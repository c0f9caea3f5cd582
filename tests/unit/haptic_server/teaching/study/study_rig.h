// A study of two groups and two conditions in a temporary folder, for tests.
#pragma once

#include "haptic_server/teaching/study/study_folder.h"
#include "tests/support/process.h"

namespace bonemill::test {

inline constexpr char kSmallProtocol[] = R"({"study": "small", "title": "A | small study", "seed": 7,
  "groups": [{"id": "expert"}, {"id": "novice"}],
  "conditions": [{"id": "with"}, {"id": "without"}],
  "tasks": [{"id": "mill", "attempts": 2}],
  "forms_after_each": ["nasa_tlx_raw"], "forms_after": ["thesis_5_4", "sus"]})";

struct StudyRig {
    TemporaryFolder folder;
    std::string path = folder / "study";
    StudyRig() {
        study::makeStudy(path);
        writeFile(path + "/protocol.json", kSmallProtocol);
    }

    // What a page would have saved: every rating with the option or number that `value` gives.
    template <class ValueOf>
    study::Answers filled(const study::StudyFolder& study, const study::Participant& person,
                          const study::Session& session, const std::string& form,
                          const ValueOf& value) const {
        study::Answers answers = study.answers(person, session.uuid, form);
        for (const study::Item* item : study.form(form).items()) {
            if (item->is_rating)
                answers.values[item->id] = double(value(item->id));
            else
                answers.left_out.push_back(item->id);
        }
        return answers;
    }
};

}  // namespace bonemill::test
