#include "haptic_server/recording/export/export_journal.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "common/base/user_error.h"
#include "common/files/require_apart.h"
#include "common/files/whole_file.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/export/eye_table.h"
#include "haptic_server/recording/export/h5_file.h"
#include "haptic_server/recording/export/tick_table.h"
#include "haptic_server/recording/export/tool_path.h"
#include "haptic_server/recording/export/trajectory_writer.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/recording/statistics/trace_writer.h"
#include "haptic_server/scene/setup/scene_effects.h"

namespace bonemill {
namespace {

std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : "\n") + name;
    return text;
}

// The session as HDF5.
class H5Export {
  public:
    H5Export(const std::string& path, const Recording& recording, const RecordedEffects& recorded)
        : file_(path), h5_(file_.part()), recording_(recording), ticks_(h5_, recorded) {
        const journal::Manifest& manifest = recording.manifest();
        h5_.describe("journal_id", manifest.journal_id());
        h5_.describe("scene", manifest.scene_name());
        h5_.describe("scene_text", manifest.scene_text());
        h5_.describe("tools", joined(manifest.tool_names()));
        h5_.describe("materials", joined(manifest.material_names()));
        h5_.describe("recorded_by", manifest.build().version());
        h5_.describe("rate_hz", manifest.rate_hz());
        h5_.describe("start_unix_s", secondsOfNs(manifest.start_stamp_ns()));
    }
    void add(const TickRecord& record, ReplayEvents& events) {
        ticks_.add(record);
        events.addEffects(record.tick, record.effects);
    }
    void finish(const ReplayEvents& events) {
        ticks_.flush();
        writeEvents(events);
        writeEyes(recording_, h5_);
        h5_.close();
        file_.finish();
    }

  private:
    void writeEvents(const ReplayEvents& all) {
        std::vector<double> times_s;
        std::vector<uint32_t> ticks;
        std::vector<std::string> texts;
        const auto add = [&](const ReplayEvent& event) {
            times_s.push_back(recording_.secondsOf(event.tick));
            ticks.push_back(uint32_t(event.tick));
            texts.push_back(event.text);
        };
        if (const auto first = all.at(0)) add(*first);
        for (auto event = all.after(0); event; event = all.after(event->tick)) add(*event);
        h5_.addColumn("/events/t_s", 1, H5File::Number::kDouble, {"s", "since the session's first tick"})
            .append(times_s);
        h5_.addColumn("/events/tick", 1, H5File::Number::kUint32, {"1", "row of /tick"}).append(ticks);
        h5_.writeTexts("/events/text", texts, "what happened");
    }

    WholeFile file_;
    H5File h5_;
    const Recording& recording_;
    TickTable ticks_;
};

// The trace of a session.
class CsvExport {
  public:
    CsvExport(const std::string& path, const RecordedEffects& recorded)
        : file_(path), trace_(file_.part(), recorded) {}
    void add(const TickRecord& record) { trace_.write(record); }
    void finish() {
        if (!trace_.close())
            throw UserError(file_.path().string() + ": cannot be written to its end (disk full?)");
        file_.finish();
    }

  private:
    WholeFile file_;
    TraceWriter trace_;
};

void requireSomething(const ExportOptions& options) {
    if (options.h5.empty() && options.csv.empty() && options.traj.empty() && options.tool_path.empty())
        throw UserError("nothing to export: name a file with --h5, --csv, --traj or --tool-path");
}

}  // namespace

void exportJournal(const ExportOptions& options) {
    requireSomething(options);
    const Recording recording(options.journal);
    const LoadedScene scene = recording.scene();
    std::vector<NamedFile> read = filesOf(scene);
    read.push_back({"the journal", options.journal});
    requireApart({{"--h5", options.h5},
                  {"--csv", options.csv},
                  {"--traj", options.traj},
                  {"--tool-path", options.tool_path}},
                 read);
    if (!recording.content().incomplete.empty())
        spdlog::warn("the recording is incomplete from tick {} on: {}", recording.content().incomplete_from,
                     printableLine(recording.content().incomplete));
    if (!options.traj.empty()) writeTrajectory(options.traj, recording);
    if (options.h5.empty() && options.csv.empty() && options.tool_path.empty()) return;

    Simulation simulation = makeSimulation(scene);
    const Recording::Bones bones = recording.readBones(*simulation.bone);
    const RecordedEffects recorded = recordedEffectsOf(scene.scene.effects());
    std::optional<H5Export> h5;
    std::optional<CsvExport> csv;
    std::optional<ToolPathExport> tool_path;
    if (!options.h5.empty()) h5.emplace(options.h5, recording, recorded);
    if (!options.csv.empty()) csv.emplace(options.csv, recorded);
    if (!options.tool_path.empty()) tool_path.emplace(options.tool_path, recording, options.attempt);
    RecordedTicks ticks(recording);
    ReplayEvents events(recording);
    Rerun rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front());
    while (!rerun.isAtEnd()) {
        const bool is_paused = tool_path && ticks.at(rerun.next()).input.decisions.is_milling_paused;
        const TickRecord& record = rerun.step();
        if (tool_path) tool_path->add(record, is_paused);
        if (h5) h5->add(record, events);
        if (csv) csv->add(record);
    }
    if (h5) h5->finish(events);
    if (csv) csv->finish();
    if (tool_path) tool_path->finish();
}

}  // namespace bonemill
