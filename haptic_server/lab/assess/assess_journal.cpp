#include "haptic_server/lab/assess/assess_journal.h"

#include <optional>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/lab/simulate/task_run.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/rerun.h"

namespace bonemill {
namespace {

// Follows the attempts of a recording through its ticks.
class JournalAssessment {
  public:
    JournalAssessment(const AssessOptions& options, std::ostream& said)
        : options_(options),
          said_(said),
          recording_(options.journal),
          loaded_(recording_.scene()),
          simulation_(setUpScene(loaded_)),
          bones_(recording_.readBones(*simulation_.bone)),
          eyes_(recordedEyes(recording_)),
          attempts_(recordedAttempts(recording_.content())),
          rerun_(recording_, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()) {}

    int run() {
        if (attempts_.empty())
            throw UserError(options_.journal.string() +
                            ": holds no attempt of a trainee; nothing can be assessed");
        while (!rerun_.isAtEnd()) {
            const uint64_t tick = rerun_.next();
            look(tick);
            follow(tick);
            const TickRecord& record = rerun_.step();
            if (attempt_ && record.bone_order >= attempt_->recorded.bone_order) attempt_->run.add(record);
        }
        follow(rerun_.next());
        if (attempt_) end(rerun_.next() - 1);
        for (const std::string& problem : files_.problems()) said_ << "error: " << problem << '\n';
        return files_.problems().empty() ? 0 : 1;
    }

  private:
    struct Attempt {
        TaskRun run;
        RecordedAttempt recorded;
    };

    // Who looks on from elsewhere tells of it some times per second; meanwhile the eye is where it was.
    void look(uint64_t tick) {
        const size_t before = next_eye_;
        while (next_eye_ < eyes_.size() && eyes_[next_eye_].tick <= tick) ++next_eye_;
        if (attempt_ && next_eye_ > before) tellEye();
    }
    void tellEye() {
        if (next_eye_ > 0) attempt_->run.setEye(eyes_[next_eye_ - 1].p_WC);
    }

    // Before this tick: an attempt ends behind so many ticks. It begins with an order to put the bone back,
    // which no tick has taken up yet.
    void follow(uint64_t tick) {
        endAt(tick);
        while (!attempt_ && number_ < attempts_.size() && attempts_[number_].begin <= tick) {
            attempt_.emplace(Attempt{TaskRun(loaded_.scene, simulation_, true), attempts_[number_++]});
            tellEye();
            endAt(tick);
        }
    }
    void endAt(uint64_t tick) {
        if (attempt_ && attempt_->recorded.end <= tick) end(attempt_->recorded.end);
    }

    void end(uint64_t tick) {
        const RecordedAttempt& recorded = attempt_->recorded;
        const double begin_s = recording_.secondsOf(recorded.begin);
        AssessmentTarget target;
        target.folder = options_.out;
        target.pseudonym = recorded.trainee;
        target.number = number_;
        target.duration_s = recorded.time_s.value_or(recording_.secondsOf(tick) - begin_s);
        target.start_unix_ns =
            recording_.manifest().start_stamp_ns() + int64_t(begin_s * double(kNsPerSecond));
        target.journal = options_.journal.filename().string();
        const size_t problems = files_.problems().size();
        const TaskRun::Result result =
            attempt_->run.judgeBone(rerun_.history().scanned(), simulation_.bone->volume);
        const std::string stem = writeAssessment(target, loaded_, result, files_);
        if (files_.problems().size() == problems)
            said_ << "attempt " << number_ << " of " << target.pseudonym << ": results/" << stem << '\n';
        attempt_.reset();
    }

    AssessOptions options_;
    std::ostream& said_;
    Recording recording_;
    LoadedScene loaded_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    std::vector<RecordedEye> eyes_;
    std::vector<RecordedAttempt> attempts_;
    Rerun rerun_;
    std::optional<Attempt> attempt_;
    size_t next_eye_ = 0;
    uint32_t number_ = 0;  // of the attempt that began last
    FinalFiles files_;
};

}  // namespace

int assessJournal(const AssessOptions& options, std::ostream& said) {
    return JournalAssessment(options, said).run();
}

}  // namespace bonemill
