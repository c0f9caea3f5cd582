#include "haptic_server/recording/export/export_journal.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "common/base/user_error.h"
#include "common/files/require_apart.h"
#include "common/files/whole_file.h"
#include "common/rt/clock.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/align/align_file.h"
#include "haptic_server/recording/export/h5_file.h"
#include "haptic_server/recording/export/trajectory_writer.h"
#include "haptic_server/recording/foxglove/foxglove_export.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/recording/rerun/rerun.h"
#include "haptic_server/recording/statistics/tick_columns.h"
#include "haptic_server/scene/setup/scene_materials.h"

namespace bonemill {
namespace {

constexpr size_t kMaxWaiting = 4096;  // rows

// Ticks as the columns of an HDF5 file, with units and frames (docs/howto/replay.md lists them). It is for
// one normal thread.
class TickTable {
  public:
    // Adds the columns below "/tick/", those of effects as the scene records them. The file must outlive the
    // table.
    TickTable(H5File& file, const RecordedEffects& recorded) {
        static const TickRecord kAny{};
        for (const TickColumn& about : tickColumns(recorded)) {
            if (!about.name) continue;
            const ColumnValue value = about.in(kAny);
            const auto* const vector = std::get_if<std::span<const double>>(&value);
            const auto number =
                std::holds_alternative<uint32_t>(value) ? H5File::Number::kUint32 : H5File::Number::kDouble;
            columns_.push_back(
                {about,
                 &file.addColumn(std::string("/tick/") + about.name, vector ? vector->size() : 1, number,
                                 {about.unit, about.description}),
                 {},
                 {}});
        }
    }

    void add(const TickRecord& record) {
        for (Column& column : columns_)
            std::visit(
                [&]<class Value>(const Value& value) {
                    if constexpr (std::is_same_v<Value, uint32_t>)
                        column.counts.push_back(value);
                    else if constexpr (std::is_arithmetic_v<Value>)
                        column.reals.push_back(double(value));
                    else
                        column.reals.insert(column.reals.end(), value.begin(), value.end());
                },
                column.about.in(record));
        if (++rows_ == kMaxWaiting) flush();
    }
    // What waits; before the file is closed.
    void flush() {
        for (Column& column : columns_) {
            if (column.counts.empty())
                column.column->append(column.reals);
            else
                column.column->append(column.counts);
            column.reals.clear();
            column.counts.clear();
        }
        rows_ = 0;
    }

  private:
    struct Column {
        TickColumn about;
        H5File::Column* column;
        std::vector<double> reals;     // that wait,
        std::vector<uint32_t> counts;  // or these
    };
    std::vector<Column> columns_;
    size_t rows_ = 0;  // that wait
};

// What the trainee saw, as datasets of an HDF5 file.
struct Eyes {
    std::vector<double> t_s, p_m, q_wxyz, field_of_view_rad;

