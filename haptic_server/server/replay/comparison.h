// Compares a replay with another attempt at the same scene: its tool goes along as a ghost, and colours on
// the bone tell who has removed what.
//
// All of it runs on a thread of its own of low priority, which follows the player. What goes wrong with the
// other attempt is said, and the replay goes on.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "common/commands/answer.h"
#include "common/geometry/pose.h"
#include "haptic_server/server/replay/companion.h"
#include "haptic_server/server/replay/player.h"
#include "haptic_server/surface/mesh/difference_paint.h"
#include "proto/topics.pb.h"

namespace bonemill {

class Comparison {
  public:
    // What is shown; all must outlive this object. `scanned` is the bone before anything has changed it.
    struct Shown {
        const Recording& recording;
        const SceneSetup& simulation;
        const LoadedScene& scene;
        const VoxelVolume& scanned;
        const Player& player;
    };
    Comparison(const Shown& shown, AttemptFolders folders) : shown_(shown), folders_(std::move(folders)) {}

    // The comparison's thread.
    void run(const std::stop_token& stop);

    // These do not wait: what comes of it describe() says. Any thread.
    void compareWith(ComparedAttempt attempt);
    Answer compareWithResult(const std::string& name);
    Answer compareWithNone();
    Answer showDifference(bool is_shown);
    Answer showBeside(bool is_shown);
    void describe(topics::Replay& replay) const;
    // Of the other attempt, while it stands where the replay does. Any thread.
    std::optional<Pose> otherTool() const;

    // Adds the three colours of a difference, if numbers are left for them, and as many leaves as the bone
    // has for the other one. Once, before run().
    void extend(topics::SceneInfo& info);
    // What the bone is to show; null: nothing. The mesher's thread.
    std::shared_ptr<const VertexPaint> paint() const;
    // The other bone, while it is to be seen; null: it is not. Any thread; its leaves are numbered from here
    // on.
    std::shared_ptr<const BoneModel> boneBeside() const;
    uint32_t firstLeafBeside() const noexcept { return first_leaf_; }

  private:
    struct Wish {
        std::optional<ComparedAttempt> attempt;
        std::string result;  // the name of a result; empty: `attempt` counts
        bool isNone() const { return result.empty() && !attempt; }
    };
    void wish(Wish wish, const std::string& name = "");
    std::optional<Wish> awaitWish(const std::stop_token& stop, bool is_arrived);
    void open(Wish wish);
    void giveUp(const std::string& problem);
    void takeAway();
    bool isCompared() const { return state_ && state_->problem().empty(); }
    void begin(ComparedAttempt attempt);
    bool follow(const std::stop_token& stop);

    const Shown shown_;
    const AttemptFolders folders_;
    uint8_t first_material_ = 0;
    uint32_t first_leaf_ = 0;
    std::unique_ptr<Companion> companion_;  // the comparison's thread has it

    mutable std::mutex mutex_;  // guards what is below
    std::condition_variable_any changed_;
    std::optional<Wish> wish_;  // not taken up yet
    std::optional<topics::Comparison> state_;
    std::optional<Pose> X_WT_;
    std::shared_ptr<const DifferencePaint> paint_;  // there while there is a companion
    std::shared_ptr<const BoneModel> bone_;         // likewise
    bool shows_difference_ = false, shows_beside_ = false;
};

}  // namespace bonemill
