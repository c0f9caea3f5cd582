#include "haptic_server/scene/setup/scene_task.h"

#include <algorithm>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "common/text/hex_text.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_shapes.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"

namespace bonemill {
namespace {

std::vector<bool> areProtectedOf(const scene::Scene& scene) {
    std::vector<bool> are_protected;
    for (const scene::Material& material : scene.material()) are_protected.push_back(material.is_protected());
    return are_protected;
}

using ZoneShapes = google::protobuf::RepeatedPtrField<scene::Task::Shape>;

std::string fieldOf(const std::string& list, int index) {
    return "assessment." + list + "[" + std::to_string(index) + "]";
}

class TaskReader {
  public:
    TaskReader(const LoadedScene& loaded, const VoxelVolume& scanned,
               std::shared_ptr<const BoneProperties> properties)
        : loaded_(loaded), scene_(loaded.scene), message_(loaded.scene.assessment()), scanned_(scanned) {
        task_->properties = std::move(properties);
    }

    std::shared_ptr<const JudgedTask> read() {
        readZones();
        readReference();
        readStructures();
        readRules();
        readExpert();
        const Pose X_VW = scanned_.geometry().X_WV.inverse();
        if (message_.has_approach())
            task_->approach_V = (X_VW.rotation * vectorOf(message_.approach())).normalized();
        if (message_.has_plan())
            task_->plan = PlannedLine{X_VW * metresOf(message_.plan().entry_mm()),
                                      X_VW * metresOf(message_.plan().tip_mm()),
                                      message_.plan().free_mm() * kMillimetre};
        task_->skeletonised = message_.skeletonised_mm() * kMillimetre;
        return task_;
    }

  private:
    [[noreturn]] void refuseTask(const std::string& path, const std::string& why) const {
        throw UserError(placeOf(loaded_.file.string(), loaded_.lines, path) + "field `" + path + "` " + why);
    }

    std::vector<uint8_t> inside(const ZoneShapes& shapes, const std::string& path) const {
        return voxelsInside(loaded_, shapes, scanned_.geometry(), path);
    }

    template <class Visit>
    void forEachVoxel(Visit&& visit) const {
        size_t at = 0;
        forEachIndex({Eigen::Vector3i::Zero(), scanned_.dims().array() - 1},
                     [&](const Eigen::Vector3i& v) { visit(v, at++); });
    }
    bool isScannedBone(const Eigen::Vector3i& v) const {
        return scanned_.at(v.x(), v.y(), v.z()) >= scanned_.iso();
    }

    std::vector<bool> materialsOf(const scene::Task::Zone& zone) const {
        std::vector<bool> wanted(size_t(scene_.material_size()) + 1);
        for (int n = 0; n < scene_.material_size(); ++n)
            wanted[size_t(n) + 1] = std::ranges::count(zone.material(), scene_.material(n).name()) > 0;
        return wanted;
    }

    void readZones() {
        std::vector<ZoneId> ids(scanned_.geometry().voxelCount(), kNoZone);
        for (int n = 0; n < message_.zone_size(); ++n) {
            const scene::Task::Zone& zone = message_.zone(n);
            task_->zones.push_back({zone.name(), ZoneRole(zone.role())});
            const std::vector<uint8_t> marks =
                zone.shape_size() > 0 ? inside(zone.shape(), fieldOf("zone", n)) : std::vector<uint8_t>();
            const std::vector<bool> wanted = materialsOf(zone);
            forEachVoxel([&](const Eigen::Vector3i& v, size_t at) {
                const bool is_inside = marks.empty() || marks[at];
                if (is_inside && (zone.material_size() == 0 || wanted[task_->properties->material(v)]))
                    ids[at] = ZoneId(n + 1);
            });
        }
        requireVoxels(ids);
        task_->map = std::make_shared<const VoxelIds>(scanned_.dims(), ids);
    }

    // A zone in the wrong place is most often a slip, and would judge everybody wrongly.
    void requireVoxels(const std::vector<ZoneId>& ids) const {
        std::vector<bool> has_voxel(task_->zones.size() + 1), has_bone(task_->zones.size() + 1);
        forEachVoxel([&](const Eigen::Vector3i& v, size_t at) {
            has_voxel[ids[at]] = true;
            if (isScannedBone(v)) has_bone[ids[at]] = true;
        });
        for (size_t n = 0; n < task_->zones.size(); ++n) {
            const ZoneRole role = task_->zones[n].role;
            const bool needs_bone = role != ZoneRole::kProtected && role != ZoneRole::kContext;
            if (needs_bone ? has_bone[n + 1] : has_voxel[n + 1]) continue;
            refuseTask(fieldOf("zone", int(n)), std::string("\"") + task_->zones[n].name + "\" holds no " +
                                                    (needs_bone ? "bone" : "voxel") +
                                                    ": check where it lies (mm in W), and what zones "
                                                    "after it take");
        }
    }

    void readReference() {
        if (!message_.has_reference()) return;
        std::vector<ZoneId> ids;
        if (message_.reference().shape_size() > 0)
            ids = inside(message_.reference().shape(), "assessment.reference");
        else
            ids = goneIn(message_.reference().volume_path());
        int64_t gone = 0, left = 0;
        forEachVoxel([&](const Eigen::Vector3i& v, size_t at) {
            if (isScannedBone(v)) ++(ids[at] ? gone : left);
        });
        if (gone == 0 || left == 0)
            refuseTask("assessment.reference",
                       std::string(gone == 0 ? "takes no bone away" : "leaves no bone") +
                           ": check where it lies; a file must hold the densities that --save-volume writes");
        task_->reference = std::make_shared<const VoxelIds>(scanned_.dims(), ids);
    }

