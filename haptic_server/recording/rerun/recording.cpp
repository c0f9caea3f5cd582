#include "haptic_server/recording/rerun/recording.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"
#include "common/config/scene_text.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/journal/bone_states.h"
#include "haptic_server/recording/journal/build_facts.h"

namespace bonemill {
namespace {

const journal::File* listedFile(const journal::Manifest& manifest, const NamedFile& file) {
    const std::string path = std::filesystem::absolute(file.path).lexically_normal();
    for (const journal::File& listed : manifest.files())
        if (listed.path() == path) return &listed;
    return nullptr;
}

// Its text is in the journal.
bool isSceneFile(const NamedFile& file, const LoadedScene& scene) {
    return file.path == scene.file;
}

// Of the states of the bone a replay needs one in so long.
constexpr double kKeyframesApartS = 1;

// Counts what states of the bone take in memory: leaves that a state shares with the one before count once.
class KeptBones {
  public:
    KeptBones(const std::filesystem::path& journal, size_t most_bytes)
        : journal_(journal), most_bytes_(most_bytes) {}

    void keep(const BoneSnapshot& state) {
        std::unordered_set<const LeafCopy*> leaves;
        for (const auto& leaf : state.leaves) {
            leaves.insert(leaf.get());
            bytes_ += sizeof leaf;
            if (!before_.contains(leaf.get()))
                bytes_ += sizeof *leaf + leaf->densities.size() * sizeof(Density);
        }
        before_ = std::move(leaves);
        if (bytes_ > most_bytes_)
            throw UserError(
                journal_.string() +
                ": has more states of the bone than can be kept in memory; it is damaged or forged");
    }

