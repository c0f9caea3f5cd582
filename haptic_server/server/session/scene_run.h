// One scene of a live session: its bone, its tick, and the threads beside it, from its start until another
// scene or the session's end. What lives as long as the process is the Server's.
//
// Made by any normal thread while another scene's loop runs; all else belongs to the main thread.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "common/rt/realtime.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/server/beacon/beacon.h"
#include "haptic_server/server/publish/publisher.h"
#include "haptic_server/server/session/device_link_io.h"
#include "haptic_server/server/session/journal_notes.h"
#include "haptic_server/server/session/resume.h"
#include "haptic_server/server/session/server.h"
#include "haptic_server/server/session/show_session.h"
#include "haptic_server/surface/mesh/mesh_outbox.h"

namespace bonemill {

// It outlives every scene.
struct ServerParts {
    DeviceLink& link;
    Publisher& publisher;
    LessonState& lesson;
    OrderLimits& limits;
    std::atomic<bool>& stop_requested;
    std::atomic<bool>& has_failed;
    Beacon* beacon;  // null: none
};

// Loads the scene, which the files that the session writes must spare with all that it names. Throws
// UserError.
LoadedScene loadSceneOf(const ServerOptions& options);

class SceneRun {
  public:
    // `options` are those of this scene: its file, and where its files go. With `resumed` it begins with that
    // bone. Throws UserError.
    SceneRun(const ServerOptions& options, LoadedScene loaded, SceneSetup simulation,
             std::optional<ResumedSession> resumed, const ServerParts& parts);
    ~SceneRun();
    SceneRun(const SceneRun&) = delete;
    SceneRun& operator=(const SceneRun&) = delete;

    // Announces the scene to the device, shows it, and starts the threads. Throws UserError.
    void start();

    // The main thread asks and tells some 20 times per second.
    void lookAfter();
    bool hasTicked() const { return first_tick_ns_ != 0; }
    bool hasDeviceLeft() const { return io_.hasDeviceLeft(); }

    // The force fades; then the loop can be ended without a step.
    void fadeOut() { io_.fadeOut(); }
    bool hasFadedOut() const { return io_.hasFadedOut(); }

    // Ends the loop; commands and pictures end with it. With `is_shown` the last pictures still go out, for
    // nobody shows anything afterwards; else what clients wait for is left to the next scene.
    void end(bool is_shown);
    // After that: writes the files. False if one is missing or not whole.
    bool writeFiles();

  private:
    void beginWith(const ResumedSession& resumed);
    void startJournal();
    void startTick();
    void runTicks() noexcept;
    template <class Work>
    void loop(const std::stop_token& stop, std::chrono::microseconds period, Work work);
    template <class Work>
    void endOnFailure(Work work);
    void publishRound();
    void meshUntil(const std::stop_token& stop);
    void countPageFaults();
    void tellOfCapabilities();
    void tellOfDevice();
    void tellClock();
    std::string traceProblem() const;
    void tellOfJournal();
    void logDistrust() const;

    ServerOptions options_;
    LoadedScene loaded_;
    SceneSetup simulation_;
    ServerParts parts_;
    BoneHistory history_;
    AccuracySwitch accuracy_;
    ToolSwitch tools_;
    TuningSwitch tunings_;
    SpscRing<TickRecord> ring_;  // from the tick to the recorder
    SpscRing<Cut> cuts_;         // and to the mesher
    DeviceLinkIo io_;
    HapticTick tick_;
    std::optional<ResumedSession> resumed_;
    std::optional<JournalConfig> journal_config_;  // until the journal begins
    std::unique_ptr<Journal> journal_;             // null: nothing is recorded
    std::future<void> closing_;                    // the journal of before gets its end
    JournalRecorder journal_keeper_;
    TuningDesk tuning_;
    Recorder recorder_;
    MeshOutbox outbox_;
    SessionExport bone_export_;
    TaskMonitor task_;
    AttemptController attempts_;
    ScriptedHand hand_;
    SessionCommands commands_;
    ShowSession show_;
    PublishFigures published_;  // publisher thread's until it is joined
    std::string device_;        // as told last
    size_t devices_told_ = 0;
    bool has_told_of_implausible_ = false, has_told_of_early_ = false, has_told_of_journal_ = false;
    BeaconMessage beacon_message_;
    int64_t first_tick_ns_ = 0;
    std::optional<PageFaults> warm_;  // of the tick thread, when it had run for some time
    RealtimeThread tick_thread_;
    std::jthread recorder_thread_, mesher_thread_, publisher_thread_;
};

}  // namespace bonemill
