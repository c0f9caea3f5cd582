// These are the moments of a session to which the bone can be put back. They belong to one normal thread,
// BoneHistory's keeper.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>

#include "haptic_server/core/bone/bone_history.h"

namespace bonemill {

class Checkpoints {
  public:
    static constexpr size_t kMax = 8;
    static constexpr uint32_t kScannedBone = 0;  // as an id

    struct Checkpoint {
        uint32_t id;       // from 1, never given again
        double session_s;  // when it was saved
        std::shared_ptr<const BoneSnapshot> snapshot;
    };

    // Keeps references, which must outlive this object.
    Checkpoints(BoneHistory& history, const BoneModel& bone) : history_(history), bone_(bone) {}

    // Saves the bone as it is now, and returns the id; the oldest one goes if there are too many.
    uint32_t save(double session_s) {
        keep({last_id_ + 1, session_s, history_.snapshot(bone_)});
        return last_id_;
    }
    // One that was saved before, in another run: it is the newest now.
    void keep(Checkpoint checkpoint) {
        last_id_ = std::max(last_id_, checkpoint.id);
        kept_.push_back(std::move(checkpoint));
        if (kept_.size() > kMax) kept_.pop_front();
    }
    bool has(uint32_t id) const {
        return id == kScannedBone || std::ranges::find(kept_, id, &Checkpoint::id) != kept_.end();
    }
    // False means that there is none with this id (any more).
    bool restore(uint32_t id) {
        const auto found = std::ranges::find(kept_, id, &Checkpoint::id);
        if (id != kScannedBone && found == kept_.end()) return false;
        history_.restore(id == kScannedBone ? nullptr : found->snapshot);
        return true;
    }
    const std::deque<Checkpoint>& kept() const noexcept { return kept_; }  // oldest first

  private:
    BoneHistory& history_;
    const BoneModel& bone_;
    std::deque<Checkpoint> kept_;
    uint32_t last_id_ = 0;
};

}  // namespace bonemill
