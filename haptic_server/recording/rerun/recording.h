// A recorded session, read from its journal and checked: what its ticks took in, when, and the bone at some
// moments. It is read once and never changes; any thread may ask. An hour at 1 kHz takes some 200 MB.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/scene_file.h"
#include "haptic_server/core/bone/bone_model.h"
#include "haptic_server/core/bone/bone_snapshot.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "proto/journal.pb.h"

namespace bonemill {

// The scene whose text the journal has, its paths as of the file that it came from. A journal may come from a
// stranger: what it does not list with its hash is not opened. `journal` names the file of the recording, for
// messages. Throws UserError, also if the scene reads a file that the journal does not list.
LoadedScene recordedScene(const journal::Manifest& manifest, const std::string& journal);

// Which of the files that the scene reads are others now than the journal says, a sentence each.
std::vector<std::string> changedFiles(const journal::Manifest& manifest, const LoadedScene& scene);

struct RecordedAttempt {
    std::string trainee;
    uint64_t bone_order = 0;       // that puts the bone back for it
    uint64_t begin = 0;            // tick
    uint64_t end = UINT64_MAX;     // tick; UINT64_MAX: the recording ends before
    std::optional<double> time_s;  // without pauses, if it has ended
};

// The attempts of a session in their order, which is their number from 1 on. One that was dropped counts as
// none.
std::vector<RecordedAttempt> recordedAttempts(const JournalContent& content);

// The bone as the ticks before `tick` left it.
struct Keyframe {
    uint64_t tick = 0;
    std::shared_ptr<const BoneSnapshot> bone;  // null: as scanned
};

class Recording {
  public:
    // Throws UserError if it is no journal, or holds no ticks.
    explicit Recording(const std::filesystem::path& path);

    const std::filesystem::path& path() const noexcept { return path_; }
    const JournalContent& content() const noexcept { return content_; }
    const journal::Manifest& manifest() const noexcept { return content_.manifest; }
    // How many there are: at least 1.
    uint64_t ticks() const noexcept { return content_.ticks; }

    // When it began, s since the first one.
    double secondsOf(uint64_t tick) const;
    // The last one that had begun by then; the first or the last one of all if there is none.
    uint64_t tickAt(double seconds) const;
    double lengthS() const { return secondsOf(ticks() - 1); }

    // The ticks are decoded as they were written, some hundred at once: a block.
    size_t blockOf(uint64_t tick) const;
    std::vector<JournalTick> decode(size_t block) const;
    // The device that the ticks before this one had; null: none was told of.
    const DeviceCapabilities* deviceBefore(uint64_t tick) const;
    // Ticks whose device differs in state from the tick before, and what it was then.
    const std::map<uint64_t, DeviceReport>& deviceChanges() const noexcept { return device_changes_; }

    // Of the session's beginning on. Throws UserError, also if a file that it reads is another one now:
    // nothing of this PC is read that the session did not read.
    LoadedScene scene() const;

    struct Bones {
        std::vector<Keyframe> keyframes;  // by tick; the first is that with which the session began
        std::map<uint32_t, std::shared_ptr<const BoneSnapshot>> checkpoints;
        std::string problem;  // for people, if some of them cannot be used; else empty
    };
    // Whoever made the journal: so much memory may its bones take.
    static constexpr size_t kMaxBoneBytes = size_t(4) << 30;
    // Reads the file once more. `bone` is the scanned one of the scene. Throws UserError if the session began
    // with another bone than the scanned one, or put it back to one, and that is not there; and if its
    // bones take more memory.
    Bones readBones(const BoneModel& bone, size_t most_bytes = kMaxBoneBytes) const;

  private:
    bool isNext(const journal::Inputs& inputs, std::vector<JournalTick>& ticks) const;
    void noteTick(const JournalTick& tick);
    void requireTargets(const Bones& bones) const;

    std::filesystem::path path_;
    JournalContent content_;
    std::vector<int64_t> first_starts_ns_;            // of the blocks' first ticks
    std::map<uint64_t, DeviceCapabilities> devices_;  // by the first tick that had it
    std::map<uint64_t, DeviceReport> device_changes_;
    std::map<uint64_t, uint64_t> orders_taken_;  // to put the bone back: the ticks that took them up
    DeviceReport device_;                        // of the tick that was noted last
    uint64_t newest_order_ = 0;                  // of that tick
};

// Goes through the ticks of a recording, in any order, fastest one by one. It is for one thread.
class RecordedTicks {
  public:
    // The recording must outlive this object.
    explicit RecordedTicks(const Recording& recording) : recording_(recording) {}
    // There is a tick of this number. The reference is good until the next call.
    const JournalTick& at(uint64_t tick);

  private:
    const Recording& recording_;
    std::vector<JournalTick> decoded_;
};

// What the trainee saw in a recorded session, as its journal has it.
struct RecordedEye {
    uint64_t tick = 0;        // from which on it was known
    Eigen::Vector3d p_WC;     // m
    Eigen::Quaterniond q_WC;  // as it was written
    double field_of_view;     // rad, vertical
};

// In the order of ticks, and of ticks that there are. Reads the journal once more. Throws UserError.
std::vector<RecordedEye> recordedEyes(const Recording& recording);

}  // namespace bonemill
