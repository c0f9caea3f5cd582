#include "haptic_server/server/session/resume.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/mcap/mcap_index.h"
#include "common/mcap/mcap_repair.h"
#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/recording/journal/input_columns.h"
#include "haptic_server/recording/journal/journal_file.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/rerun/recording.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

bool hasEnd(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string magic(mcap::kMagic.size(), '\0');
    file.seekg(-std::streamoff(magic.size()), std::ios::end);
    return file.read(magic.data(), std::streamsize(magic.size())) && magic == mcap::kMagic;
}

struct Enough {};  // was read

// Nothing if it holds no more than its manifest.
std::optional<journal::Manifest> manifestOf(const fs::path& path) {
    std::optional<journal::Manifest> manifest;
    try {
        readJournal(path, [&](JournalTopic topic, const mcap::Message& message) {
            if (topic == JournalTopic::kManifest) {
                manifest.emplace();
                if (!manifest->ParseFromArray(message.data.data(), int(message.data.size())))
                    manifest.reset();
            } else if (topic == JournalTopic::kBone) {
                throw Enough{};
            }
        });
    } catch (const Enough&) {
        return manifest;
    } catch (const UserError&) {
        return std::nullopt;
    }
    return std::nullopt;
}

// Whether nothing was milled in it, and no other session gave it a bone to begin with.
bool isEmpty(const fs::path& path) {
    bool is_empty = true;
    try {
        readJournal(path, [&](JournalTopic topic, const mcap::Message& message) {
            journal::Manifest manifest;
            const bool goes_on = topic == JournalTopic::kManifest &&
                                 manifest.ParseFromArray(message.data.data(), int(message.data.size())) &&
                                 manifest.has_resumed_from();
            is_empty = topic != JournalTopic::kInputs && !goes_on;
            if (!is_empty) throw Enough{};
        });
    } catch (const Enough&) {
    } catch (const UserError&) {
    }
    return is_empty;
}

// Journals of the session, the newest first: their names end with when they began.
std::vector<fs::path> journalsOf(const fs::path& folder, uint32_t session) {
    std::vector<std::pair<fs::file_time_type, fs::path>> found;
    std::error_code error;
    const std::string begin = std::to_string(session) + "_";
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path& path = entry->path();
        const std::string name = path.filename().string();
        if (!name.ends_with(".mcap") || name.ends_with(mcap::kDamagedEnding) || !name.starts_with(begin))
            continue;
        std::error_code ignored;
        if (!fs::is_regular_file(fs::symlink_status(path, ignored))) continue;
        found.emplace_back(fs::last_write_time(path, ignored), path);
    }
    std::ranges::sort(found, std::greater<>());
    std::vector<fs::path> paths;
    for (auto& [time, path] : found) paths.push_back(std::move(path));
    return paths;
}

}  // namespace

std::optional<UnfinishedJournal> findUnfinished(const fs::path& folder, uint32_t session) {
    for (const fs::path& path : journalsOf(folder, session)) {
        if (hasEnd(path) && isEmpty(path)) continue;
        if (hasEnd(path)) return std::nullopt;
        if (isJournalWritten(path)) return std::nullopt;
        std::optional<journal::Manifest> manifest = manifestOf(path);
        if (manifest && manifest->session() == session) return UnfinishedJournal{path, std::move(*manifest)};
    }
    return std::nullopt;
}

