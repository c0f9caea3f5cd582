// Goes on from a session that was stopped before its end: its unfinished journal is found, and the newest
// bone is taken from it. It is for normal threads, before the session runs.
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/recording/journal/bone_states.h"
#include "proto/journal.pb.h"

namespace bonemill {

struct UnfinishedJournal {
    std::filesystem::path path;
    journal::Manifest manifest;
};

// The newest journal of this session in the folder, if it has no end and nobody writes to it. One that was
// stopped or ended before it held anything gives way to the one before. Whatever else is there is passed
// over.
std::optional<UnfinishedJournal> findUnfinished(const std::filesystem::path& folder, uint32_t session);
// Why it cannot go on, for people: its scene, or a file of it, is another one now. Empty if it can.
std::string problemOf(const UnfinishedJournal& unfinished);

// What a session goes on with.
struct ResumedSession {
    journal::ResumedFrom from;
    std::shared_ptr<const BoneSnapshot> bone;
    struct Checkpoint {
        uint32_t id;
        double session_s;
        std::shared_ptr<const BoneSnapshot> state;
    };
    std::vector<Checkpoint> checkpoints;  // by id
    uint32_t tool = 0, accuracy = 0;      // chosen last
    scene::Tuning tuning;                 // likewise
    uint64_t lost_bytes = 0;              // at the end of the file
    std::string text() const;             // for people
};

// Reads the journal once, while the scene may still be loaded.
class ResumeReading {
  public:
    explicit ResumeReading(UnfinishedJournal unfinished);

    const UnfinishedJournal& journal() const noexcept { return unfinished_; }
    // With the scene's own bone, as scanned. Throws UserError if the journal is not of it.
    ResumedSession take(const BoneModel& bone);

  private:
    struct Raw;
    UnfinishedJournal unfinished_;
    std::future<std::unique_ptr<Raw>> raw_;
};

// Once the session's next journal has all that this one gave: gives it its end, so that it is found no more.
// What is lost but a torn chunk at its end stays beside it; then this says so, for people. Throws UserError.
std::string closeResumed(const std::filesystem::path& path);

}  // namespace bonemill
