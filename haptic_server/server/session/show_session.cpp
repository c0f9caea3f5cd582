#include "haptic_server/server/session/show_session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "common/base/is_ready.h"
#include "common/base/units.h"
#include "common/commands/command_text.h"
#include "common/config/scene_geometry.h"
#include "common/rt/clock.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_structures.h"
#include "haptic_server/server/session/shown_shades.h"
#include "haptic_server/surface/mesh/surroundings_mesher.h"

namespace bonemill {
namespace {

constexpr int64_t kToolStatePeriodNs = 9 * kNsPerMillisecond;
constexpr int64_t kStatusPeriodNs = 250 * kNsPerMillisecond;
// Densities may take so much of the stream's bytes.
constexpr double kDensityShare = 0.25;
constexpr int64_t kStatusAfterChangeNs = 20 * kNsPerMillisecond;

template <class Repeated, class Vector>
void assign(Repeated* out, const Vector& v) {
    out->Clear();
    for (Eigen::Index i = 0; i < v.size(); ++i) out->Add(v[i]);
}

void fillCamera(const scene::Camera& camera, topics::Camera* out) {
    if (camera.has_target_mm()) {
        out->set_has_target(true);
        assign(out->mutable_target_m(), metresOf(camera.target_mm()));
    }
    out->set_distance_m(camera.has_distance_mm() ? camera.distance_mm() * kMillimetre : 0);
    out->set_azimuth_rad(camera.azimuth_deg() * kDegree);
    out->set_elevation_rad(camera.elevation_deg() * kDegree);
    if (camera.has_up()) assign(out->mutable_up(), vectorOf(camera.up()));
}

void fillTool(const TriangleSurface& surface, topics::TriangleMesh* out) {
    out->Clear();
    for (const Eigen::Vector3f& p : surface.positions)
        for (int axis = 0; axis < 3; ++axis) out->add_vertices_m(p[axis]);
    for (const Eigen::Vector3f& n : surface.normals)
        for (int axis = 0; axis < 3; ++axis) out->add_normals(n[axis]);
    for (const uint32_t index : surface.indices) out->add_indices(index);
}

// Both have the kinds in one order; AUTOMATIC is none that a tool has.
topics::SceneInfo::Handpiece shownHandpiece(scene::Tool::Handpiece handpiece) {
    using T = scene::Tool;
    using S = topics::SceneInfo;
    static_assert(S::NO_HANDPIECE == 0 && T::STRAIGHT - T::NONE == S::STRAIGHT &&
                  T::CONTRA_ANGLE - T::NONE == S::CONTRA_ANGLE &&
                  T::DRILL_GUIDE - T::NONE == S::DRILL_GUIDE && T::Handpiece_MAX == T::DRILL_GUIDE);
    return topics::SceneInfo::Handpiece(std::max(0, handpiece - scene::Tool::NONE));
}

// The camera has to show this box of all leaves with surface, in V.
Eigen::AlignedBox3d boneBox(const BoneModel& bone) {
    Eigen::AlignedBox3d box;
    for (LeafId leaf = 0; leaf < bone.lattice.leafCount(); ++leaf)
        bone.shell.forEachBlock(0, leaf, [&box](const ShellBlock& block, uint32_t count) {
            for (uint32_t i = 0; i < count; ++i)
                box.extend(Eigen::Vector3d(block.x[i], block.y[i], block.z[i]));
        });
    if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
    return box;
}

// Viewers show materials by their colours only.
const BoneProperties* shownProperties(const scene::Scene& scene, const SceneSetup& simulation) {
    const scene::Scene shown = shownSceneOf(scene, simulation.segment_colors);
    const bool has_colours =
        std::ranges::any_of(shown.material(), [](const scene::Material& m) { return m.has_color(); });
    return has_colours ? simulation.tick.effects.properties.get() : nullptr;
}

DensityScale scaleOf(const DensityMapping& mapping) {
    return {mapping.low, mapping.high, mapping.iso_value};
}

// The tool in use is still missing in it.
topics::SceneInfo sceneInfo(const scene::Scene& scene, const SceneSetup& simulation) {
    topics::SceneInfo info;
    info.set_name(scene.name());
    info.set_title(titleOf(scene));
    const Pose& X_WV = simulation.bone->volume.geometry().X_WV;
    const Eigen::Quaterniond& q = X_WV.rotation;
    assign(info.mutable_p_wv_m(), X_WV.position);
    assign(info.mutable_q_wv(), Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
    Eigen::AlignedBox3d box = boneBox(*simulation.bone);
    if (simulation.surroundings) box.extend(simulation.surroundings->bone);
    assign(info.mutable_bone_min_m(), box.min());
    assign(info.mutable_bone_max_m(), box.max());
    info.set_lacks_patient_axes(simulation.lacks_patient_axes);
    for (const SceneTool& tool : simulation.tools) info.add_tool_names(tool.name);
    *info.mutable_tunable() = simulation.tunable.ofScene();
    fillCamera(scene.camera(), info.mutable_camera());
    const scene::Scene shown = shownSceneOf(scene, simulation.segment_colors);
    describeToViewers(shown, info);
    describeZones(scene, info);
    describeShades(shadesOf(shown, simulation.mapping), info);
    const Eigen::Quaterniond& q_WD = simulation.X_WD.rotation;
    assign(info.mutable_p_wd_m(), simulation.X_WD.position);
    assign(info.mutable_q_wd(), Eigen::Vector4d(q_WD.w(), q_WD.x(), q_WD.y(), q_WD.z()));
    *info.mutable_device() = scene.device();
    info.mutable_device()->clear_p_wd_mm();
    info.mutable_device()->clear_q_wd();
    info.set_leaf_count(simulation.bone->lattice.leafCount());
    if (simulation.surroundings)  // their nodes are numbered behind those of the bone
        info.set_leaf_count(info.leaf_count() + surroundingsLeafCount(*simulation.surroundings));
    return info;
}

// It is for people, and must not keep the session waiting. Nothing is under way without structures.
std::future<std::vector<NodeMesh>> meshingStructures(const SceneSetup& simulation) {
    auto mesh_structures = structureMesherOf(simulation);
    if (!mesh_structures) return {};
    return std::async(std::launch::async, std::move(mesh_structures));
}

}  // namespace

ShowSession::ShowSession(Publisher& publisher, const scene::Scene& scene, const SceneSetup& simulation,
                         const BoneHistory& history, const AccuracyFigures& figures, MeshOutbox& outbox,
                         Recorder& recorder, ShownDevice device, SessionCommands& commands, TaskMonitor& task,
                         double bytes_per_s)
    : publisher_(publisher),
      scene_(scene),
      scene_name_(scene.name()),
      outbox_(outbox),
      budget_(bytes_per_s),
      density_budget_(bytes_per_s * kDensityShare),
      X_VW_(simulation.bone->volume.geometry().X_WV.inverse()),
      warning_distance_(warningDistanceOf(scene.effects())),
      structures_(meshingStructures(simulation)),
      recorder_(recorder),
      device_(std::move(device)),
      commands_(commands),
      task_(task),
      figures_(figures),
      effects_(scene.effects()),
      material_names_(materialNamesOf(scene)),
      tools_(simulation.tools),
      density_source_(*simulation.bone, history, shownProperties(scene, simulation)),
      density_scale_(scaleOf(simulation.mapping)),
      scene_info_(sceneInfo(scene, simulation)),
      surroundings_(simulation.surroundings, simulation.bone->lattice.leafCount(),
                    shadesOf(shownSceneOf(scene, simulation.segment_colors), simulation.mapping).scale,
                    outbox) {
    *scene_info_.mutable_densities() = densityGridOf(density_source_, density_scale_);
    if (commands_.replay()) commands_.replay()->extend(scene_info_);
}

void ShowSession::begin() {
    densities_.emplace(publisher_.participant(), publisher_.session(), publisher_.epoch(), density_source_,
                       density_scale_);
    publishSceneInfo();
    publishLesson();
}

void ShowSession::publishLesson() {
    std::optional<topics::Lesson> lesson = commands_.lesson().takeChanged();
    if (!lesson) return;
    budget_.spend(lesson->ByteSizeLong());
    publisher_.publishLesson(std::move(*lesson));
}

// One per round, after what the session needs: while a node waits nothing is left of the budget. DDS keeps
// them for those who come later.
void ShowSession::publishPictures() {
    const std::vector<ListedScene>& scenes = commands_.lesson().scenes();
    while (next_picture_ < scenes.size() && scenes[next_picture_].choice.picture().empty()) ++next_picture_;
    if (next_picture_ == scenes.size() || budget_.available(monotonicNowNs()) <= 0) return;
    const topics::SceneChoice& choice = scenes[next_picture_].choice;
    if (!publisher_.publishScenePicture(uint32_t(next_picture_), choice.id(), choice.picture())) return;
    budget_.spend(choice.picture().size());
    ++next_picture_;
}

void ShowSession::publishRemarks() {
    for (const RemarkList::Change& change : commands_.remarks().takeChanges()) {
        if (change.remark)
            publisher_.publishRemark(change.place, *change.remark);
        else
            publisher_.removeRemark(change.place);
    }
}

void ShowSession::publishSceneInfo() {
    const size_t tool = commands_.tools().chosen();
    scene_info_.set_revision(scene_info_.revision() + 1);
    scene_info_.set_tool_index(uint32_t(tool));
    scene_info_.set_burr_radius_m(tools_[tool].burr.radius);
    scene_info_.set_handpiece(shownHandpiece(tools_[tool].handpiece));
    fillTool(tools_[tool].surface, scene_info_.mutable_tool());
    describeBurr(scene_, tools_[tool].burr, scene_info_);
    publisher_.publishSceneInfo(scene_info_);
}

void ShowSession::round() {
    has_changed_ |= publishNodes();
    publishStructures();
    const int64_t now_ns = monotonicNowNs();
    if (now_ns - last_tool_state_ns_ > kToolStatePeriodNs) publishToolState(now_ns);
    commands_.attempts().round();
    task_.round();
    if (const auto eye = publisher_.takeEye()) {
        commands_.journal().noteEye(*eye);
        recorder_.setEye(eye->X_WC.position);
    }
    commands_.journal().round();
    carryOutCommands();
    followTool();
    publishDensities();
    publishLesson();
    publishPictures();
    if (now_ns - last_status_ns_ > (has_changed_ ? kStatusAfterChangeNs : kStatusPeriodNs)) publishStatus();
}

void ShowSession::finish(int64_t until_ns) {
    publishNodes();
    while (!outbox_.isEmpty() && monotonicNowNs() < until_ns) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the budget grows
        publishNodes();
    }
    publishLesson();
    publishStatus();
}

void ShowSession::endAttempt() {
    commands_.attempts().stop();
    task_.finish();
}

void ShowSession::leaveAnswers() {
    if (!under_way_) return;
    commands_.waitForResult();
    commands_.lesson().answerLater(*under_way_,
                                   commands_.takeResult().value_or(Answer::failed("the scene has ended")));
}

// Most sessions have nobody who reads every tick.
void ShowSession::publishToolState(int64_t now_ns) {
    if (publisher_.areTicksRead()) publisher_.publishTicks(recorder_.takeAll());
    const auto since = recorder_.takeSince();
    if (!since) return;
    std::optional<topics::EffectState> effects;
    if (effects_.areShown()) effects = effects_.at(since->latest.effects, since->events, since->removed);
    publisher_.publishToolState(since->latest, std::move(effects), expertNow());
    last_tool_state_ns_ = now_ns;
}

// During an attempt, where the expert was at that time of it; in a replay, the tool that it is compared with.
std::optional<Pose> ShowSession::expertNow() const {
    if (commands_.replay()) return commands_.replay()->otherTool();
    const JudgedTask* const task = task_.task();
    if (!task || !task->expert || !commands_.attempts().isRunning()) return std::nullopt;
    return task->expert->at(commands_.attempts().timeS());
}

// Nodes nearest to the burr go first, as many as the budget allows.
bool ShowSession::publishNodes() {
    Eigen::Vector3d burr_V = Eigen::Vector3d::Zero();
    if (const auto latest = recorder_.latest())
        burr_V = X_VW_ * Eigen::Map<const Eigen::Vector3d>(latest->p_WT);
    const int64_t now_ns = monotonicNowNs();
    const bool are_put = surroundings_.isDone();
    std::vector<NodeGroup> groups =
        outbox_.takeNearest(burr_V.cast<float>(), budget_.available(now_ns), now_ns);
    for (NodeGroup& group : groups) {
        const Publisher::Written written = publisher_.publishNodes(group.meshes, group.oldest_cut_ns);
        budget_.spend(written.bytes);
        if (!written.is_whole) outbox_.put(std::move(group), now_ns);  // next round; a newer revision wins
    }
    is_whole_ = is_whole_ || outbox_.hasGivenWhole();
    are_surroundings_shown_ = are_surroundings_shown_ || (are_put && outbox_.isEmpty());
    return !groups.empty();
}

// They are for people: what goes wrong there must not end the session.
std::vector<NodeMesh> ShowSession::takeStructures() {
    try {
        return structures_.get();
    } catch (const std::exception& error) {
        spdlog::error("protected structures cannot be shown: {}", error.what());
        return {};
    }
}

void ShowSession::publishStructures() {
    if (!isReady(structures_)) return;
    size_t triangles = 0;
    const std::vector<NodeMesh> meshes = takeStructures();
    for (const NodeMesh& mesh : meshes) {
        publisher_.publishStructure(mesh, warning_distance_);
        triangles += mesh.indices.size() / 3;
    }
    spdlog::info("{} protected structures are shown, with {} triangles", meshes.size(), triangles);
    has_changed_ = true;
}

// They come after all nodes: while a node waits nothing is left of the budget.
void ShowSession::publishDensities() {
    const int64_t now_ns = monotonicNowNs();
    const int64_t most = std::min(budget_.available(now_ns), density_budget_.available(now_ns));
    const size_t charged = densities_->round(now_ns, most);
    budget_.spend(charged);
    density_budget_.spend(charged);
}

// In a replay it changes without a command.
void ShowSession::followTool() {
    if (commands_.tools().chosen() != scene_info_.tool_index()) publishSceneInfo();
}

// Who reads that a command is done finds what it did in the same status.
void ShowSession::carryOutCommands() {
    for (const topics::Command& command : publisher_.takeCommands()) {
        const std::optional<Answer> result = commands_.carryOut(command);
        followTool();
        publishRemarks();
        if (result)
            answer(command, *result);
        else if (command.action_case() == topics::Command::kExport)
            under_way_ = command;
    }
    if (const auto result = commands_.takeResult()) answer(*std::exchange(under_way_, std::nullopt), *result);
    for (const auto& [command, result] : commands_.lesson().takeAnswers()) answer(command, result);
}

void ShowSession::answer(const topics::Command& command, const Answer& answer) {
    publishStatus();
    publisher_.acknowledge(command, answer);
    commands_.journal().noteOrder(command, answer.text);
    log(command, answer.text);
}

void ShowSession::log(const topics::Command& command, const std::string& result) {
    const int64_t left_out = orders_logged_.ask(monotonicNowNs());
    if (left_out < 0) return;
    if (left_out > 0) spdlog::info("{} orders were not logged", left_out);
    spdlog::info("order of {}: {}: {}", senderText(command, publisher_.proofOf(command)), orderText(command),
                 result);
}

void ShowSession::publishStatus() {
    last_status_ns_ = monotonicNowNs();
    has_changed_ = false;
    const LoopHealth health = recorder_.health();
    topics::Status status;
    status.set_scene(scene_name_);
    status.set_is_model_partial(!is_whole_ || !are_surroundings_shown_ || structures_.valid());
    status.set_preset(settingsName(commands_.accuracy().chosen()));
    // accuracy-report measures with the first tool.
    const auto figure = commands_.tools().chosen() == 0 ? figures_.find(status.preset()) : figures_.end();
    if (figure != figures_.end()) {
        status.set_has_accuracy_error(true);
        status.set_force_error_percent(figure->second.force_error_percent);
        status.set_force_direction_error_deg(figure->second.direction_error_deg);
    }
    status.set_ticks(health.ticks);
    status.set_rate_hz(health.rate_hz);
    status.set_tick_p50_us(health.tick_p50_us);
    status.set_tick_p99_us(health.tick_p99_us);
    status.set_tick_max_us(health.tick_max_us);
    status.set_dropped_ticks(health.dropped_ticks);
    status.set_faults(health.faults);
    status.set_fault_text(faultNames(health.faults));
    const auto latest = recorder_.latest();
    if (latest) {
        DeviceCapabilities capabilities;
        const bool is_known = device_(capabilities);
        *status.mutable_device() = shownDevice(*latest, is_known ? &capabilities : nullptr);
    }
    commands_.describe(status);
    if (!scene_.assessment().exam()) effects_.describe(recorder_.attempt().effects, material_names_, status);
    task_.describe(commands_.attempts().isRunning(), commands_.attempts().timeS(), status);
    status.set_device_stale(!latest || (latest->faults & kFaultStaleDevice));
    publisher_.publishStatus(std::move(status));
}

}  // namespace bonemill
