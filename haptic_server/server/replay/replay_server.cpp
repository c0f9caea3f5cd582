#include "haptic_server/server/replay/replay_server.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "common/rt/stop_signals.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/rerun/verify_journal.h"
#include "haptic_server/server/publish/other_server.h"
#include "haptic_server/server/replay/bone_beside.h"
#include "haptic_server/server/replay/comparison.h"
#include "haptic_server/server/replay/led_replay.h"
#include "haptic_server/server/replay/low_priority.h"
#include "haptic_server/server/replay/player.h"
#include "haptic_server/server/session/show_session.h"
#include "haptic_server/server/session/shown_shades.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr size_t kRingRecords = 8192, kRingCuts = 8192;
constexpr auto kRecordPeriod = 4ms, kLookBeside = 4ms;
constexpr int64_t kLookEveryNs = 20 * kNsPerMillisecond;

// A viewer's choice that cannot be compared leaves the replay alone; what was asked for at the start is
// wrong.
std::optional<ComparedAttempt> openAgainst(const ReplayOptions& options, const Recording& shown) {
    if (options.against.file.empty()) return std::nullopt;
    try {
        return openCompared(options.against, options.folders, shown);
    } catch (const UserError& error) {
        throw UserError("--against: " + std::string(error.what()) +
                        " (`bonemill sessions` lists attempts; without --against the replay goes alone)");
    }
}

// The recorded scene, with the bone as its files have it now. Its threads stand around the player as those of
// a live session stand around the tick (session/scene_run.h).
class ReplayServer {
  public:
    explicit ReplayServer(const ReplayOptions& options)
        : recording_(options.journal),
          against_(openAgainst(options, recording_)),
          scene_(recording_.scene()),
          simulation_(setUpScene(scene_)),
          bones_(recording_.readBones(*simulation_.bone)),
          keyframes_(bones_.keyframes),
          events_(recording_),
          survey_(recording_, simulation_, scene_, bones_, keyframes_, events_),
          rerun_(recording_, simulation_, bones_.checkpoints, *simulation_.bone, bones_.keyframes.front()),
          ring_(kRingRecords),
          cuts_(kRingCuts),
          player_(recording_, rerun_, keyframes_, events_, survey_,
                  simulation_.bone->volume.geometry().X_WV.inverse(), ring_, cuts_),
          comparison_({recording_, simulation_, scene_, rerun_.history().scanned(), player_},
                      options.folders),
          led_(player_, comparison_),
          recorder_(ring_, int64_t(std::llround(double(kNsPerSecond) / scene_.scene.loop().rate_hz())),
                    recordedEffectsOf(scene_.scene.effects())),
          bone_export_(rerun_.history(), *simulation_.bone, ""),
          lesson_({}, ClassTable("")),
          keeper_(rerun_.history(), *simulation_.bone),
          task_(simulation_.task, *simulation_.bone, rerun_.history()),
          attempts_(lesson_, recorder_, rerun_.history(), keeper_, *simulation_.bone, scene_.scene),
          commands_(scene_.scene, *simulation_.bone, recorder_,
                    {rerun_.history(), rerun_.accuracies(), rerun_.tools(), stop_requested_, bone_export_,
                     reset_orders_, lesson_, attempts_, limits_, keeper_, hand_, &led_},
                    options.instructor_only),
          publisher_(soleServerOf(options.domain, options.session, options.network)),
          show_(
              publisher_, scene_.scene, simulation_, rerun_.history(), {}, outbox_, recorder_,
              [this](DeviceCapabilities& device) { return deviceNow(device); }, commands_, task_,
              options.stream_mbit_per_s * kMega / 8) {
        tellOfRecording(options.version);
        topics::ReplayOrder order;
        order.set_speed(options.speed);
        player_.carryOut(order);
        order.set_seek_s(options.at_s);
        player_.carryOut(order);
        if (options.is_paused) player_.play(false);
        if (against_) comparison_.compareWith(std::move(*against_));
    }

    int run() {
        show_.begin();
        start();
        while (!stop_requested_) {
            if (const int signal = stop_signals_.await(kLookEveryNs)) {
                spdlog::info("SIG{} received: shutting down", sigabbrev_np(signal));
                break;
            }
        }
        return has_failed_ ? 1 : 0;
    }

  private:
    void tellOfRecording(const std::string& version) const {
        const JournalContent& content = recording_.content();
        spdlog::info("{:.1f} s of session {}, {} ticks, {} moments of the bone, {} events",
                     recording_.lengthS(), recording_.manifest().session(), recording_.ticks(),
                     keyframes_.size(), events_.count());
        if (!content.problem.empty())
            spdlog::warn("the journal is not whole: {}", printableLine(content.problem));
        if (!content.incomplete.empty())
            spdlog::warn("the recording is incomplete from tick {} on: {}", content.incomplete_from,
                         printableLine(content.incomplete));
        if (!bones_.problem.empty()) spdlog::warn("{}", bones_.problem);
        for (const std::string& reason : reasonsAgainstSameBits(recording_.manifest(), version))
            spdlog::warn("the replay may differ in the last bits: {}", reason);
        for (const std::string& warning : simulation_.warnings) spdlog::warn("{}", warning);
    }

