#include "haptic_server/lab/stepping/stepped_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/base/user_error.h"
#include "common/config/scene_tools.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/lab/simulate/run_path.h"
#include "haptic_server/recording/statistics/bone_files.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/surface/mesh/welded_mesh.h"

namespace bonemill {

SteppedRun::SteppedRun(const LoadedScene& loaded)
    : loaded_(loaded),
      setup_(setUpScene(loaded)),
      recorded_(recordedEffectsOf(loaded.scene.effects())),
      scanned_(setup_.bone->volume.withoutSpareBricks()) {
    beginWatching();
}

void SteppedRun::beginWatching() {
    hash_ = {};
    beginAttempt();
    noteAllChanged();
    record_ = {};
    ticks_ = 0;
}

void SteppedRun::noteAllChanged() noexcept {
    changed_ = {Eigen::Vector3i::Zero(), scanned_.dims() - Eigen::Vector3i::Ones()};
}

void SteppedRun::beginAnew() {
    tally_.reset();  // of the bone that goes
    setup_.bone = std::make_unique<BoneModel>(scanned_.withoutSpareBricks(), setup_.bone->lattice.leafCells(),
                                              shellConfigOf(loaded_.scene));
    beginWatching();
}

std::string SteppedRun::problemOf(const HandStep& hand, std::optional<double> before) const {
    constexpr double kUnitTolerance = 1e-3;  // of a quaternion's norm, as in trajectory files
    const auto& [p_W, q_WT] = hand.X_WT;
    if (!p_W.allFinite() || !q_WT.coeffs().allFinite()) return "the hand's pose is not finite";
    if (std::abs(q_WT.norm() - 1) > kUnitTolerance)
        return "the hand's quaternion (w, x, y, z) is of length " + std::to_string(q_WT.norm()) + ", not 1";
    if (const double far = distanceTo(scanned_, p_W); far > kFarFromBone)
        return "the hand is " + std::to_string(far) + " m from the bone; give metres in W, not millimetres";
    if (hand.t_s && !std::isfinite(*hand.t_s)) return "the tick's time is not finite: give seconds";
    if (hand.t_s && before && *hand.t_s <= *before)
        return "the tick's time is not after that of the tick before";
    return "";
}

std::string SteppedRun::problemOf(const HandStep& hand) const {
    return problemOf(hand, ticks_ > 0 ? std::optional(record_.t_s) : std::nullopt);
}

const TickRecord& SteppedRun::step(const HandStep& hand) {
    if (const std::string problem = problemOf(hand); !problem.empty()) throw UserError(problem);
    return note(tick(hand));
}

void SteppedRun::beginAttempt() {
    task_ = std::make_unique<TaskRun>(loaded_.scene, setup_);
    judged_ticks_.reset();
}

const TickRecord& SteppedRun::note(const TickRecord& record) {
    record_ = record;
    ++ticks_;
    changed_.include(record_.cut.voxels());
    hash_.addRecord(record_, recorded_);
    if (!judged_ticks_) task_->add(record_);
    return record_;
}

uint64_t SteppedRun::stateHash() const {
    StateHash hash = hash_;
    hash.addVolume(bone().volume);
    return hash.value();
}

std::vector<std::string> SteppedRun::toolNames() const {
    return toolNamesOf(loaded_.scene);
}

void SteppedRun::copyVoxels(const IndexBox& box, std::span<Density> all) const {
    const VoxelVolume& volume = bone().volume;
    for (int k = box.min.z(); k <= box.max.z(); ++k)
        for (int j = box.min.y(); j <= box.max.y(); ++j) {
            const Eigen::Vector3i first(box.min.x(), j, k);
            Density* out = &all[placeIn(volume.dims(), first)];
            volume.forEachRun(first, box.max.x() - first.x() + 1, [&](size_t offset, int n) {
                out = std::copy_n(volume.ownerData() + offset, n, out);
            });
        }
}

RunSurface SteppedRun::surface() const {
    const BoneModel& of = bone();
    const MeshGrid grid(of.volume, of.lattice);
    WeldedMesh welded = weld(meshWholeBone(of.volume, of.lattice), grid);
    const Pose& X_WV = of.volume.geometry().X_WV;
    RunSurface surface;
    surface.triangles = std::move(welded.triangles);
    surface.vertices_W.reserve(welded.vertices.size());
    for (const Eigen::Vector3i& vertex : welded.vertices)
        surface.vertices_W.push_back(X_WV * grid.position(vertex));
    return surface;
}

void SteppedRun::requireTask() const {
    if (!setup_.task)
        throw UserError(loaded_.file.string() + ": the scene has no task to judge by (assessment)");
}

const TaskProgress& SteppedRun::progress() {
    requireTask();
    const JudgedTask& task = *setup_.task;
    const double voxel = scanned_.voxelVolume();
    if (!counts_) counts_ = countProduct(scanned_, scanned_, task);
    if (!tally_) tally_.emplace(scanned_, bone().volume, bone().lattice, task);
    while (!tally_->update(UINT32_MAX)) {
    }
    progress_.zones.clear();
    for (size_t zone = 0; zone < task.zones.size(); ++zone)
        progress_.zones.push_back({task.zones[zone].name, task.zones[zone].role,
                                   voxel * double(counts_->zones[zone + 1].bone),
                                   voxel * double(tally_->removed()[zone + 1])});
    progress_.ideal = voxel * double(counts_->ideal);
    progress_.ideal_removed = voxel * double(tally_->idealRemoved());
    const Eigen::Vector3d middle = 0.5 * (counts_->changed.min + counts_->changed.max).cast<double>();
    progress_.p_ideal_W = scanned_.geometry().X_WV * scanned_.spacing().cwiseProduct(middle);
    const std::vector<int64_t>& removed = tally_->removed();
    progress_.removed = voxel * double(std::accumulate(removed.begin(), removed.end(), int64_t(0)));
    return progress_;
}

const nlohmann::json& SteppedRun::judge() {
    requireTask();
    if (judged_ticks_ && *judged_ticks_ == ticks_) return judged_;
    if (judged_ticks_)
        throw UserError("this run was judged after " + std::to_string(*judged_ticks_) +
                        " ticks, where its attempt ended: restore a checkpoint, or begin another one");
    if (ticks_ == 0) throw UserError("nothing to judge: no tick has run");
    judged_ = assessmentJson(task_->judgeBone(scanned_, bone().volume).assessment);
    judged_ticks_ = ticks_;
    return judged_;
}

}  // namespace bonemill
