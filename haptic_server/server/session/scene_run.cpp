#include "haptic_server/server/session/scene_run.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/log/log.h"
#include "common/rt/clock.h"
#include "common/rt/rt_guard.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/scene/setup/coupling_text.h"
#include "haptic_server/scene/setup/scene_task.h"
#include "haptic_server/server/session/result_files.h"
#include "haptic_server/server/session/shown_effects.h"
#include "haptic_server/server/session/shown_shades.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr size_t kRingRecords = 8192;  // 8 s at 1 kHz: a stalled disk loses nothing
constexpr size_t kRingCuts = 8192;
constexpr int kTickPriority = 80;
// What was milled goes out at once, and what is milled meanwhile once more after kCutPause: every picture of
// it costs the mesher, the publisher and all viewers.
constexpr auto kCutPause = 4ms;
constexpr auto kRecordPeriod = 4ms;
constexpr int64_t kWarmUpNs = kNsPerSecond;
// At its end the session shows what was milled last. A bone that is not yet meshed, or a slow network, holds
// it for no longer than this.
constexpr int64_t kLastMeshingNs = kNsPerSecond / 2;
constexpr int64_t kLastPublishingNs = kNsPerSecond / 2;

DeviceLinkIoConfig ioConfigOf(const ServerOptions& options, const scene::Loop& loop,
                              const SceneSetup& simulation) {
    DeviceLinkIoConfig config;
    config.ends_with_device = options.until_device_leaves;
    config.period_ns = int64_t(std::llround(double(kNsPerSecond) / loop.rate_hz()));
    config.ramp.stale_after_ns = nsOfMilliseconds(loop.stale_after_ms());
    config.ramp.ramp_down_ns = nsOfMilliseconds(loop.ramp_ms());
    config.X_WD = simulation.X_WD;
    config.hand_space = simulation.tick.hand_space;
    return config;
}

std::string accuracyFileOf(const ServerOptions& options) {
    if (!options.accuracy.empty()) return options.accuracy;
    const std::string beside = accuracyFiguresOf(options.scene);
    return std::filesystem::exists(beside) ? beside : "";
}

AccuracyFigures figuresOf(const ServerOptions& options) {
    const std::string file = accuracyFileOf(options);
    return file.empty() ? AccuracyFigures{} : readAccuracyFigures(file);
}

void logClosing(const RunStatistics& statistics) {
    const uint64_t lost = statistics.lostRecords();
    spdlog::info("{} ticks, {:.1f} Hz, tick p99 {:.1f} us, {} dropped, {}faults: {}", statistics.ticks(),
                 statistics.meanRateHz(), microsecondsOfNs(double(statistics.tickCompute().percentileNs(99))),
                 statistics.droppedTicks(), lost == 0 ? "" : std::to_string(lost) + " records lost, ",
                 faultNames(statistics.faults()));
}

}  // namespace

LoadedScene loadSceneOf(const ServerOptions& options) {
    LoadedScene loaded = loadScene(options.scene);
    std::vector<NamedFile> written = filesOf(options.save), read = filesOf(loaded);
    written.push_back({"--trace", options.trace});
    written.push_back({"--report", options.report});
    read.push_back({"--accuracy", accuracyFileOf(options)});
    requireApart(written, read);
    return loaded;
}

