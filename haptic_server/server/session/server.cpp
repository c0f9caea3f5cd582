#include "haptic_server/server/session/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <future>
#include <iostream>

#include "common/base/user_error.h"
#include "common/commands/role_rules.h"
#include "common/rt/clock.h"
#include "common/rt/stop_signals.h"
#include "haptic_server/recording/journal/journal_reader.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/server/publish/other_server.h"
#include "haptic_server/server/session/result_files.h"
#include "haptic_server/server/session/resume.h"
#include "haptic_server/server/session/scene_run.h"
#include "haptic_server/teaching/lessons/lesson_state.h"
#include "haptic_server/teaching/lessons/scene_folder.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr int64_t kLookEveryNs = 20 * kNsPerMillisecond;
// A loop that waits for a device has no force; one that hangs must not keep the next scene away.
constexpr int64_t kLongestFadeNs = kNsPerSecond;

void requireFilesCanBeWritten(const ServerOptions& options) {
    requireWritable(options.trace);
    requireReplaceable(options.report);
    requireReplaceable(options.save);
    requireRecordable(options);
}

// The process: it has one scene after the other.
class Server {
  public:
    Server(const ServerOptions& options, std::vector<ListedScene> scenes)
        : Server(options, std::move(scenes), loadFirst(options)) {}

    int run() {
        run_->start();
        waitForTheEnd();
        run_->end(true);
        are_files_whole_ &= run_->writeFiles();
        loading_ = {};  // waits for what is being read
        run_.reset();
        return are_files_whole_ && !has_failed_ ? 0 : 1;
    }

  private:
    struct Loaded {
        LoadedScene scene;
        SceneSetup simulation;
        std::optional<ResumedSession> resumed = {};
    };
    static Loaded load(const ServerOptions& options) {
        LoadedScene scene = loadSceneOf(options);
        SceneSetup simulation = setUpScene(scene);
        return {std::move(scene), std::move(simulation)};
    }
    // The journal is read while the scene is.
    static Loaded loadFirst(const ServerOptions& options) {
        std::optional<ResumeReading> reading;
        if (!options.resumed_journal.empty()) {
            auto unfinished = findUnfinished(options.recording, options.session);
            if (!unfinished) throw UserError(options.resumed_journal + ": is no longer there to go on with");
            reading.emplace(std::move(*unfinished));
        }
        Loaded loaded = load(options);
        if (reading) loaded.resumed = reading->take(*loaded.simulation.bone);
        if (!options.from.empty()) loaded.resumed = resumedAt(momentNameOf(options.from), loaded);
        return loaded;
    }
    static ResumedSession resumedAt(const MomentName& name, const Loaded& loaded) {
        RecordedMoment moment =
            momentOf(Recording(name.journal), loaded.simulation, loaded.scene, name.seconds);
        ResumedSession resumed;
        resumed.from = std::move(moment.from);
        resumed.bone = std::move(moment.bone);
        resumed.tool = moment.tool;
        resumed.accuracy = moment.accuracy;
        resumed.tuning = moment.tuning;
        return resumed;
    }

    Server(const ServerOptions& options, std::vector<ListedScene> scenes, Loaded first)
        : options_(options),
          beacon_(beaconOf(options)),
          link_(DeviceLink::create(options.session, LinkSide::kServer)),
          publisher_(soleServerOf(options.domain, options.session, options.network)),
          results_(options, inputsOf(scenes, first.scene)),
          lesson_(std::move(scenes), ClassTable(options.class_table)),
          run_(std::make_unique<SceneRun>(results_.first(), std::move(first.scene),
                                          std::move(first.simulation), std::move(first.resumed), parts())) {}

