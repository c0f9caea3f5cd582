#include "haptic_server/recording/foxglove/foxglove_export.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/base/units.h"
#include "common/text/foreign_text.h"
#include "haptic_server/recording/foxglove/foxglove_layout.h"
#include "haptic_server/recording/foxglove/foxglove_messages.h"
#include "haptic_server/scene/setup/scene_structures.h"

namespace bonemill {
namespace {

constexpr double kFramesPerS = 100, kForcesPerS = 50;
constexpr double kPauseOfCut = 0.1;   // s
constexpr double kLeastForce = 0.02;  // N, that is seen as an arrow
constexpr Rgb kToolColor{0.6, 0.62, 0.66}, kStructureColor{0.95, 0.6, 0.2};

// When its first tick started: its inputs say so, as the journal counts.
uint64_t firstStampOf(const Recording& recording) {
    std::optional<uint64_t> first_ns;
    readJournal(recording.path(), [&](JournalTopic topic, const mcap::Message& message) {
        if (topic == JournalTopic::kInputs && !first_ns) first_ns = message.time_ns;
    });
    return first_ns.value_or(0);
}

uint64_t ticksPer(double times_per_s, double rate_hz) {
    return uint64_t(std::max(1.0, std::round(rate_hz / times_per_s)));
}

Pose poseOf(const double (&p)[3], const double (&q)[4]) {
    return {Eigen::Vector3d(p), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

Rgb colorOf(const scene::Material& material) {
    if (!material.has_color()) return kStructureColor;
    return {material.color().red(), material.color().green(), material.color().blue()};
}

plots::Tick numbersOf(const TickRecord& record) {
    plots::Tick message;
    const double(&force)[3] = record.f_hand_W, (&torque)[3] = record.t_hand_W;
    message.set_t_s(record.t_s);
    message.set_force_x_n(force[0]), message.set_force_y_n(force[1]), message.set_force_z_n(force[2]);
    message.set_torque_x_nm(torque[0]), message.set_torque_y_nm(torque[1]),
        message.set_torque_z_nm(torque[2]);
    message.set_force_n(Eigen::Vector3d(force).norm());
    message.set_contacts(record.contacts);
    message.set_penetration_m(record.max_penetration);
    message.set_removed_mm3(record.removed * kPerCubicMillimetre);
    message.set_faults(record.faults);
    return message;
}

}  // namespace

std::string layoutPathOf(const std::string& path) {
    return path.empty() ? "" : std::filesystem::path(path).replace_extension(".layout.json").string();
}

FoxgloveExport::FoxgloveExport(const std::string& path, const Recording& recording, const scene::Scene& scene,
                               const SceneSetup& simulation)
    : path_(path),
      recording_(recording),
      scene_(scene),
      simulation_(simulation),
      file_(path),
      tool_pose_(topic("/tool/pose", *foxglove::PoseInFrame::descriptor())),
      hand_pose_(topic("/hand/pose", *foxglove::PoseInFrame::descriptor())),
      tick_(topic("/tick", *plots::Tick::descriptor())),
      frames_(topic("/frames", *foxglove::FrameTransforms::descriptor())),
      force_(topic("/force", *foxglove::SceneUpdate::descriptor())),
      tool_(topic("/tool/shape", *foxglove::SceneUpdate::descriptor())),
      structures_(topic("/structures", *foxglove::SceneUpdate::descriptor())),
      log_(topic("/log", *foxglove::Log::descriptor())),
      cuts_(topic("/cuts", *plots::Cut::descriptor())),
      bone_(simulation, file_),
      first_stamp_ns_(firstStampOf(recording)),
      frames_pace_{ticksPer(kFramesPerS, recording.manifest().rate_hz())},
      force_pace_{ticksPer(kForcesPerS, recording.manifest().rate_hz())} {}

void FoxgloveExport::add(const TickRecord& record, int64_t session_ns, const ReplayEvents& events) {
    stamp_ns_ = first_stamp_ns_ + uint64_t(session_ns);
    if (frames_pace_.isDue(record.tick) || !has_begun_) putFrames(record);
    if (!std::exchange(has_begun_, true)) begin();
    file_.put(tool_pose_, stamp_ns_, poseInWorld(stamp_ns_, record.p_WT, record.q_WT));
    file_.put(hand_pose_, stamp_ns_, poseInWorld(stamp_ns_, record.p_WT_device, record.q_WT_device));
    putNumbers(record);
    if (force_pace_.isDue(record.tick)) putForce(record);
    if (shown_tool_ != record.tool) putTool(record.tool);
    addToCut(record);
    if (const auto event = events.at(record.tick)) log(event->text);
    bone_.update(record.t_s, stamp_ns_);
}

void FoxgloveExport::begin() {
    const journal::Manifest& manifest = recording_.manifest();
    log("session of the scene '" + printableLine(manifest.scene_name()) + "', recording " +
        printableLine(manifest.journal_id()) + ", by " + printableLine(manifest.build().version()));
    if (manifest.has_what_if())
        log("nobody did this: recording " + printableLine(manifest.what_if().journal_id()) +
            " goes on otherwise from tick " + std::to_string(manifest.what_if().tick()) + ": " +
            printableLine(manifest.what_if().change()));
    putStructures();
}

// Each message has them all: a viewer that jumps has no other one.
void FoxgloveExport::putFrames(const TickRecord& record) {
    foxglove::FrameTransforms message;
    const Pose& X_WV = simulation_.bone->volume.geometry().X_WV;
    addTransform(stamp_ns_, "W", "V", X_WV, &message);
    addTransform(stamp_ns_, "W", "T", poseOf(record.p_WT, record.q_WT), &message);
    addTransform(stamp_ns_, "W", "hand", poseOf(record.p_WT_device, record.q_WT_device), &message);
    addTransform(stamp_ns_, "W", "D", simulation_.X_WD, &message);
    file_.put(frames_, stamp_ns_, message);
}

void FoxgloveExport::putNumbers(const TickRecord& record) {
    plots::Tick message = numbersOf(record);
    removed_sum_mm3_ += message.removed_mm3();
    message.set_removed_sum_mm3(removed_sum_mm3_);
    setTime(stamp_ns_, message.mutable_timestamp());
    file_.put(tick_, stamp_ns_, message);
}

void FoxgloveExport::putForce(const TickRecord& record) {
    const Eigen::Vector3d force(record.f_hand_W);
    const bool is_seen = force.norm() >= kLeastForce;
    foxglove::SceneUpdate update;
    if (is_seen) {
        addForceArrow(Eigen::Vector3d(record.p_WT), force, addEntity(stamp_ns_, "W", "force", &update));
    } else if (has_force_) {
        foxglove::SceneEntityDeletion* const none = update.add_deletions();
        none->set_type(foxglove::SceneEntityDeletion::ALL);
        setTime(stamp_ns_, none->mutable_timestamp());
    }
    if (is_seen || has_force_) file_.put(force_, stamp_ns_, update);
    has_force_ = is_seen;
}

void FoxgloveExport::putTool(uint32_t tool) {
    shown_tool_ = tool;
    const SceneTool& shown = simulation_.tools.at(tool);
    foxglove::SceneUpdate update;
    foxglove::SceneEntity* const entity = addEntity(stamp_ns_, "T", "tool", &update);
    foxglove::KeyValuePair* const name = entity->add_metadata();
    name->set_key("name"), name->set_value(shown.name);
    foxglove::TriangleListPrimitive* const list = entity->add_triangles();
    setPose({}, list->mutable_pose());
    setColor(kToolColor, list->mutable_color());
    for (const Eigen::Vector3f& p : shown.surface.positions) {
        foxglove::Point3* const point = list->add_points();
        point->set_x(double(p.x())), point->set_y(double(p.y())), point->set_z(double(p.z()));
    }
    list->mutable_indices()->Add(shown.surface.indices.begin(), shown.surface.indices.end());
    file_.put(tool_, stamp_ns_, update);
}

void FoxgloveExport::putStructures() {
    const auto mesh_structures = structureMesherOf(simulation_);
    if (!mesh_structures) return;
    const scene::Scene shown = shownSceneOf(scene_, simulation_.segment_colors);
    foxglove::SceneUpdate update;
    for (const NodeMesh& mesh : mesh_structures()) {
        const scene::Material& material = shown.material(int(mesh.leaf) - 1);
        foxglove::SceneEntity* const entity =
            addEntity(stamp_ns_, "V", "structure " + material.name(), &update);
        addNode(mesh, colorOf(material), entity);
    }
    file_.put(structures_, stamp_ns_, update);
}

void FoxgloveExport::addToCut(const TickRecord& record) {
    if (cut_ && record.t_s - cut_->end_s() > kPauseOfCut) tellCut();
    if (record.removed_voxels == 0 && record.removed <= 0) return;
    if (!cut_) cut_.emplace().set_begin_s(record.t_s);
    setTime(stamp_ns_, cut_->mutable_timestamp());
    cut_->set_end_s(record.t_s);
    cut_->set_removed_mm3(cut_->removed_mm3() + record.removed * kPerCubicMillimetre);
    cut_->set_removed_voxels(cut_->removed_voxels() + record.removed_voxels);
    cut_->set_force_n(std::max(cut_->force_n(), Eigen::Vector3d(record.f_hand_W).norm()));
    cut_->set_tool_x_m(record.p_WT[0]), cut_->set_tool_y_m(record.p_WT[1]),
        cut_->set_tool_z_m(record.p_WT[2]);
}

void FoxgloveExport::tellCut() {
    file_.put(cuts_, stamp_ns_, *cut_);
    cut_.reset();
}

void FoxgloveExport::log(const std::string& text) {
    foxglove::Log message;
    setTime(stamp_ns_, message.mutable_timestamp());
    message.set_level(foxglove::Log::INFO);
    message.set_name("bonemill");
    message.set_message(text);
    file_.put(log_, stamp_ns_, message);
}

void FoxgloveExport::finish() {
    if (cut_) tellCut();
    bone_.finish(stamp_ns_);
    const Pose& X_WV = simulation_.bone->volume.geometry().X_WV;
    const VolumeGeometry& geometry = simulation_.bone->volume.geometry();
    const Eigen::Vector3d size = geometry.spacing.cwiseProduct(geometry.dims.cast<double>());
    writeFoxgloveLayout(layoutPathOf(path_), file_.topics(), X_WV * (size / 2), size.norm());
    file_.finish();
}

}  // namespace bonemill
