#include "haptic_server/recording/rerun/verify_journal.h"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Core>
#include <deque>
#include <map>
#include <utility>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/core/bone/bone_snapshot.h"
#include "haptic_server/recording/journal/bone_states.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/recording/journal/journal_chain.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_setup.h"

namespace bonemill {
namespace {

// Hostile files could unpack to far more than they are: N leaves are compared, and N poses wait
// for their tick.
constexpr size_t kMaxLeafHashes = size_t(1) << 27, kMaxWaitingPoses = 100'000;

template <class Message>
Message parsed(const mcap::Message& bytes) {
    Message message;
    if (!message.ParseFromArray(bytes.data.data(), int(bytes.data.size())))
        throw UserError("the journal has a message that makes no sense; it is damaged");
    return message;
}

uint64_t hashOf(std::span<const Density> densities) noexcept {
    StateHash hash;
    hash.addBytes(densities.data(), densities.size_bytes());
    return hash.value();
}

// What the leaves that changed were, after N ticks.
using LeafHashes = std::vector<std::pair<LeafId, uint64_t>>;

// Reads the bones of a journal: how the leaves were that changed.
class BonePass {
  public:
    explicit BonePass(const BoneModel& scanned)
        : scanned_{scanned.volume, scanned.lattice}, states_(scanned_) {}

    void take(JournalTopic topic, const mcap::Message& message) {
        if (topic == JournalTopic::kBone) takeBone(parsed<journal::Bone>(message));
    }
    const std::multimap<uint64_t, LeafHashes>& leaves() const { return leaves_; }

  private:
    void takeBone(const journal::Bone& bone) {
        if (!states_.add(bone)) throw UserError("the journal has a bone that is not of its scene");
        uint64_t leaf = 0;
        for (const uint32_t step : bone.leaf_steps()) changed_.push_back(LeafId(leaf += step));
        leaf = 0;
        for (const uint32_t step : bone.as_scanned_steps()) changed_.push_back(LeafId(leaf += step));
        if ((leaf_count_ += size_t(bone.leaf_steps_size() + bone.as_scanned_steps_size())) > kMaxLeafHashes)
            throw UserError("the journal has more leaves of bone than can be compared; it is damaged");
        if (bone.goes_on()) return;
        if (bone.kind() != journal::Bone::OTHER) leaves_.emplace(bone.tick(), hashesOfChanged());
        changed_.clear();
    }
    LeafHashes hashesOfChanged() const {
        LeafHashes hashes;
        for (const LeafId id : changed_) {
            const auto voxels = size_t(voxelsOf(scanned_.lattice.cellsOf(id)).count());
            const Density* const densities = states_.state()->densitiesOf(id);
            hashes.emplace_back(id, densities ? hashOf({densities, voxels})
                                              : hashOf(densitiesOf(scanned_.volume, scanned_.lattice, id)));
        }
        return hashes;
    }

    DensitiesAsScanned scanned_;
    BoneStateReader states_;
    std::vector<LeafId> changed_;
    size_t leaf_count_ = 0;
    std::multimap<uint64_t, LeafHashes> leaves_;
};

// Runs the ticks and compares.
class BitComparison {
  public:
    BitComparison(Rerun& rerun, const BoneModel& bone, const RecordedEffects& recorded,
                  const BonePass& states, JournalVerdict& verdict)
        : rerun_(rerun), bone_(bone), hash_(recorded), leaves_(states.leaves()), verdict_(verdict) {}

    void take(JournalTopic topic, const mcap::Message& message) {
        if (has_gap_) return;
        if (topic == JournalTopic::kInputs) takeInputs(message);
        if (topic == JournalTopic::kStateHash) takeHash(parsed<journal::StateHash>(message));
        if (topic == JournalTopic::kTool)
            poses_.push_back({message.time_ns, of(parsed<foxglove::PoseInFrame>(message).pose().position())});
        if (topic == JournalTopic::kWrench)
            forces_.push_back({message.time_ns, of(parsed<journal::WrenchInFrame>(message).force_n())});
        if (poses_.size() > kMaxWaitingPoses) poses_.pop_front();
        if (forces_.size() > kMaxWaitingPoses) forces_.pop_front();
    }

  private:
    void takeInputs(const mcap::Message& message) {
        ticks_.clear();
        if (!decodeInputs(parsed<journal::Inputs>(message), ticks_))
            throw UserError("the journal has input that makes no sense; it is damaged");
        has_gap_ = ticks_.front().tick != rerun_.next() || ticks_.back().tick >= rerun_.end();
        if (has_gap_) return;
        const uint64_t stamp_ns = message.time_ns - uint64_t(ticks_.front().start_ns);
        for (const JournalTick& tick : ticks_) {
            compareBones();
            const TickRecord& record = rerun_.step();
            hash_.add(record);
            if (hash_.check() != tick.check) differ(tick.tick, "");
            compareFigures(stamp_ns + uint64_t(tick.start_ns), record);
            ++verdict_.ticks;
            verdict_.seconds = record.t_s;
        }
        compareBones();
    }

    // All that are of this number of ticks. A tick that differs leaves another bone: it is the hashes that
    // say what was first in it.
    void compareBones() {
        const auto [first, last] = leaves_.equal_range(verdict_.ticks);
        if (compared_bones_ == verdict_.ticks + 1) return;
        compared_bones_ = verdict_.ticks + 1;
        for (auto state = first; state != last; ++state) {
            ++verdict_.bones;
            for (const auto& [leaf, hash] : state->second)
                if (verdict_.is_same && hashOf(densitiesOf(bone_.volume, bone_.lattice, leaf)) != hash)
                    differ(verdict_.ticks == 0 ? 0 : verdict_.ticks - 1, "the bone");
        }
    }