    void add(double at_s, const RecordedEye& eye) {
        t_s.push_back(at_s);
        p_m.insert(p_m.end(), eye.p_WC.begin(), eye.p_WC.end());
        for (const double part : {eye.q_WC.w(), eye.q_WC.x(), eye.q_WC.y(), eye.q_WC.z()})
            q_wxyz.push_back(part);
        field_of_view_rad.push_back(eye.field_of_view);
    }
};

// Reads the journal once more; adds "/eye" where it holds any. Throws UserError.
void writeEyes(const Recording& recording, H5File& file) {
    Eyes eyes;
    for (const RecordedEye& seen : recordedEyes(recording)) eyes.add(recording.secondsOf(seen.tick), seen);
    if (eyes.t_s.empty()) return;
    const auto write = [&](const char* place, size_t width, const H5About& about,
                           const std::vector<double>& values) {
        file.addColumn(place, width, H5File::Number::kDouble, about).append(values);
    };
    write("/eye/t_s", 1, {"s", "since the session's first tick"}, eyes.t_s);
    write("/eye/p_m", 3, {"m", "where the trainee's eye was, world frame W"}, eyes.p_m);
    write("/eye/q_wxyz", 4, {"1", "the camera's axes (x right, y up, z towards the eye) to W, w, x, y, z"},
          eyes.q_wxyz);
    write("/eye/field_of_view_rad", 1, {"rad", "vertical angle of view"}, eyes.field_of_view_rad);
}

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
    void add(const TickRecord& record) { ticks_.add(record); }
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

bool needsTicks(const ExportOptions& options) {
    return !options.h5.empty() || !options.csv.empty() || !options.tool_path.empty() ||
           !options.foxglove.empty();
}

void requireSomething(const ExportOptions& options) {
    if (options.traj.empty() && options.align.empty() && !needsTicks(options))
        throw UserError(
            "nothing to export: name a file with --h5, --csv, --traj, --tool-path, --foxglove or --align");
    if (!options.foxglove.empty() && std::filesystem::path(options.foxglove).extension() != ".mcap")
        throw UserError("--foxglove " + options.foxglove + ": the name must end with .mcap");
}

// Runs the ticks again for all files that tell what they came to.
void exportTicks(const ExportOptions& options, const Recording& recording, const LoadedScene& scene) {
    SceneSetup simulation = setUpScene(scene);
    const Recording::Bones bones = recording.readBones(*simulation.bone);
    const RecordedEffects recorded = recordedEffectsOf(scene.scene.effects());
    std::optional<H5Export> h5;
    std::optional<CsvExport> csv;
    std::optional<ToolPathExport> tool_path;
    std::optional<FoxgloveExport> foxglove;
    if (!options.h5.empty()) h5.emplace(options.h5, recording, recorded);
    if (!options.csv.empty()) csv.emplace(options.csv, recorded);
    if (!options.tool_path.empty()) tool_path.emplace(options.tool_path, recording, options.attempt);
    if (!options.foxglove.empty()) foxglove.emplace(options.foxglove, recording, scene.scene, simulation);
    RecordedTicks ticks(recording);
    ReplayEvents events(recording);
    Rerun rerun(recording, simulation, bones.checkpoints, *simulation.bone, bones.keyframes.front());
    while (!rerun.isAtEnd()) {
        const JournalTick& tick = ticks.at(rerun.next());
        const TickRecord& record = rerun.step();
        events.addEffects(record.tick, record.effects);
        if (tool_path) tool_path->add(record, tick.input.decisions.is_milling_paused);
        if (h5) h5->add(record);
        if (csv) csv->add(record);
        if (foxglove) foxglove->add(record, tick.start_ns, events);
    }
    if (h5) h5->finish(events);
    if (csv) csv->finish();
    if (tool_path) tool_path->finish();
    if (foxglove) foxglove->finish();
}

}  // namespace

void exportJournal(const ExportOptions& options) {
    requireSomething(options);
    const Recording recording(options.journal);
    const LoadedScene scene = recording.scene();
    std::vector<NamedFile> read = filesOf(scene);
    read.push_back({"the journal", options.journal});
    read.push_back({"--align", options.align});
    const std::string aligned = options.aligned.empty() ? alignedPathOf(options.align) : options.aligned;
    requireApart({{"--h5", options.h5},
                  {"--csv", options.csv},
                  {"--traj", options.traj},
                  {"--tool-path", options.tool_path},
                  {"--aligned", aligned},
                  {"--foxglove", options.foxglove},
                  {"the layout of --foxglove", layoutPathOf(options.foxglove)}},
                 read);
    if (!recording.content().incomplete.empty())
        spdlog::warn("the recording is incomplete from tick {} on: {}", recording.content().incomplete_from,
                     printableLine(recording.content().incomplete));
    if (!options.traj.empty()) writeTrajectory(options.traj, recording);
    if (!options.align.empty())
        spdlog::info(
            "{}: {}", aligned,
            alignFile(options.align, aligned, options.align_clock, recording.manifest().journal_id()).text());
    if (needsTicks(options)) exportTicks(options, recording, scene);
}

}  // namespace bonemill