    // Of all scenes that can be chosen.
    static std::vector<NamedFile> inputsOf(const std::vector<ListedScene>& scenes, const LoadedScene& first) {
        std::vector<NamedFile> inputs = filesOf(first);
        for (const ListedScene& scene : scenes)
            inputs.insert(inputs.end(), scene.files.begin(), scene.files.end());
        return inputs;
    }
    ServerParts parts() {
        return {link_, publisher_, lesson_, limits_, stop_requested_, has_failed_, beacon_.get()};
    }
    static std::unique_ptr<Beacon> beaconOf(const ServerOptions& options) {
        if (options.beacon.empty()) return nullptr;
        return std::make_unique<Beacon>(options.beacon, options.allows_broadcast);
    }

    bool isOver() {
        if (const int signal = stop_signals_.await(kLookEveryNs)) {
            spdlog::info("SIG{} received: shutting down", sigabbrev_np(signal));
            return true;
        }
        if (run_->hasDeviceLeft()) {
            spdlog::info("the device has left: session ends");
            return true;
        }
        if (run_->hasTicked() && first_tick_ns_ == 0) first_tick_ns_ = monotonicNowNs();
        return first_tick_ns_ != 0 && options_.seconds > 0 &&
               secondsOfNs(monotonicNowNs() - first_tick_ns_) > options_.seconds;
    }

    void waitForTheEnd() {
        while (!stop_requested_) {
            if (isOver()) return;
            run_->lookAfter();
            if (!loading_.valid())
                beginChange();
            else if (loading_.wait_for(0s) == std::future_status::ready)
                endChange();
        }
        if (!has_failed_) spdlog::info("shut down by a client's command");
    }

    // The scene in force goes on while another one is read.
    void beginChange() {
        std::optional<LessonState::SceneOrder> order = lesson_.takeOrder();
        if (!order) return;
        order_ = std::move(*order);
        order_ns_ = monotonicNowNs();
        try {
            next_options_ = results_.next(order_.file);
            loading_ = std::async(std::launch::async, [this, options = next_options_] {
                requireFilesCanBeWritten(options);
                makeWhatIsMissing(options.scene);
                Loaded loaded = load(options);
                return std::make_unique<SceneRun>(options, std::move(loaded.scene),
                                                  std::move(loaded.simulation), std::nullopt, parts());
            });
        } catch (const std::exception& error) {
            refuseChange(error.what());
        }
    }

    void makeWhatIsMissing(const std::string& file) const {
        for (const ListedScene& scene : lesson_.scenes())
            if (scene.file == file && scene.choice.is_made_first() && lacksFiles(scene))
                makeMissing(scene, options_.maker);
    }

    void endChange() {
        std::unique_ptr<SceneRun> next;
        try {
            next = loading_.get();
        } catch (const std::bad_alloc&) {
            return refuseChange("there is not enough memory for a second scene beside the one in force");
        } catch (const std::exception& error) {
            return refuseChange(error.what());
        }
        changeTo(std::move(next));
    }

    void refuseChange(const std::string& why) {
        spdlog::warn("the scene stays: {}", why);
        lesson_.answerOrder(order_.command, Answer::refused(why));
    }

    // From the force of the one to that of the other; what the one leaves behind is written when the other
    // runs.
    void changeTo(std::unique_ptr<SceneRun> next) {
        const int64_t loaded_ns = monotonicNowNs();
        run_->fadeOut();
        while (!run_->hasFadedOut() && monotonicNowNs() - loaded_ns < kLongestFadeNs)
            std::this_thread::sleep_for(1ms);
        run_->end(false);
        publisher_.beginRun();
        std::swap(run_, next);
        results_.take(next_options_);
        startChanged();
        spdlog::info("another scene: {:.2f} s to load, {:.2f} s to change",
                     secondsOfNs(loaded_ns - order_ns_), secondsOfNs(monotonicNowNs() - loaded_ns));
        are_files_whole_ &= next->writeFiles();
    }

    // There is no way back to the scene of before: a failure ends the session in order, with the files of
    // both.
    void startChanged() {
        try {
            run_->start();
            lesson_.answerOrder(order_.command, Answer::done());
        } catch (const std::exception& error) {
            spdlog::error("{}: the session ends", error.what());
            lesson_.answerOrder(order_.command, Answer::refused(error.what()));
            has_failed_ = true;
            stop_requested_ = true;
        }
    }

