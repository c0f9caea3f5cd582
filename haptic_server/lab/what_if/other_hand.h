// The ticks of a recorded session from a moment on, otherwise: with another tool or accuracy, the hand
// elsewhere, slower or faster, or the expert's. For one normal thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>

#include "haptic_server/assessment/measures/expert_path.h"
#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {

struct Otherwise {
    std::optional<uint32_t> tool, accuracy;    // as TickDecisions has them
    Eigen::Vector3d shift_W{0, 0, 0};          // of the hand, m
    double pace = 1;                           // of the hand: 0.5 is half as fast
    std::shared_ptr<const ExpertPath> expert;  // who has the hand; null: who had it
};

// What the recording says of an attempt: its first tick, and the one behind its last.
struct TickSpan {
    uint64_t begin = 0, end = 0;
};

class OtherHand {
  public:
    static constexpr double kMove = 0.2;      // s: so long the hand takes to where it is otherwise
    static constexpr double kHandOver = 0.5;  // s: likewise to the expert's; the pedal is up meanwhile

    // From the tick `first` of the attempt on; `dt` (s) apart. The recording must outlive this object. Throws
    // UserError if the expert's way is over then, or nobody holds the tool.
    OtherHand(const Recording& recording, const Otherwise& otherwise, TickSpan attempt, uint64_t first,
              double dt);

    // The k-th tick behind the moment, k = 0, 1, ... in turn; nothing when the way is over. Where nothing is
    // otherwise it is the recorded one to the bit.
    std::optional<JournalTick> tick(uint64_t k);

  private:
    std::optional<JournalTick> recorded(uint64_t k);
    std::optional<JournalTick> between(double place, uint64_t k);
    std::optional<JournalTick> experts(uint64_t k);
    double attemptTime();

    Otherwise otherwise_;
    TickSpan attempt_;
    uint64_t first_;
    double dt_;
    RecordedTicks ticks_;
    JournalTick at_moment_;
    double attempt_time_ = 0;  // of the moment: s since the attempt began, without pauses
};

}  // namespace bonemill
