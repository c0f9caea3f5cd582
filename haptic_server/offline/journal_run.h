// Runs the ticks of a journal again: the very tick of the live session, with what it took in and what was
// decided for it then, so that the same build gives the same bits. It is for one normal thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "haptic_server/bone/bone_history.h"
#include "haptic_server/journal/bone_states.h"
#include "haptic_server/journal/input_columns.h"
#include "haptic_server/setup/scene_setup.h"
#include "haptic_server/tick/haptic_tick.h"

namespace bonemill {

// The bones to which a journal's orders put the bone back, by the orders' numbers; null: the scanned bone.
using PutBackTargets = std::map<uint64_t, std::shared_ptr<const BoneSnapshot>>;

// Collects them, and the bone with which the journal begins, from the journal's messages in their order.
class JournalBones {
  public:
    explicit JournalBones(const ScannedBone& scanned) : states_(scanned) {}

    // The next Bone or PutBack message. False if it cannot be one.
    bool add(const journal::Bone& bone);
    void add(const journal::PutBack& order);
    // Null: the scanned bone.
    const std::shared_ptr<const BoneSnapshot>& beginning() const noexcept { return beginning_; }
    const std::shared_ptr<const BoneSnapshot>& newest() const noexcept { return states_.state(); }
    // Throws UserError for a checkpoint that is not there.
    PutBackTargets targets() const;

    struct Checkpoint {
        double session_s;
        std::shared_ptr<const BoneSnapshot> state;
    };
    const std::map<uint32_t, Checkpoint>& checkpoints() const noexcept { return checkpoints_; }

  private:
    BoneStateReader states_;
    std::shared_ptr<const BoneSnapshot> beginning_;
    std::map<uint32_t, Checkpoint> checkpoints_;
    std::map<uint64_t, uint32_t> put_backs_;
};

class JournalRun {
  public:
    // References must outlive it; the simulation is the scene's, fresh, and its bone is milled. It begins
    // with this bone (null: the scanned one).
    JournalRun(Simulation& simulation, PutBackTargets targets,
               const std::shared_ptr<const BoneSnapshot>& beginning);
    ~JournalRun();

    // Runs one tick and returns its record, which is good until the next call. Throws UserError if its input
    // cannot be of this scene.
    const TickRecord& run(const JournalTick& tick);
    const BoneHistory& history() const noexcept { return history_; }
    const BoneModel& bone() const noexcept { return *simulation_.bone; }

  private:
    class Io;

    Simulation& simulation_;
    BoneHistory history_;
    PutBackTargets targets_;
    const ToolSwitch tools_;
    const AccuracySwitch accuracy_;
    std::unique_ptr<Io> io_;
    HapticTick tick_;
    uint64_t order_ = 0;
};

}  // namespace bonemill