std::string problemOf(const UnfinishedJournal& unfinished) {
    try {
        const LoadedScene scene = loadScene(unfinished.manifest.scene_path());
        if (sceneHashOf(scene.scene) != unfinished.manifest.scene_hash())
            return "its scene has changed since";
        for (const journal::File& file : unfinished.manifest.files())
            if (file.path() != unfinished.manifest.scene_path() && sha256Of(file.path()) != file.sha256())
                return file.what() + " " + file.path() + " has changed since";
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

// What the newest state and the checkpoints are made of: messages from the last KEY on, and those from the
// KEY before each checkpoint that may still be there.
struct ResumeReading::Raw {
    struct Run {
        std::vector<journal::Bone> bones;
        std::set<uint32_t> checkpoints;
        size_t bytes = 0;
    };
    static constexpr size_t kMaxBytes = Recording::kMaxBoneBytes;
    std::vector<Run> runs;
    size_t bytes = 0;  // of all runs
    std::map<uint64_t, uint32_t> put_backs;
    std::map<uint32_t, scene::Tuning> tunings;  // by their numbers
    uint64_t bone_order = 0;                    // that is done in the newest bone
    uint32_t newest_checkpoint = 0;
    journal::Inputs last_inputs;
    uint64_t lost_bytes = 0;

    void take(JournalTopic topic, const mcap::Message& message) {
        const auto size = int(message.data.size());
        if (topic == JournalTopic::kInputs) last_inputs.ParseFromArray(message.data.data(), size);
        if (topic == JournalTopic::kPutBack) {
            journal::PutBack order;
            if (order.ParseFromArray(message.data.data(), size))
                put_backs[order.bone_order()] = order.checkpoint();
        }
        journal::Tuned tuned;
        if (topic == JournalTopic::kTuned && tuned.ParseFromArray(message.data.data(), size))
            tunings[tuned.number()] = tuned.values();
        journal::Bone bone;
        if (topic == JournalTopic::kBone && bone.ParseFromArray(message.data.data(), size))
            takeBone(std::move(bone));
    }
    void takeBone(journal::Bone bone) {
        if (bone.kind() == journal::Bone::KEY) runs.emplace_back();
        if (runs.empty()) return;
        if (bone.checkpoint() != 0) {
            runs.back().checkpoints.insert(bone.checkpoint());
            newest_checkpoint = std::max(newest_checkpoint, bone.checkpoint());
        }
        const bool is_whole = !bone.goes_on() && bone.kind() != journal::Bone::OTHER;
        if (is_whole) bone_order = bone.bone_order();
        bytes += bone.SpaceUsedLong();
        if (bytes > kMaxBytes) throw UserError("its bones take more memory than there may be; it is damaged");
        runs.back().bytes += bone.SpaceUsedLong();
        runs.back().bones.push_back(std::move(bone));
        if (is_whole) dropRunsBeforeTheLast();
    }
    // A KEY of which only a part is there replaces nothing.
    void dropRunsBeforeTheLast() {
        const auto last = std::prev(runs.end());
        const auto gone =
            std::stable_partition(runs.begin(), last, [this](const Run& run) { return isWanted(run); });
        for (auto run = gone; run != last; ++run) bytes -= run->bytes;
        runs.erase(gone, last);
    }
    bool isWanted(const Run& run) const {
        return !run.checkpoints.empty() && *run.checkpoints.rbegin() + Checkpoints::kMax > newest_checkpoint;
    }
};

ResumeReading::ResumeReading(UnfinishedJournal unfinished)
    : unfinished_(std::move(unfinished)), raw_(std::async(std::launch::async, [path = unfinished_.path] {
          auto raw = std::make_unique<Raw>();
          const mcap::Reading reading = readJournal(
              path, [&raw](JournalTopic topic, const mcap::Message& message) { raw->take(topic, message); });
          raw->lost_bytes = reading.lost_bytes;
          return raw;
      })) {}

ResumedSession ResumeReading::take(const BoneModel& bone_as_scanned) {
    const DensitiesAsScanned scanned{bone_as_scanned.volume, bone_as_scanned.lattice};
    const std::unique_ptr<Raw> raw = raw_.get();
    ResumedSession out;
    BoneStateReader states(scanned);
    std::map<uint32_t, ResumedSession::Checkpoint> checkpoints;
    uint64_t tick = 0;
    for (const Raw::Run& run : raw->runs)
        for (const journal::Bone& bone : run.bones) {
            if (!states.add(bone))
                throw UserError(unfinished_.path.string() + ": its bone is not of this scene's volume");
            if (!states.isComplete()) continue;
            if (bone.checkpoint() != 0)
                checkpoints[bone.checkpoint()] = {bone.checkpoint(), bone.checkpoint_session_s(),
                                                  states.state()};
            if (bone.kind() == journal::Bone::OTHER) continue;
            out.bone = states.state();
            tick = bone.tick();
        }
    while (checkpoints.size() > Checkpoints::kMax) checkpoints.erase(checkpoints.begin());
    // The bone was on its way there: only what a tick took up counts, for orders may be refused or merged.
    const auto& orders = raw->last_inputs.bone_order().values();
    const uint64_t taken_up = orders.empty() ? 0 : *orders.rbegin();
    const auto put_back = raw->put_backs.find(taken_up);
    if (taken_up > raw->bone_order && put_back != raw->put_backs.end()) {
        const uint32_t target = put_back->second;
        const auto found = checkpoints.find(target);
        if (target == 0) out.bone = std::make_shared<const BoneSnapshot>();
        if (target != 0 && found != checkpoints.end()) out.bone = found->second.state;
    }
    if (!out.bone) out.bone = std::make_shared<const BoneSnapshot>();
    for (auto& [id, checkpoint] : checkpoints) out.checkpoints.push_back(std::move(checkpoint));
    if (const journal::Inputs& last = raw->last_inputs; last.tool().values_size() > 0) {
        out.tool = uint32_t(last.tool().values(last.tool().values_size() - 1));
        if (last.accuracy().values_size() > 0)
            out.accuracy = uint32_t(last.accuracy().values(last.accuracy().values_size() - 1));
        if (last.tuning().values_size() > 0)
            out.tuning = raw->tunings[uint32_t(last.tuning().values(last.tuning().values_size() - 1))];
    }
    out.lost_bytes = raw->lost_bytes;
    out.from.set_file(unfinished_.path.filename().string());
    out.from.set_journal_id(unfinished_.manifest.journal_id());
    out.from.set_tick(tick);
    out.from.set_segment(unfinished_.manifest.resumed_from().segment() + 1);
    return out;
}

std::string ResumedSession::text() const {
    return "the session goes on from tick " + std::to_string(from.tick()) + " of " + from.file() + ", with " +
           std::to_string(bone->leaves.size()) + " changed leaves and " + std::to_string(checkpoints.size()) +
           " checkpoints; " + std::to_string(lost_bytes) + " bytes at its end are lost";
}

// It stays as old as it is: the newest of a session is the one that was written last.
std::string closeResumed(const fs::path& path) {
    std::error_code error;
    const fs::file_time_type time = fs::last_write_time(path, error);
    const mcap::Repair repair = mcap::repair(path);
    if (!error) fs::last_write_time(path, time, error);
    if (repair.kept.empty()) return "";
    return path.string() + " was damaged (" + repair.problem + "): its last " +
           std::to_string(repair.lost_bytes) + " bytes were cut off; as it was it is kept as " +
           repair.kept.filename().string();
}

}  // namespace bonemill