    bool deviceNow(DeviceCapabilities& device) const {
        const DeviceCapabilities* const now = recording_.deviceBefore(player_.shown() + 1);
        if (now) device = *now;
        return now != nullptr;
    }

    void start() {
        survey_.start();
        threads_[0] =
            std::jthread([this](const std::stop_token& stop) { endOnFailure([&] { player_.run(stop); }); });
        threads_[1] = std::jthread([this](const std::stop_token& stop) {
            loop(stop, kRecordPeriod, [this] { recorder_.drain(); });
        });
        threads_[2] = std::jthread([this](const std::stop_token& stop) { meshUntil(stop); });
        threads_[3] = std::jthread([this](const std::stop_token& stop) {
            loop(stop, ShowSession::kPause, [this] { publishRound(); });
        });
        threads_[4] = std::jthread(
            [this](const std::stop_token& stop) { endOnFailure([&] { comparison_.run(stop); }); });
        threads_[5] = std::jthread([this](const std::stop_token& stop) { meshBesideUntil(stop); });
    }

    void publishRound() {
        show_.round();
        show_.awaitNodes();
    }

    void meshUntil(const std::stop_token& stop) {
        ShownBone shown(scene_.scene, simulation_, rerun_.history().scanned());
        MeshRounds rounds(simulation_.bone->volume, simulation_.bone->lattice, cuts_, shown.look(), rim());
        std::shared_ptr<const VertexPaint> paint;
        const auto put = [this](NodeGroup&& group) { outbox_.put(std::move(group), monotonicNowNs()); };
        loop(stop, MeshRounds::kPeriod, [&] {
            std::shared_ptr<const VertexPaint> now = comparison_.paint();
            rounds.setPaint(now.get());
            paint = std::move(now);
            for (bool is_more = true; is_more && !stop.stop_requested();) {
                is_more = rounds.round(put);
                if (rounds.hasMeshedAll()) outbox_.markWhole(monotonicNowNs());
            }
        });
    }

    void meshBesideUntil(const std::stop_token& stop) {
        takeLowPriority(kNiceBeside);
        ShownBone shown(scene_.scene, simulation_, rerun_.history().scanned());
        BoneBeside beside(comparison_.firstLeafBeside(), shown.look(), rim(), outbox_);
        loop(stop, kLookBeside, [&] {
            for (bool is_more = true; is_more && !stop.stop_requested();) {
                beside.show(comparison_.boneBeside());
                is_more = beside.round();
            }
        });
    }
    const RegionRim* rim() const {
        return simulation_.surroundings ? &simulation_.surroundings->rim : nullptr;
    }

    template <class Work>
    void loop(const std::stop_token& stop, std::chrono::microseconds period, Work work) {
        endOnFailure([&] {
            while (!stop.stop_requested()) {
                work();
                std::this_thread::sleep_for(period);
            }
        });
    }
    template <class Work>
    void endOnFailure(Work work) {
        try {
            work();
        } catch (const std::exception& error) {
            spdlog::error("{}: the replay ends", error.what());
            has_failed_ = true;
            stop_requested_ = true;
        }
    }

    StopSignals stop_signals_;
    Recording recording_;
    std::optional<ComparedAttempt> against_;  // until it is handed on
    LoadedScene scene_;
    SceneSetup simulation_;
    Recording::Bones bones_;
    Keyframes keyframes_;
    ReplayEvents events_;
    Survey survey_;  // copies the bone before anything has changed it
    Rerun rerun_;
    SpscRing<TickRecord> ring_;
    SpscRing<Cut> cuts_;
    Player player_;
    Comparison comparison_;
    LedReplay led_;
    Recorder recorder_;
    MeshOutbox outbox_;
    SessionExport bone_export_;
    LessonState lesson_;
    JournalRecorder keeper_;  // of nothing: a replay is not recorded
    TaskMonitor task_;
    AttemptController attempts_;
    ScriptedHand hand_{recorder_, [](HandChoice) {}};  // a recording's, which nobody orders anything
    OrderLimits limits_;
    std::atomic<uint32_t> reset_orders_{0};
    std::atomic<bool> stop_requested_{false}, has_failed_{false};
    SessionCommands commands_;
    Publisher publisher_;
    ShowSession show_;
    std::array<std::jthread, 6> threads_;
};

}  // namespace

int runReplay(const ReplayOptions& options) {
    dds::setNetwork(options.network, dds::NetworkPart::kServer, options.session);
    return ReplayServer(options).run();
}

}  // namespace bonemill