    ServerOptions options_;
    StopSignals stop_signals_;
    std::unique_ptr<Beacon> beacon_;  // null: none
    DeviceLink link_;
    std::atomic<bool> stop_requested_{false};
    std::atomic<bool> has_failed_{false};
    Publisher publisher_;
    ResultFiles results_;
    ServerOptions next_options_;  // of the scene that is being loaded
    LessonState lesson_;
    OrderLimits limits_;
    std::unique_ptr<SceneRun> run_;
    LessonState::SceneOrder order_;
    int64_t order_ns_ = 0;
    int64_t first_tick_ns_ = 0;
    bool are_files_whole_ = true;
    std::future<std::unique_ptr<SceneRun>> loading_;  // reads what is above: it goes first
};

// The folders that were named, or else that of the scene.
std::vector<std::string> foldersOf(const ServerOptions& options) {
    if (!options.scene_folders.empty() || options.scene.empty()) return options.scene_folders;
    const std::filesystem::path folder = std::filesystem::path(options.scene).parent_path();
    return {folder.empty() ? "." : folder.string()};
}

}  // namespace

// What was recorded last of this session has no end: the session goes on there, or the user learns how.
void chooseResumption(ServerOptions& options) {
    if (!options.is_recorded) return;
    const std::optional<UnfinishedJournal> unfinished = findUnfinished(options.recording, options.session);
    if (!unfinished) {
        if (options.resumes)
            spdlog::info("there is no session {} to go on with: it begins anew", options.session);
        return;
    }
    const std::string scene = unfinished->manifest.scene_path(), file = unfinished->path.string();
    if (!options.resumes) {
        spdlog::warn("session {} was stopped before its end: --resume goes on with its bone ({})",
                     options.session, file);
    } else if (!options.scene.empty() && !isSameFile(options.scene, scene)) {
        spdlog::warn("{} is of the scene {}, and does not go on in another: --scene {} --resume does", file,
                     scene, scene);
    } else if (const std::string problem = problemOf(*unfinished); !problem.empty()) {
        spdlog::warn("{} cannot go on: {}", file, problem);
    } else {
        options.scene = scene;
        options.resumed_journal = file;
    }
}

// The recording's own scene, unless another file was named.
void beginFrom(ServerOptions& options) {
    if (options.resumes) throw UserError("--from and --resume: a session goes on from one moment only");
    const MomentName name = momentNameOf(options.from);
    if (options.scene.empty())
        options.scene = readJournalContent(name.journal, KeepInputs::kNo).manifest.scene_path();
}

std::string listScenesOf(const ServerOptions& options) {
    return sceneTable(listScenes(foldersOf(options), options.maker));
}

int runServer(const ServerOptions& given) {
    ServerOptions options = given;
    if (options.recording.empty()) options.recording = defaultRecordingFolder();
    requireFilesCanBeWritten(options);
    if (!options.from.empty())
        beginFrom(options);
    else
        chooseResumption(options);
    dds::setNetwork(options.network, dds::NetworkPart::kServer, options.session);
    if (options.class_table.empty() && std::filesystem::is_directory(options.export_dir))
        options.class_table = (std::filesystem::path(options.export_dir) / "class.csv").string();
    std::vector<ListedScene> scenes = listScenes(foldersOf(options), options.maker);
    if (options.scene.empty()) {
        const auto first = std::ranges::find_if(
            scenes, [](const ListedScene& s) { return s.choice.problem().empty() && s.missing.empty(); });
        if (first == scenes.end())
            throw UserError("no scene in --scenes can be loaded:\n" + sceneTable(scenes));
        options.scene = first->file;
    }
    return Server(options, std::move(scenes)).run();
}

}  // namespace bonemill