SceneRun::SceneRun(const ServerOptions& options, LoadedScene loaded, SceneSetup simulation,
                   std::optional<ResumedSession> resumed, const ServerParts& parts)
    : options_(options),
      loaded_(std::move(loaded)),
      simulation_(std::move(simulation)),
      parts_(parts),
      history_(*simulation_.bone),
      accuracy_(simulation_.accuracy),
      tools_(simulation_.spoTools()),
      tunings_(simulation_.tunable.with({})),
      ring_(kRingRecords),
      cuts_(kRingCuts),
      io_(ioConfigOf(options, loaded_.scene.loop(), simulation_), parts.link),
      tick_(simulation_.tick, {*simulation_.bone, &history_}, {tools_, accuracy_, &tunings_}),
      resumed_(std::move(resumed)),
      journal_keeper_(history_, *simulation_.bone),
      tuning_(simulation_.tunable, tunings_, journal_keeper_),
      recorder_(ring_, ioConfigOf(options, loaded_.scene.loop(), simulation_).period_ns,
                recordedEffectsOf(loaded_.scene.effects()), breachWatchOf(simulation_)),
      bone_export_(history_, *simulation_.bone, options.export_dir),
      task_(simulation_.task, *simulation_.bone, history_),
      attempts_(
          parts.lesson, recorder_, history_, journal_keeper_, *simulation_.bone, loaded_.scene,
          [this](bool begins) { parts_.link.announceAttempt(begins); }, &task_),
      hand_(recorder_, [this](HandChoice hand) { parts_.link.announceHand(hand); }),
      commands_(loaded_.scene, *simulation_.bone, recorder_,
                {history_, accuracy_, tools_, parts.stop_requested, bone_export_, io_.resetOrders(),
                 parts.lesson, attempts_, parts.limits, journal_keeper_, hand_, nullptr, &tuning_},
                options.instructor_only),
      show_(
          parts.publisher, loaded_.scene, simulation_, history_, figuresOf(options), outbox_, recorder_,
          [this](DeviceCapabilities& device) { return io_.capabilities(device); }, commands_, task_,
          options.stream_mbit_per_s * kMega / 8) {
    recorder_.measureTechnique(techniqueMaker(loaded_.scene, simulation_));
    for (const std::string& remark : simulation_.remarks) spdlog::info("{}", remark);
    for (const std::string& warning : simulation_.warnings) spdlog::warn("{}", warning);
    if (options_.is_recorded) journal_config_ = journalConfigOf(options_, loaded_, simulation_);
    if (resumed_) beginWith(*resumed_);
}

void SceneRun::beginWith(const ResumedSession& resumed) {
    if (!resumed.bone->leaves.empty()) history_.startFrom(*simulation_.bone, resumed.bone);
    for (const ResumedSession::Checkpoint& saved : resumed.checkpoints)
        commands_.checkpoints().keep({saved.id, saved.session_s, saved.state});
    if (resumed.tool < tools_.count()) tools_.choose(resumed.tool);
    const bool is_switchable = loaded_.scene.accuracy().switchable();
    if (is_switchable && resumed.accuracy < AccuracySwitch::count()) accuracy_.choose(resumed.accuracy);
    if (const Answer tuned = tuning_.tune(resumed.tuning); tuned.outcome != topics::DONE)
        spdlog::warn("it is not tuned as before: {}", tuned.text);
    spdlog::info("{}", resumed.text());
}

// The bone with which it begins is in the file before the loop runs; only then is it no longer wanted from
// the journal of before.
void SceneRun::startJournal() {
    if (!journal_config_) return;
    journal_config_->path = newJournalPath(options_.recording, options_.session, options_.scene);
    journal_config_->manifest.set_epoch(parts_.publisher.epoch());
    beacon_message_.recording = recordingOf(journal_config_->manifest.journal_id());
    if (resumed_) *journal_config_->manifest.mutable_resumed_from() = resumed_->from;
    journal_ = std::make_unique<Journal>(*journal_config_,
                                         DensitiesAsScanned{history_.scanned(), simulation_.bone->lattice});
    journal_keeper_.begin(journal_.get(), commands_.checkpoints());
    tuning_.noteInForce();
    recorder_.keepJournal(journal_.get());
    spdlog::info("recording to {}", journal_->path().string());
    if (!resumed_ || options_.resumed_journal.empty()) return;
    journal_->flush();
    if (!journal_->problem().empty()) return;
    closing_ = std::async(std::launch::async, [path = options_.resumed_journal] {
        try {
            if (const std::string kept = closeResumed(path); !kept.empty()) spdlog::warn("{}", kept);
        } catch (const std::exception& error) {
            spdlog::warn("{}", error.what());
        }
    });
}

// Whatever happened: the tick thread must be able to end before it is joined.
SceneRun::~SceneRun() {
    io_.stop();
}

void SceneRun::start() {
    const std::string file = std::filesystem::absolute(options_.scene).lexically_normal();
    io_.beginScene(parts_.link.announceScene(file, sceneHashOf(loaded_.scene), parts_.publisher.epoch()));
    parts_.lesson.enterScene(options_.scene);
    show_.begin();
    startJournal();
    beacon_message_.session = options_.session;
    beacon_message_.epoch = parts_.publisher.epoch();
    beacon_message_.scene_hash = sceneHashOf(loaded_.scene);
    startTick();
    recorder_.openTrace(options_.trace);  // only now: a refused start leaves the trace of before
    recorder_thread_ = std::jthread(
        [this](const std::stop_token& stop) { loop(stop, kRecordPeriod, [this] { recorder_.drain(); }); });
    mesher_thread_ = std::jthread([this](const std::stop_token& stop) { meshUntil(stop); });
    publisher_thread_ = std::jthread(
        [this](const std::stop_token& stop) { loop(stop, ShowSession::kPause, [this] { publishRound(); }); });
    spdlog::info("session {} of scene '{}' waits for a device", options_.session, loaded_.scene.name());
}

