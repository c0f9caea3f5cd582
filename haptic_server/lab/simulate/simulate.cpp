#include "haptic_server/lab/simulate/simulate.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_tools.h"
#include "common/rt/clock.h"
#include "common/text/hex_text.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/lab/simulate/task_run.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/recording/statistics/run_statistics.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/recording/statistics/tick_columns.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"

namespace bonemill {
namespace {

constexpr double kTickSpacingTolerance = 0.1;  // times are often written with three decimals

std::vector<DeviceInput> inputsOf(const std::vector<TrajectoryRow>& rows) {
    std::vector<DeviceInput> inputs(rows.size(), DeviceInput{});
    for (size_t n = 0; n < rows.size(); ++n) {
        inputs[n].X_WT_device = rows[n].X_WT;
        inputs[n].buttons = rows[n].buttons;
        inputs[n].t_s = rows[n].t_s;
        if (!rows[n].recorded) continue;
        const TickInput& recorded = rows[n].recorded->input;
        inputs[n].device = rows[n].recorded->device;
        inputs[n].is_repeated = recorded.is_repeated;
        inputs[n].is_stale = recorded.is_stale;
        inputs[n].stale_factor = recorded.stale_factor;
        inputs[n].placements = recorded.placements;
        inputs[n].periods = recorded.periods;
        inputs[n].faults = recorded.faults;
        inputs[n].other_device = recorded.has_other_device ? &recorded.other_device : nullptr;
        inputs[n].decisions = &recorded.decisions;
    }
    return inputs;
}

// One row is one tick: a file sampled at another rate would silently mean another speed. A recorded one says
// how many periods each tick stands for.
void checkSpacing(const std::vector<TrajectoryRow>& rows, double dt, const std::string& file) {
    for (size_t n = 1; n < rows.size() && !rows[n].recorded; ++n) {
        const double spacing = rows[n].t_s - rows[n - 1].t_s;
        if (std::abs(spacing / dt - 1) < kTickSpacingTolerance) continue;
        throw UserError(file + ":" + std::to_string(n + 2) + ": this row is " +
                        std::to_string(spacing * kPerMillisecond) +
                        " ms after the one before, but the scene's loop has " +
                        std::to_string(dt * kPerMillisecond) +
                        " ms per tick; resample the trajectory or set loop.rate_hz");
    }
}

// Throws UserError where half of the rows lie far from the bone: then lengths are in another unit or frame.
void checkReach(const std::vector<TrajectoryRow>& rows, const VoxelVolume& volume, const std::string& file) {
    std::vector<double> distances;
    for (const TrajectoryRow& row : rows) distances.push_back(distanceTo(volume, row.X_WT.position));
    const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    if (*middle < kFarFromBone) return;
    throw UserError(
        "trajectory " + file + ": half of it is " + std::to_string(*middle) +
        " m and more from the bone; px_m, py_m and pz_m are metres in the frame W, not millimetres");
}

nlohmann::json totals(const RunStatistics& statistics, const StateHash& hash) {
    const auto us = microsecondsOfNs;
    const LatencyHistogram& compute = statistics.tickCompute();
    return {{"ticks", statistics.ticks()},
            {"removed_voxels", statistics.removedVoxels()},
            {"removed_mm3", statistics.removed() * kPerCubicMillimetre},
            {"added_voxels", statistics.addedVoxels()},
            {"added_mm3", statistics.added() * kPerCubicMillimetre},
            {"max_contacts", statistics.maxContacts()},
            {"max_penetration_m", statistics.maxPenetration()},
            {"max_force_n", statistics.maxForce()},
            {"max_torque_nm", statistics.maxTorque()},
            {"faults", statistics.faults()},
            {"fault_names", faultNames(statistics.faults())},
            {"tick_us",
             {{"mean", us(compute.meanNs())},
              {"p50", us(double(compute.percentileNs(50)))},
              {"p99", us(double(compute.percentileNs(99)))},
              {"p99_9", us(double(compute.percentileNs(99.9)))},
              {"max", us(double(compute.maxNs()))}}},
            {"state_hash", hexText(hash.value())}};
}

// What a recording says of its ticks must be what this scene has.
void checkDecisions(const std::vector<TrajectoryRow>& rows, size_t tools, const std::string& file) {
    for (size_t n = 0; n < rows.size(); ++n)
        if (rows[n].recorded && (rows[n].recorded->input.decisions.tool >= tools ||
                                 rows[n].recorded->input.decisions.accuracy >= AccuracySwitch::count()))
            throw UserError(file + ":" + std::to_string(n + 2) +
                            ": the scene has no such tool or accuracy; is it the recorded scene?");
}

void requireApart(const SimulateOptions& options, const LoadedScene& loaded) {
    std::vector<NamedFile> written = filesOf(options.save), read = filesOf(loaded);
    written.push_back({"--trace", options.trace});
    written.push_back({"--save-deviation", options.deviation});
    read.push_back({"--trajectory", options.trajectory});
    requireApart(written, read);
}

}  // namespace

SimulateResult simulate(const SimulateOptions& options) {
    const LoadedScene loaded = loadScene(options.scene, options.settings);
    requireApart(options, loaded);
    const std::vector<TrajectoryRow> rows = readTrajectory(options.trajectory);
    checkSpacing(rows, 1 / loaded.scene.loop().rate_hz(), options.trajectory);
    const size_t tool = options.tool.empty() ? 0 : toolIndexOf(toolNamesOf(loaded.scene), options.tool);
    requireReplaceable(options.save);
    requireWritable(options.trace);
    requireReplaceable(options.deviation);
    const RecordedEffects recorded = recordedEffectsOf(loaded.scene.effects());
    SceneSetup simulation = setUpScene(loaded);
    for (const std::string& warning : simulation.warnings) spdlog::warn("{}", warning);
    BoneModel& bone = *simulation.bone;
    checkReach(rows, bone.volume, options.trajectory);
    const MeshGrid grid(bone.volume, bone.lattice);
    const double volume_before = meshVolume(meshWholeBone(bone.volume, bone.lattice), grid);
    std::optional<VoxelVolume> before;
    if (!options.save.difference.empty() || simulation.task || !options.assess.empty())
        before = bone.volume.withoutSpareBricks();

    if (!options.deviation.empty() && !simulation.task)
        throw UserError("--save-deviation: the scene has no task to compare with (assessment)");
    TaskRun task(loaded.scene, simulation, !options.assess.empty());
    const ToolSwitch tools(simulation.spoTools(), tool);
    const AccuracySwitch accuracy(simulation.accuracy);
    checkDecisions(rows, tools.count(), options.trajectory);
    std::optional<BoneHistory> history;  // which a session's tick has
    if (rows.front().recorded) history.emplace(bone);
    HapticTick tick(simulation.tick, {bone, history ? &*history : nullptr}, {tools, accuracy});
    RunStatistics statistics(int64_t(std::llround(simulation.tick.dt * double(kNsPerSecond))), recorded);
    StateHash hash;
    std::optional<TraceWriter> trace;  // from here on nothing is refused that would cost the trace of before
    if (!options.trace.empty()) trace.emplace(options.trace, recorded);
    runPath(tick, inputsOf(rows), [&](const TickRecord& record) {
        hash.addRecord(record, recorded);
        statistics.add(record);
        if (trace) trace->write(record);
        task.add(record);
    });
    hash.addVolume(bone.volume);
    FinalFiles files;
    if (trace && !trace->close())
        files.note(options.trace + ": the trace could not be written to its end (disk full?)");

    const std::vector<NodeMesh> meshes = meshWholeBone(bone.volume, bone.lattice);
    const MeshCheck mesh = checkMesh(meshes, grid);
    const SavePaths& save = options.save;
    files.write(save.volume, [&](const std::string& path) { writeNrrd(path, bone.volume); });
    files.write(save.mesh,
                [&](const std::string& path) { saveMesh(path, bone.volume, bone.lattice, meshes); });
    files.write(save.difference,
                [&](const std::string& path) { saveDifference(path, *before, bone.volume); });
    nlohmann::json json = totals(statistics, hash);
    for (const auto& [figure, value] : statistics.effects().figures()) json[figure->run.key] = value;
    if (recorded.any()) json["warnings"] = statistics.effects().warnings(materialNamesOf(loaded.scene));
    if (simulation.task || !options.assess.empty()) {
        const TaskRun::Result result = task.judgeBone(*before, bone.volume);
        if (simulation.task) json["assessment"] = assessmentJson(result.assessment);
        if (!options.assess.empty())
            writeAssessment({options.assess, options.pseudonym, rows.back().t_s - rows.front().t_s}, loaded,
                            result, files);
        files.write(options.deviation,
                    [&](const std::string& path) { writeBytes(path, result.picture.png); });
    }
    json["scene"] = loaded.scene.name();
    json["tool"] = simulation.tools[tool].name;
    json["preset"] = settingsName(simulation.accuracy);
    json["iso_value"] = simulation.mapping.iso_value;
    json["shell_points"] = bone.shell.pointCount(bone.shell.followed());
    json["bone_mm3"] = mesh.volume * kPerCubicMillimetre;
    json["bone_before_mm3"] = volume_before * kPerCubicMillimetre;
    json["mesh"] = {
        {"triangles", mesh.triangles}, {"vertices", mesh.vertices}, {"is_closed", mesh.isClosed()}};
    return {json.dump(), files.problems()};
}

}  // namespace bonemill
