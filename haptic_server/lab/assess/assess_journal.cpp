#include "haptic_server/lab/assess/assess_journal.h"

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/lab/assess/judge_attempts.h"

namespace bonemill {
namespace {

AssessmentTarget targetOf(const AssessOptions& options, const Recording& recording,
                          const RecordedAttempt& attempt, const AttemptOutcome& judged) {
    AssessmentTarget target;
    target.folder = options.out;
    target.pseudonym = attempt.trainee;
    target.number = uint32_t(judged.index + 1);
    target.duration_s = judged.duration_s;
    target.start_unix_ns =
        recording.manifest().start_stamp_ns() + int64_t(judged.begin_s * double(kNsPerSecond));
    target.journal = options.journal.filename().string();
    return target;
}

}  // namespace

int assessJournal(const AssessOptions& options, std::ostream& said) {
    const Recording recording(options.journal);
    if (recording.manifest().has_what_if())
        throw UserError(options.journal.string() +
                        ": nobody did this, it is what might have been; no result is made of it");
    const std::vector<RecordedAttempt> attempts = recordedAttempts(recording.content());
    if (attempts.empty())
        throw UserError(options.journal.string() +
                        ": holds no attempt of a trainee; nothing can be assessed");
    FinalFiles files;
    AttemptsJudge judge(recording, attempts);
    judge.run([&](const AttemptOutcome& judged) {
        const AssessmentTarget target = targetOf(options, recording, attempts[judged.index], judged);
        const size_t problems = files.problems().size();
        const std::string stem = writeAssessment(target, judge.loaded(), judged.result, files);
        if (files.problems().size() == problems)
            said << "attempt " << target.number << " of " << target.pseudonym << ": results/" << stem << '\n';
    });
    for (const std::string& problem : files.problems()) said << "error: " << problem << '\n';
    return files.problems().empty() ? 0 : 1;
}

}  // namespace bonemill