void SceneRun::end(bool is_shown) {
    io_.stop();
    tick_thread_.join();
    recorder_thread_ = {};
    publisher_thread_ = {};
    recorder_.drain();  // what an attempt counts is whole
    show_.endAttempt();
    journal_keeper_.end();
    // No tick and no command comes any more: what was being put back is in the files and in the picture.
    history_.restoreAll(*simulation_.bone);
    if (is_shown) {
        mesher_thread_ = {};
        endOnFailure([this] { show_.finish(monotonicNowNs() + kLastPublishingNs); });
    }
    published_.writes = parts_.publisher.writeTimes();
    published_.nodes = parts_.publisher.digest().count();
    published_.digest = parts_.publisher.digest().value();
}

void SceneRun::startTick() {
    tick_thread_ = RealtimeThread(
        {.request = {kTickPriority, options_.rt_core},
         .is_strict = options_.is_strict_realtime,
         .what = "the haptic loop"},
        [this] { runTicks(); }, logRealtime);
}

// The tick thread. A ring never blocks it: what finds no room is dropped and counted.
void SceneRun::runTicks() noexcept {
    while (const TickRecord* record = tick_.tick(io_)) {
        const RtScope scope;
        ring_.tryPush(*record);
        tellMesher(cuts_, record->cut);
    }
}

// A thread works until it is told to stop.
template <class Work>
void SceneRun::loop(const std::stop_token& stop, std::chrono::microseconds period, Work work) {
    endOnFailure([&] {
        while (!stop.stop_requested()) {
            work();
            std::this_thread::sleep_for(period);
        }
    });
}

// A failure ends the session in order, with its files.
template <class Work>
void SceneRun::endOnFailure(Work work) {
    try {
        work();
    } catch (const std::exception& error) {
        spdlog::error("{}: the session ends", error.what());
        parts_.has_failed = true;
        parts_.stop_requested = true;
    }
}

void SceneRun::publishRound() {
    const int64_t start_ns = monotonicNowNs();
    show_.round();
    published_.rounds.record(monotonicNowNs() - start_ns);
    show_.awaitNodes();
}

void SceneRun::meshUntil(const std::stop_token& stop) {
    ShownBone shown(loaded_.scene, simulation_, history_.scanned());
    MeshRounds rounds(simulation_.bone->volume, simulation_.bone->lattice, cuts_, shown.look(),
                      simulation_.surroundings ? &simulation_.surroundings->rim : nullptr);
    bool has_cut = false;
    const auto put = [&](NodeGroup&& group) {
        has_cut |= group.oldest_cut_ns != 0;
        outbox_.put(std::move(group), monotonicNowNs());
    };
    const auto markWhole = [&] {
        if (rounds.hasMeshedAll()) outbox_.markWhole(monotonicNowNs());
    };
    const std::optional<ZonePaint> zones =
        zonePaintOf(loaded_.scene, simulation_.task.get(), history_.scanned());
    loop(stop, MeshRounds::kPeriod, [&] {
        rounds.setPaint(zones && task_.showsZones() ? &*zones : nullptr);
        for (bool is_more = true; is_more && !stop.stop_requested(); markWhole()) is_more = rounds.round(put);
        if (std::exchange(has_cut, false)) std::this_thread::sleep_for(kCutPause);
    });
    endOnFailure([&] {
        rounds.finish(put, monotonicNowNs() + kLastMeshingNs);
        markWhole();
    });
    recorder_.setCutToPublisher(rounds.cutToSink());
}

// The faults are counted again and again, for the tick thread, and its numbers with it, may be gone
// at the end.
void SceneRun::countPageFaults() {
    const std::optional<PageFaults> now = pageFaultsOf(tick_thread_.id());
    if (!now || monotonicNowNs() - first_tick_ns_ < kWarmUpNs) return;
    if (!warm_) warm_ = now;
    recorder_.setPageFaults({now->minor - warm_->minor, now->major - warm_->major});
}