    // What is bone here, and none in the saved densities.
    std::vector<ZoneId> goneIn(const std::string& volume_path) const {
        const std::string path = "assessment.reference.volume_path";
        RawVolume saved;
        try {
            saved = importVolume(resolvePath(loaded_, volume_path));
        } catch (const UserError& error) {
            refuseTask(path, std::string(": ") + error.what());
        }
        requireSameGrid(saved.geometry, path);
        if (saved.values.range().low < 0 || saved.values.range().high > kMaxDensity)
            refuseTask(path, "holds values outside 0 .. 65535: give the densities that --save-volume writes");
        std::vector<ZoneId> ids(saved.values.size());
        for (size_t n = 0; n < ids.size(); ++n) ids[n] = saved.values[n] < float(scanned_.iso());
        return ids;
    }

    void requireSameGrid(const VolumeGeometry& saved, const std::string& path) const {
        const VolumeGeometry& own = scanned_.geometry();
        const double voxel = own.spacing.minCoeff();
        const Eigen::Vector3d far = own.spacing.cwiseProduct(own.dims.cast<double>());
        const bool is_same = saved.dims == own.dims &&
                             ((saved.spacing - own.spacing).array().abs() < 1e-3 * voxel).all() &&
                             (saved.X_WV.position - own.X_WV.position).norm() < 0.25 * voxel &&
                             (saved.X_WV * far - own.X_WV * far).norm() < 0.25 * voxel;
        if (!is_same)
            refuseTask(path, "lies on another grid than volume.path: give densities of the same scan");
    }

    void readStructures() {
        for (int n = 0; n < scene_.material_size(); ++n)
            if (scene_.material(n).is_protected())
                task_->structures.push_back(
                    {.name = scene_.material(n).name(), .material = MaterialId(n + 1)});
        for (size_t n = 0; n < task_->zones.size(); ++n)
            if (task_->zones[n].role == ZoneRole::kProtected)
                task_->structures.push_back({.name = task_->zones[n].name, .zone = ZoneId(n + 1)});
    }

    void readRules() {
        for (const scene::Task::Gate& gate : message_.gate())
            task_->gates.push_back({.figure_id = gate.figure(),
                                    .label = gate.label(),
                                    .limit = gate.has_at_most() ? gate.at_most() : gate.at_least(),
                                    .is_most = gate.has_at_most()});
        for (const scene::Task::SubScore& score : message_.sub_score())
            task_->scores.push_back({.figure_id = score.figure(),
                                     .label = score.label(),
                                     .worst = score.worst(),
                                     .best = score.best(),
                                     .weight = score.weight()});
        task_->weights_version = int(message_.weights_version());
        task_->weights_hash = hexText(rulesHash());
        task_->time_limit_s = message_.time_limit_s();
        task_->most_attempts = int(message_.most_attempts());
        task_->is_exam = message_.exam();
        task_->feedback = message_.exam() ? TaskFeedback::kNever : TaskFeedback(message_.feedback());
    }

    void readExpert() {
        if (message_.expert_path().empty()) return;
        std::vector<ExpertPath::Point> points;
        try {
            for (const TrajectoryRow& row :
                 readTrajectory(resolvePath(loaded_, message_.expert_path()).string()))
                points.push_back({row.t_s, {row.X_WT.position, row.X_WT.rotation.normalized()}});
        } catch (const UserError& error) {
            refuseTask("assessment.expert_path", std::string(": ") + error.what());
        }
        if (!message_.exam()) task_->expert = std::make_shared<const ExpertPath>(std::move(points));
    }

    uint64_t rulesHash() const {
        scene::Scene rules;
        scene::Task& task = *rules.mutable_assessment();
        *task.mutable_gate() = message_.gate();
        *task.mutable_sub_score() = message_.sub_score();
        task.set_weights_version(message_.weights_version());
        return sceneHashOf(rules) + uint64_t(kTotalFormula);
    }

    const LoadedScene& loaded_;
    const scene::Scene& scene_;
    const scene::Task& message_;
    const VoxelVolume& scanned_;
    std::shared_ptr<JudgedTask> task_ = std::make_shared<JudgedTask>();
};

}  // namespace

TechniqueScene techniqueSceneOf(const scene::Scene& scene) {
    return {.recorded = recordedEffectsOf(scene.effects()),
            .materials = materialNamesOf(scene),
            .are_protected = areProtectedOf(scene),
            .tools = toolNamesOf(scene),
            .force_limit = scene.assessment().force_limit_n()};
}

// Bone that the burr touches hides nothing: the line of sight ends before it.
std::function<std::unique_ptr<Technique>()> techniqueMaker(const scene::Scene& scene,
                                                           const SceneSetup& simulation) {
    std::vector<double> margins;
    for (const SceneTool& tool : simulation.tools)
        margins.push_back(tool.burr.radius + simulation.bone->volume.spacing().norm());
    const VoxelVolume& volume = simulation.bone->volume;
    const auto is_hidden = [&volume, margins](const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_burr_W,
                                              uint32_t tool) {
        return isHidden(volume, p_eye_W, p_burr_W, margins[std::min(size_t(tool), margins.size() - 1)]);
    };
    return [described = techniqueSceneOf(scene), is_hidden] {
        return std::make_unique<Technique>(described, is_hidden);
    };
}

std::shared_ptr<const JudgedTask> judgedTaskOf(const LoadedScene& loaded, const VoxelVolume& scanned,
                                               std::shared_ptr<const BoneProperties> properties) {
    if (!loaded.scene.has_assessment()) return nullptr;
    return TaskReader(loaded, scanned, std::move(properties)).read();
}

}  // namespace bonemill
