#include "render_client/link/subscribe/payloads.h"

#include <google/protobuf/stubs/logging.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "common/config/viewer_effects.h"
#include "common/dds/remark_bounds.h"
#include "render_client/link/subscribe/density_payloads.h"
#include "render_client/link/subscribe/scene_parts.h"

namespace bonemill {
namespace {

// A quaternion that went through double arithmetic stays far closer to unit length than this.
constexpr double kUnitTolerance = 1e-3;
constexpr size_t kLongestName = 64;   // bytes
constexpr size_t kLongestText = 512;  // bytes
constexpr double kLargestNumber = 1e6;
constexpr double kLongestSession = 1e9;  // s
constexpr int kMaxShownFigures = 16;
constexpr int kMostCheckpoints = 64;
constexpr int kMostTools = 64;  // far more than a scene may have
constexpr int kMostWarnings = 64;
constexpr int kMostShownZones = 32, kMostShownGates = 64;
constexpr int kMostScenes = 64;
constexpr size_t kMostPictureBytes = 64u << 10;
constexpr int kMostAttempts = 256;
constexpr int kMostStructures = 64;
constexpr int kMostBurrBalls = 64;             // far more than stand for any burr
constexpr double kLongestWarningDistance = 1;  // m

template <class Field>
bool isFinite(const Field& field) {
    return std::ranges::all_of(field, [](auto value) { return std::isfinite(value); });
}

bool isTime(double seconds) {
    return seconds >= 0 && seconds <= kLongestSession;
}

// The value is finite, and small enough that what is computed from it stays so.
bool isSane(double value) {
    return std::abs(value) <= kLargestNumber;
}

template <class Field>
bool isVector(const Field& field) {
    return field.size() == 3 && std::ranges::all_of(field, isSane);
}

template <class Field>
bool isQuaternion(const Field& field) {
    if (field.size() != 4 || !isFinite(field)) return false;
    const double norm = Eigen::Quaterniond(field[0], field[1], field[2], field[3]).norm();
    return std::abs(norm - 1) < kUnitTolerance;
}

bool isDrawable(const topics::TriangleMesh& mesh) {
    const int coordinates = mesh.vertices_m_size();
    const auto vertex_count = static_cast<uint32_t>(coordinates / 3);
    const auto& indices = mesh.indices();
    return coordinates % 3 == 0 && mesh.normals_size() == coordinates && indices.size() % 3 == 0 &&
           std::ranges::all_of(mesh.vertices_m(), isSane) && std::ranges::all_of(mesh.normals(), isSane) &&
           std::ranges::all_of(indices, [&](uint32_t index) { return index < vertex_count; });
}

bool isUsable(const topics::Camera& camera) {
    return (!camera.has_target() || isVector(camera.target_m())) &&
           (camera.up().empty() || isVector(camera.up())) && isSane(camera.distance_m()) &&
           camera.distance_m() >= 0 && isSane(camera.azimuth_rad()) && isSane(camera.elevation_rad());
}

bool areBalls(const google::protobuf::RepeatedField<float>& numbers) {
    return numbers.size() % 4 == 0 && numbers.size() <= 4 * kMostBurrBalls &&
           std::ranges::all_of(numbers, isSane);
}

bool isUsable(const topics::StructureMesh& structure) {
    return structure.warning_distance_m() > 0 && structure.warning_distance_m() <= kLongestWarningDistance;
}

bool isUsable(const topics::SceneInfo& info) {
    return isVector(info.p_wv_m()) && isQuaternion(info.q_wv()) && isVector(info.bone_min_m()) &&
           isVector(info.bone_max_m()) && isSane(info.burr_radius_m()) && info.burr_radius_m() >= 0 &&
           info.tool_names_size() <= kMostTools && isDrawable(info.tool()) && isUsable(info.camera()) &&
           info.materials_size() <= kMostShownMaterials && areBalls(info.burr_balls_m()) &&
           (!info.has_densities() || isUsableGrid(info.densities())) &&
           isWithinRanges(info.viewer_effects()) && std::ranges::all_of(info.materials(), isWithinRanges);
}

bool isUsable(const topics::EffectState& state) {
    const double numbers[] = {state.spin_speed(),           state.burr_force_n(),      state.axis_torque_nm(),
                              state.cutting_power_w(),      state.temperature_c(),     state.necrotic_mm3(),
                              state.protected_distance_m(), state.protected_force_n(), state.damaged_mm3(),
                              state.removed_mm3()};
    return std::ranges::all_of(numbers, isSane) && state.removed_mm3() >= 0 &&
           state.figures_size() <= kMaxShownFigures &&
           std::ranges::all_of(state.figures(), [](const auto& figure) { return isSane(figure.value()); });
}

bool isUsable(const topics::Training& training) {
    const double numbers[] = {training.damaged_mm3(), training.least_distance_mm(),
                              training.max_protected_force_n(), training.necrotic_mm3(),
                              training.max_temperature_c()};
    return std::ranges::all_of(numbers, isSane) && training.warnings_size() <= kMostWarnings;
}

bool isUsable(const topics::Replay& replay) {
    return isTime(replay.length_s()) && isTime(replay.known_s()) && isSane(replay.speed()) &&
           replay.speed() >= 0;
}

// Nothing, or a pose.
bool isExpert(const topics::ToolState& state) {
    return (state.p_wt_expert_m().empty() && state.q_wt_expert().empty()) ||
           (isVector(state.p_wt_expert_m()) && isQuaternion(state.q_wt_expert()));
}

bool isUsable(const topics::ToolState& state) {
    return isExpert(state) && isVector(state.p_wt_m()) && isQuaternion(state.q_wt()) &&
           isVector(state.p_wt_device_m()) && isQuaternion(state.q_wt_device()) &&
           isVector(state.force_n()) && isVector(state.torque_nm()) &&
           std::isfinite(state.max_penetration_m()) && isTime(state.session_s()) && isUsable(state.effects());
}

// States and causes of a later version are shown as unknown.
bool isUsable(const topics::Device& device) {
    return isSane(device.max_force_n()) && device.max_force_n() >= 0 && isSane(device.max_torque_nmm()) &&
           device.max_torque_nmm() >= 0 && isSane(device.coupling_share()) && isSane(device.rotation_share());
}

bool isUsable(const topics::TaskState& task) {
    const auto is_usable = [](const topics::TaskState::Zone& zone) {
        return isSane(zone.bone_mm3()) && isSane(zone.removed_mm3());
    };
    return task.zones_size() <= kMostShownZones && task.gates_size() <= kMostShownGates &&
           std::ranges::all_of(task.zones(), is_usable) && isSane(task.time_left_s()) && task.score() >= 0 &&
           task.score() <= 1;
}

bool isUsable(const topics::Status& status) {
    const double numbers[] = {status.rate_hz(),
                              status.tick_p50_us(),
                              status.tick_p99_us(),
                              status.tick_max_us(),
                              status.removed_mm3(),
                              status.force_error_percent(),
                              status.force_direction_error_deg()};
    const auto is_usable = [](const topics::Checkpoint& c) {
        return isTime(c.session_s()) && std::isfinite(c.removed_mm3());
    };
    return isFinite(numbers) && isTime(status.session_s()) && status.checkpoints_size() <= kMostCheckpoints &&
           std::ranges::all_of(status.checkpoints(), is_usable) && isUsable(status.training()) &&
           isUsable(status.device()) && isUsable(status.task()) && isUsable(status.replay());
}

bool isUsable(const topics::SceneChoice& scene) {
    return !scene.id().empty() && scene.id().size() <= kLongestName && scene.tools_size() <= kMostTools &&
           isTime(scene.expected_s()) && scene.picture().size() <= kMostPictureBytes;
}

bool isUsable(const topics::ScenePicture& picture) {
    return !picture.scene_id().empty() && picture.scene_id().size() <= kLongestName &&
           picture.png().size() <= kMostPictureBytes;
}

bool isUsable(const topics::Verdict& verdict) {
    const double score = verdict.score_percent();
    return verdict.failed_gates_size() <= kMostShownGates && score >= 0 && score <= 100;
}

bool isUsable(const topics::Attempt& attempt) {
    return isTime(attempt.time_s()) && isSane(attempt.removed_mm3()) && isSane(attempt.max_force_n()) &&
           attempt.max_force_n() >= 0 && isUsable(attempt.training()) &&
           attempt.structures_touched_size() <= kMostStructures && isUsable(attempt.verdict());
}

bool isUsable(const topics::Lesson& lesson) {
    const auto is_usable = [](const auto& part) { return isUsable(part); };
    return lesson.scenes_size() <= kMostScenes && lesson.attempts_size() <= kMostAttempts &&
           std::ranges::all_of(lesson.scenes(), is_usable) &&
           std::ranges::all_of(lesson.attempts(), is_usable);
}

bool isUsable(const topics::Remark& remark) {
    const int points = remark.points_m_size() / 3;
    const bool has_points = remark.note().empty() ? points >= 2 && points <= kMostRemarkPoints : points <= 1;
    return remark.number() > 0 && isTime(remark.session_s()) && remark.points_m_size() % 3 == 0 &&
           has_points && std::ranges::all_of(remark.points_m(), isSane) &&
           topics::Viewer::Role_IsValid(remark.role());
}

bool isUsable(const topics::Viewer& viewer) {
    return std::isfinite(viewer.frame_rate_hz()) && viewer.frame_rate_hz() >= 0 &&
           (viewer.pointer_m().empty() || isVector(viewer.pointer_m())) &&
           topics::Viewer::Role_IsValid(viewer.role());
}

// Returns what stands on a screen: no control signs, no broken UTF-8 (cut off with all that
// follows), not too long.
std::string shownText(const std::string& name, size_t longest) {
    std::string shown;
    for (size_t i = 0; i < name.size() && shown.size() < longest;) {
        const auto lead = static_cast<unsigned char>(name[i]);
        const size_t length = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
        if (i + length > name.size() || shown.size() + length > longest) break;
        if (length > 1 || std::isprint(lead)) shown.append(name, i, length);
        i += length;
    }
    return shown;
}
std::string shownName(const std::string& name) {
    return shownText(name, kLongestName);
}

// These are bytes, what sane messages need many times over.
constexpr size_t mostBytes(const topics::SceneInfo*) {
    return 64u << 20;
}
constexpr size_t mostBytes(const topics::StructureMesh*) {
    return 4u << 20;
}
constexpr size_t mostBytes(const topics::ToolState*) {
    return 4u << 10;
}
constexpr size_t mostBytes(const topics::Status*) {
    return 64u << 10;
}
constexpr size_t mostBytes(const topics::Lesson*) {
    return 8u << 20;
}
constexpr size_t mostBytes(const topics::ScenePicture*) {
    return 128u << 10;
}

constexpr size_t mostBytes(const topics::Remark*) {
    return 8u << 10;
}
constexpr size_t mostBytes(const topics::Viewer*) {
    return 4u << 10;
}

void keepShownText(topics::Training& training) {
    for (std::string& warning : *training.mutable_warnings()) warning = shownText(warning, kLongestText);
    training.set_nearest_structure(shownName(training.nearest_structure()));
}

void keepShownText(topics::TaskState& task) {
    for (topics::TaskState::Zone& zone : *task.mutable_zones()) zone.set_name(shownName(zone.name()));
    for (topics::TaskState::Gate& gate : *task.mutable_gates())
        gate.set_text(shownText(gate.text(), kLongestText));
}

void keepShownText(topics::SceneChoice& scene) {
    scene.set_id(shownName(scene.id()));
    scene.set_title(shownName(scene.title()));
    scene.set_task(shownText(scene.task(), kLongestText));
    scene.set_problem(shownText(scene.problem(), kLongestText));
    for (std::string& tool : *scene.mutable_tools()) tool = shownName(tool);
}

void keepShownText(topics::Attempt& attempt) {
    attempt.set_trainee(shownName(attempt.trainee()));
    attempt.set_scene_id(shownName(attempt.scene_id()));
    if (attempt.has_training()) keepShownText(*attempt.mutable_training());
    for (std::string& name : *attempt.mutable_structures_touched()) name = shownName(name);
    if (!attempt.has_verdict()) return;
    topics::Verdict& verdict = *attempt.mutable_verdict();
    for (std::string& gate : *verdict.mutable_failed_gates()) gate = shownText(gate, kLongestText);
    verdict.set_results(shownText(verdict.results(), kLongestText));
}

template <class Message>
std::optional<Message> parse(std::span<const uint8_t> payload) {
    // Bad bytes are counted by the caller; a hostile peer must not fill the log.
    const google::protobuf::LogSilencer silencer;
    Message message;
    if (payload.size() > mostBytes(&message) ||
        !message.ParseFromArray(payload.data(), static_cast<int>(payload.size())) || !isUsable(message))
        return std::nullopt;
    return message;
}

template <class Message>
std::optional<Message> parseOfEpoch(std::span<const uint8_t> payload) {
    std::optional<Message> message = parse<Message>(payload);
    if (message && message->epoch() == 0) message.reset();
    return message;
}

}  // namespace

std::optional<DecodedNode> parseNode(std::span<const uint8_t> payload, uint32_t leaf, uint32_t revision) {
    const std::string_view bytes(reinterpret_cast<const char*>(payload.data()), payload.size());
    std::optional<DecodedNode> node = decodeNodeMesh(bytes, leaf);
    if (!node || node->mesh.isEmpty() || node->mesh.revision != revision || node->tag.epoch == 0)
        return std::nullopt;
    return node;
}

std::optional<StructureSurface> parseStructure(std::span<const uint8_t> payload, uint32_t structure) {
    const auto message = parseOfEpoch<topics::StructureMesh>(payload);
    if (!message || structure == 0 || structure > uint32_t(kMostShownMaterials)) return std::nullopt;
    std::optional<DecodedNode> node = decodeNodeMesh(message->surface(), structure);
    if (!node || node->mesh.isEmpty() || node->tag.epoch != message->epoch() ||
        std::max(node->mesh.vertices.size(), node->mesh.indices.size() / 3) > kMostStructureVertices)
        return std::nullopt;
    return StructureSurface{std::move(node->mesh), message->warning_distance_m(), message->epoch()};
}

std::optional<topics::SceneInfo> parseSceneInfo(std::span<const uint8_t> payload) {
    std::optional<topics::SceneInfo> info = parseOfEpoch<topics::SceneInfo>(payload);
    if (!info) return info;
    info->set_name(shownName(info->name()));
    for (std::string& name : *info->mutable_tool_names()) name = shownName(name);
    if (info->has_viewer_effects()) keepViewerEffects(*info->mutable_viewer_effects());
    for (scene::Material& material : *info->mutable_materials()) {
        keepShownParts(material);
        material.set_name(shownName(material.name()));
    }
    return info;
}

std::optional<topics::ToolState> parseToolState(std::span<const uint8_t> payload) {
    std::optional<topics::ToolState> state = parseOfEpoch<topics::ToolState>(payload);
    if (!state || !state->has_effects()) return state;
    for (topics::ShownFigure& figure : *state->mutable_effects()->mutable_figures()) {
        figure.set_words(shownName(figure.words()));
        figure.set_unit(shownName(figure.unit()));
    }
    return state;
}

std::optional<topics::Status> parseStatus(std::span<const uint8_t> payload) {
    std::optional<topics::Status> status = parseOfEpoch<topics::Status>(payload);
    if (!status) return status;
    for (std::string* text : {status->mutable_scene(), status->mutable_preset(), status->mutable_fault_text(),
                              status->mutable_last_command_result()})
        *text = shownText(*text, kLongestText);
    if (status->has_device()) status->mutable_device()->set_name(shownName(status->device().name()));
    if (status->has_training()) keepShownText(*status->mutable_training());
    if (status->has_task()) keepShownText(*status->mutable_task());
    if (status->has_replay())
        status->mutable_replay()->set_event(shownText(status->replay().event(), kLongestText));
    return status;
}

std::optional<topics::Lesson> parseLesson(std::span<const uint8_t> payload) {
    std::optional<topics::Lesson> lesson = parseOfEpoch<topics::Lesson>(payload);
    if (!lesson) return lesson;
    lesson->DiscardUnknownFields();
    for (std::string* name :
         {lesson->mutable_scene_id(), lesson->mutable_trainee(), lesson->mutable_changing_to()})
        *name = shownName(*name);
    for (topics::SceneChoice& scene : *lesson->mutable_scenes()) keepShownText(scene);
    for (topics::Attempt& attempt : *lesson->mutable_attempts()) keepShownText(attempt);
    return lesson;
}

std::optional<topics::ScenePicture> parseScenePicture(std::span<const uint8_t> payload, uint32_t scene) {
    std::optional<topics::ScenePicture> picture = parseOfEpoch<topics::ScenePicture>(payload);
    if (!picture || scene >= uint32_t(kMostScenes)) return std::nullopt;
    picture->DiscardUnknownFields();
    picture->set_scene_id(shownName(picture->scene_id()));
    return picture;
}

std::optional<topics::Remark> parseRemark(std::span<const uint8_t> payload, uint32_t place) {
    std::optional<topics::Remark> remark = parseOfEpoch<topics::Remark>(payload);
    if (!remark || place >= kMostRemarks || lettersOf(remark->note()) > kMostNoteLetters) return std::nullopt;
    remark->DiscardUnknownFields();
    remark->set_author(shownName(remark->author()));
    remark->set_note(shownText(remark->note(), remark->note().size()));
    remark->set_color(remark->color() & 0xffffff);
    if (remark->note().empty() && remark->points_m_size() < 6) return std::nullopt;
    return remark;
}

std::optional<topics::Viewer> parseViewer(std::span<const uint8_t> payload, uint64_t sender) {
    std::optional<topics::Viewer> viewer = parse<topics::Viewer>(payload);
    if (!viewer || viewer->sender() != sender || sender == 0) return std::nullopt;
    viewer->DiscardUnknownFields();
    viewer->set_name(shownName(viewer->name()));
    viewer->set_link(shownName(viewer->link()));
    if (viewer->role() != topics::Viewer::INSTRUCTOR) viewer->clear_pointer_m();
    if (viewer->role() != topics::Viewer::OPERATOR && viewer->role() != topics::Viewer::INSTRUCTOR)
        viewer->clear_is_holding();
    return viewer;
}

}  // namespace bonemill