// A daemon that tells of one device after the other does not fill the log.
void SceneRun::tellOfCapabilities() {
    DeviceCapabilities device;
    if (!io_.capabilities(device)) return;
    const std::string text = deviceText(device);
    if (text == device_ || devices_told_ == DeviceHistory::kMaxKept) return;
    spdlog::info("the device is {}; {}", text, couplingText(simulation_.tick, device));
    device_ = text;
    ++devices_told_;
}

// Each change of the device is told of once, and so is that it cannot be trusted.
void SceneRun::tellOfDevice() {
    tellOfCapabilities();
    for (const DeviceChange& change : recorder_.takeDeviceChanges())
        spdlog::log(
            change.now.stop_cause == uint32_t(StopCause::kNone) ? spdlog::level::info : spdlog::level::warn,
            "the device: {}", deviceText(change.now));
    if (io_.implausibleMessages() > 0 && !std::exchange(has_told_of_implausible_, true))
        spdlog::warn("device_daemon says what cannot be; it is refused, and more of it only counted");
    if (io_.earlySamples() > 0 && !std::exchange(has_told_of_early_, true))
        spdlog::warn("samples come faster than loop.rate_hz; the loop keeps its rate");
}

void SceneRun::lookAfter() {
    if (!hasTicked() && recorder_.health().ticks > 0) {
        first_tick_ns_ = monotonicNowNs();
        spdlog::info("the device is there: the loop runs");
    }
    if (hasTicked()) countPageFaults();
    tellOfDevice();
    tellOfJournal();
    tellClock();
}

// The session's clock began with the first tick, as any tick's record says.
void SceneRun::tellClock() {
    if (!parts_.beacon || !parts_.beacon->isDue()) return;
    const std::optional<TickRecord> latest = recorder_.latest();
    if (!latest) return;
    const auto session_ns = int64_t(std::llround(latest->t_s * double(kNsPerSecond)));
    parts_.beacon->tell(beacon_message_, latest->start_ns - session_ns);
}

void SceneRun::tellOfJournal() {
    if (!journal_ || has_told_of_journal_) return;
    const std::string problem = journal_->problem();
    if (problem.empty()) return;
    has_told_of_journal_ = true;
    spdlog::error("{}: the recording is incomplete from about tick {} on: {}", journal_->path().string(),
                  journal_->ticks(), problem);
}

bool SceneRun::writeFiles() {
    mesher_thread_ = {};  // it tells the recorder how long cuts took
    recorder_.setPublished(published_);
    show_.leaveAnswers();
    FinalFiles files;
    if (!recorder_.finish()) files.note(traceProblem());
    if (journal_ && !journal_->problem().empty())
        files.note(journal_->path().string() + ": the recording is incomplete: " + journal_->problem());
    if (journal_) spdlog::info("the recording's chain ends with {}", journal_->lastLink());
    tellOfDevice();
    const RunStatistics& statistics = recorder_.statistics();
    logClosing(statistics);
    logDistrust();
    for (const std::string& warning : statistics.effects().warnings(materialNamesOf(loaded_.scene)))
        spdlog::warn("effects warned: {}", warning);
    const VoxelVolume& volume = simulation_.bone->volume;
    const LeafLattice& lattice = simulation_.bone->lattice;
    const SavePaths& save = options_.save;
    files.write(save.volume, [&](const std::string& path) { writeNrrd(path, volume); });
    files.write(save.mesh, [&](const std::string& path) {
        saveMesh(path, volume, lattice, meshWholeBone(volume, lattice));
    });
    files.write(save.difference,
                [&](const std::string& path) { saveDifference(path, history_.scanned(), volume); });
    files.write(options_.report,
                [&](const std::string& path) { statistics.writeJson(path, materialNamesOf(loaded_.scene)); });
    for (const std::string& problem : files.problems()) spdlog::error("{}", problem);
    return files.problems().empty();
}

std::string SceneRun::traceProblem() const {
    const uint64_t lost = recorder_.statistics().lostRecords();
    if (lost == 0) return options_.trace + ": part of the trace could not be written (disk full?)";
    return options_.trace + ": the trace lacks " + std::to_string(lost) +
           " ticks, which came faster than they could be written (disk slow or full?)";
}

void SceneRun::logDistrust() const {
    if (io_.implausibleMessages() + io_.earlySamples() == 0) return;
    spdlog::warn("{} messages of device_daemon were refused, {} ticks held back for samples that came early",
                 io_.implausibleMessages(), io_.earlySamples());
}

}  // namespace bonemill