  private:
    const std::filesystem::path& journal_;
    const size_t most_bytes_;
    size_t bytes_ = 0;
    std::unordered_set<const LeafCopy*> before_;
};

bool isSame(const DeviceReport& a, const DeviceReport& b) {
    return a.state == b.state && a.stop_cause == b.stop_cause;
}

bool areFinite(const auto& numbers) {
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

}  // namespace

LoadedScene recordedScene(const journal::Manifest& manifest, const std::string& journal) {
    const std::filesystem::path file = manifest.scene_path();
    if (!file.is_absolute()) throw UserError(journal + ": does not say where its scene was; it is damaged");
    const std::string name = "the scene in the journal, " + printableLine(file.string());
    ParsedScene parsed = parseSceneText(manifest.scene_text(), name);
    checkScene(parsed, name);
    LoadedScene scene{std::move(parsed.scene), file.parent_path().lexically_normal(), file,
                      std::move(parsed.lines)};
    for (const NamedFile& read : filesOf(scene))
        if (!isSceneFile(read, scene) && !listedFile(manifest, read))
            throw UserError(journal + ": its scene reads " + read.name + " " +
                            printableLine(read.path.string()) +
                            ", which the session did not read; the journal is damaged or forged");
    return scene;
}

std::vector<std::string> changedFiles(const journal::Manifest& manifest, const LoadedScene& scene) {
    std::vector<std::string> changed;
    for (const NamedFile& read : filesOf(scene)) {
        if (isSceneFile(read, scene)) continue;
        const journal::File* const listed = listedFile(manifest, read);
        if (!listed || listed->sha256() != sha256Of(read.path))
            changed.push_back(read.name + " " + printableLine(read.path.string()) + " is another file now");
    }
    return changed;
}

// Earlier releases did not say that they dropped one: it is there without its end, and another one begins.
std::vector<RecordedAttempt> recordedAttempts(const JournalContent& content) {
    std::vector<RecordedAttempt> attempts;
    bool is_running = false;
    for (const journal::Event& event : content.events) {
        const bool begins = event.has_attempt_began();
        if (is_running && (begins || event.has_attempt_dropped())) attempts.pop_back();
        if (is_running && event.has_attempt_ended()) {
            attempts.back().end = event.tick();
            attempts.back().time_s = event.attempt_ended().time_s();
        }
        if (begins)
            attempts.push_back({event.attempt_began(), event.bone_order(), event.tick(), UINT64_MAX, {}});
        is_running = begins || (is_running && !event.has_attempt_ended() && !event.has_attempt_dropped());
    }
    return attempts;
}

Recording::Recording(const std::filesystem::path& path)
    : path_(path), content_(readJournalContent(path, KeepInputs::kYes)) {
    content_.ticks = 0;
    size_t blocks = 0;
    std::vector<JournalTick> ticks;
    for (; blocks < content_.inputs.size() && isNext(content_.inputs[blocks], ticks); ++blocks) {
        first_starts_ns_.push_back(ticks.front().start_ns);
        content_.ticks += ticks.size();
        for (const JournalTick& tick : ticks) noteTick(tick);
    }
    if (blocks < content_.inputs.size() && content_.problem.empty())
        content_.problem = "its ticks are damaged from tick " + std::to_string(content_.ticks) + " on";
    content_.inputs.resize(blocks);
    if (blocks == 0) throw UserError(path.string() + ": the recording has no ticks: nobody held the tool");
}

// Ticks that come later than a tick that is missing cannot be run again.
bool Recording::isNext(const journal::Inputs& inputs, std::vector<JournalTick>& ticks) const {
    ticks.clear();
    if (inputs.first_tick() != content_.ticks || !decodeInputs(inputs, ticks) || ticks.empty()) return false;
    return first_starts_ns_.empty() || ticks.front().start_ns >= first_starts_ns_.back();
}

void Recording::noteTick(const JournalTick& tick) {
    const uint64_t order = tick.input.decisions.bone_order;
    // A session that goes on begins with the order that was newest before.
    const bool is_new = tick.tick == 0 ? content_.put_backs.contains(order) : order != newest_order_;
    if (is_new) orders_taken_.emplace(order, tick.tick);
    newest_order_ = order;
    if (tick.input.has_other_device) devices_[tick.tick] = tick.input.other_device;
    if (!isSame(tick.device, device_)) device_changes_[tick.tick] = tick.device;
    device_ = tick.device;
}

size_t Recording::blockOf(uint64_t tick) const {
    const auto after = std::ranges::upper_bound(content_.inputs, tick, {},
                                                [](const auto& inputs) { return inputs.first_tick(); });
    return size_t(after - content_.inputs.begin()) - 1;
}

// Each was decoded once, when the recording was read.
std::vector<JournalTick> Recording::decode(size_t block) const {
    std::vector<JournalTick> ticks;
    decodeInputs(content_.inputs[block], ticks);
    return ticks;
}

double Recording::secondsOf(uint64_t tick) const {
    const size_t block = blockOf(tick);
    const std::vector<JournalTick> ticks = decode(block);
    return secondsOfNs(ticks[size_t(tick - ticks.front().tick)].start_ns);
}

uint64_t Recording::tickAt(double seconds) const {
    const int64_t start_ns = std::llround(std::clamp(seconds, 0.0, 1e9) * double(kNsPerSecond));
    const auto after = std::ranges::upper_bound(first_starts_ns_, start_ns);
    if (after == first_starts_ns_.begin()) return 0;
    const std::vector<JournalTick> ticks = decode(size_t(after - first_starts_ns_.begin()) - 1);
    const auto later = std::ranges::upper_bound(ticks, start_ns, {}, &JournalTick::start_ns);
    return later == ticks.begin() ? ticks.front().tick : std::prev(later)->tick;
}

const DeviceCapabilities* Recording::deviceBefore(uint64_t tick) const {
    const auto from = devices_.lower_bound(tick);
    return from == devices_.begin() ? nullptr : &std::prev(from)->second;
}

LoadedScene Recording::scene() const {
    LoadedScene scene = recordedScene(manifest(), path_.string());
    const std::vector<std::string> changed = changedFiles(manifest(), scene);
    if (!changed.empty())
        throw UserError(path_.string() + ": " + changed.front() +
                        "; put the one that was milled there again");
    return scene;
}

// Throws for an order whose bone is not there: what came after it would be milled from another one.
void Recording::requireTargets(const Bones& bones) const {
    for (const auto& [order, tick] : orders_taken_) {
        const auto target = content_.put_backs.find(order);
        const std::string what =
            path_.string() + ": its tick " + std::to_string(tick) + " puts the bone back to ";
        if (target == content_.put_backs.end())
            throw UserError(what + "what the journal does not say; it is damaged");
        if (target->second != 0 && !bones.checkpoints.contains(target->second))
            throw UserError(what + "checkpoint " + std::to_string(target->second) +
                            ", which is not in the journal; it is damaged");
    }
}

Recording::Bones Recording::readBones(const BoneModel& bone, size_t most_bytes) const {
    Bones bones;
    KeptBones kept(path_, most_bytes);
    BoneStateReader reader({bone.volume, bone.lattice});
    const bool is_resumed = manifest().has_resumed_from();
    if (!is_resumed) bones.keyframes.push_back({0, nullptr});
    const auto apart = uint64_t(std::ceil(kKeyframesApartS * manifest().rate_hz()));
    size_t unusable = 0;
    readJournal(path_, [&](JournalTopic topic, const mcap::Message& message) {
        if (topic != JournalTopic::kBone) return;
        journal::Bone state;
        if (!parse(message, state) || !reader.add(state)) {
            ++unusable;
            return;
        }
        if (!reader.isComplete()) return;
        if (state.checkpoint() != 0) {
            kept.keep(*reader.state());
            bones.checkpoints[state.checkpoint()] = reader.state();
        }
        if (state.kind() == journal::Bone::OTHER || state.tick() >= ticks()) return;
        const Keyframe keyframe{is_resumed && bones.keyframes.empty() ? 0 : state.tick(), reader.state()};
        if (!bones.keyframes.empty() && keyframe.tick < bones.keyframes.back().tick + apart) return;
        kept.keep(*reader.state());
        bones.keyframes.push_back(keyframe);
    });
    if (bones.keyframes.empty())
        throw UserError(
            path_.string() +
            ": the session went on from another one, and the bone that it began with is not in it");
    if (unusable > 0)
        bones.problem = std::to_string(unusable) + " states of the bone are not this scan's, or damaged";
    requireTargets(bones);
    return bones;
}

const JournalTick& RecordedTicks::at(uint64_t tick) {
    const bool is_decoded =
        !decoded_.empty() && tick >= decoded_.front().tick && tick <= decoded_.back().tick;
    if (!is_decoded) decoded_ = recording_.decode(recording_.blockOf(tick));
    return decoded_[size_t(tick - decoded_.front().tick)];
}

std::vector<RecordedEye> recordedEyes(const Recording& recording) {
    std::vector<RecordedEye> eyes;
    readJournal(recording.path(), [&](JournalTopic topic, const mcap::Message& message) {
        journal::Camera camera;
        if (topic != JournalTopic::kCamera || !parse(message, camera)) return;
        const topics::Eye& eye = camera.eye();
        if (eye.p_wc_m_size() == 3 && eye.q_wc_size() == 4 && areFinite(eye.p_wc_m()) &&
            areFinite(eye.q_wc()) && camera.tick() < recording.ticks())
            eyes.push_back({camera.tick(), Eigen::Vector3d(eye.p_wc_m().data()),
                            Eigen::Quaterniond(eye.q_wc(0), eye.q_wc(1), eye.q_wc(2), eye.q_wc(3)),
                            eye.field_of_view_rad()});
    });
    std::ranges::stable_sort(eyes, {}, &RecordedEye::tick);
    return eyes;
}

}  // namespace bonemill