    void takeHash(const journal::StateHash& hash) {
        if (hash.ticks() != verdict_.ticks || hash.parts_size() != int(TickHash::kParts)) return;
        ++verdict_.hashes;
        const auto parts = hash_.parts();
        for (size_t n = 0; n < parts.size(); ++n)
            if (parts[n] != hash.parts(int(n)))
                return differ(verdict_.ticks - 1, std::string(TickHash::kNames[n]));
    }

    void differ(uint64_t tick, const std::string& part) {
        if (verdict_.is_same) verdict_.first_tick = tick;
        verdict_.is_same = false;
        if (verdict_.part.empty()) verdict_.part = part;
    }

    // What was written of a tick: no more than this is kept of a message.
    struct Written {
        uint64_t stamp_ns;
        Eigen::Vector3d value;
    };
    static Eigen::Vector3d of(const foxglove::Vector3& v) { return {v.x(), v.y(), v.z()}; }

    void compareFigures(uint64_t stamp_ns, const TickRecord& record) {
        compare(poses_, stamp_ns, record.p_WT, verdict_.position);
        compare(forces_, stamp_ns, record.f_hand_W, verdict_.force);
    }
    static void compare(std::deque<Written>& waiting, uint64_t stamp_ns, const double (&now)[3],
                        double& largest) {
        for (; !waiting.empty() && waiting.front().stamp_ns <= stamp_ns; waiting.pop_front())
            if (const Written& then = waiting.front(); then.stamp_ns == stamp_ns)
                largest = std::max(largest, (then.value - Eigen::Vector3d(now)).norm());
    }

    Rerun& rerun_;
    const BoneModel& bone_;
    TickHash hash_;
    const std::multimap<uint64_t, LeafHashes>& leaves_;
    JournalVerdict& verdict_;
    std::vector<JournalTick> ticks_;
    std::deque<Written> poses_, forces_;  // of the tool's point, and on the hand; W
    uint64_t compared_bones_ = 0;
    bool has_gap_ = false;
};

std::string notWhole(const JournalContent& content) {
    std::string text;
    if (!content.incomplete.empty())
        text += fmt::format("incomplete from tick {}: {}", content.incomplete_from,
                            printableLine(content.incomplete));
    if (!content.problem.empty())
        text += fmt::format("{}{} ({} bytes are lost)", text.empty() ? "" : "; ",
                            printableLine(content.problem), content.lost_bytes);
    else if (!content.has_ended)
        text += std::string(text.empty() ? "" : "; ") + "the session did not end in order";
    return text;
}

}  // namespace

std::vector<std::string> reasonsAgainstSameBits(const journal::Manifest& manifest,
                                                const std::string& version) {
    std::vector<std::string> reasons;
    const journal::Build now = buildFacts(version);
    const auto compare = [&](const char* what, const std::string& then, const std::string& here) {
        if (then != here)
            reasons.push_back(fmt::format("{}: it was '{}', and is '{}'", what, printableLine(then), here));
    };
    compare("the program", manifest.build().version(), now.version());
    compare("its compiler", manifest.build().compiler(), now.compiler());
    return reasons;
}

JournalVerdict verifyJournal(const std::filesystem::path& path, const std::string& version,
                             const std::string& noted_link) {
    JournalVerdict verdict;
    const Recording recording(path);
    verdict.not_whole = notWhole(recording.content());
    const LoadedScene scene = recording.scene();
    verdict.reasons = reasonsAgainstSameBits(recording.manifest(), version);
    SceneSetup simulation = setUpScene(scene);
    BonePass states(*simulation.bone);
    ChainCheck chain(noted_link);
    readJournal(path, [&](JournalTopic topic, const mcap::Message& message) {
        states.take(topic, message);
        chain.take(topic, message);
    });
    verdict.is_chain_broken = chain.isBroken();
    verdict.chain = chain.text();
    verdict.lacks_noted_link = chain.lacksNoted();
    verdict.noted_link = chain.textOfNoted();
    const Recording::Bones bones = recording.readBones(*simulation.bone);
    Rerun rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front());
    BitComparison comparison(rerun, *simulation.bone, recordedEffectsOf(scene.scene.effects()), states,
                             verdict);
    readJournal(path,
                [&](JournalTopic topic, const mcap::Message& message) { comparison.take(topic, message); });
    return verdict;
}

std::string JournalVerdict::text() const {
    std::string text = fmt::format("{} ticks ({:.3f} s), {} hashes and {} states of the bone: ", ticks,
                                   seconds, hashes, bones);
    if (ticks == 0)
        text += "nothing to compare";
    else if (is_same)
        text += reasons.empty() ? "the same bits" : "approximate, though no hash differs";
    else
        text += fmt::format("{}differs from tick {} ({:.3f} s) on{}",
                            reasons.empty() ? "" : "approximate: ", first_tick,
                            seconds * double(first_tick) / double(std::max<uint64_t>(1, ticks)),
                            part.empty() ? "" : ", first in " + part);
    text += fmt::format("\nlargest deviation: {:.3g} um of the tool, {:.3g} N on the hand",
                        position / kMicrometre, force);
    for (const std::string& reason : reasons) text += "\n" + reason;
    text += "\nthe chain: " + chain;
    if (!noted_link.empty()) text += "\n" + noted_link;
    if (!not_whole.empty()) text += "\nthe journal: " + not_whole;
    return text + "\n";
}

}  // namespace bonemill
