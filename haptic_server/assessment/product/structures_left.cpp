#include "haptic_server/assessment/product/structures_left.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kStructureVersion = 1;
constexpr double kNormalReach = 2.5;  // voxels
constexpr double kGap = 1.5;          // voxels of soft edge between a structure and its bone
constexpr double kCoverStepsPerVoxel = 4;

double densityAt(const VoxelVolume& volume, const Eigen::Vector3d& p_V) {
    const Eigen::Array3d place = p_V.array() / volume.spacing().array();
    const Eigen::Array3d low = place.floor(), t = place - low;
    const Eigen::Vector3i voxel = low.cast<int>();
    if ((voxel.array() < -1).any() || (voxel.array() >= volume.dims().array()).any()) return 0;
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i step(corner & 1, corner >> 1 & 1, corner >> 2);
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) weight *= step[axis] ? t[axis] : 1 - t[axis];
        const Eigen::Vector3i v = voxel + step;
        if (weight > 0) sum += weight * double(volume.at(v.x(), v.y(), v.z()));
    }
    return sum;
}

class StructureSurvey {
  public:
    StructureSurvey(const VoxelVolume& scanned, const VoxelVolume& now, const JudgedTask& task)
        : scanned_(scanned),
          now_(now),
          task_(task),
          voxel_(scanned.spacing().maxCoeff()),
          step_(scanned.spacing().minCoeff() / kCoverStepsPerVoxel) {
        const Eigen::Array3d reach = (kNormalReach * voxel_ / scanned.spacing().array()).ceil();
        window_ = reach.cast<int>().min(6);
    }

    void visit(const Eigen::Vector3i& voxel, const Structure& structure, StructureState& state) const {
        const Density before = scanned_.at(voxel.x(), voxel.y(), voxel.z()),
                      after = now_.at(voxel.x(), voxel.y(), voxel.z()), iso = scanned_.iso();
        state.lost += before >= iso ? after < iso : before > 0 && after <= before / 2;
        for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1})
                if (!task_.isOf(structure, voxel + side * Eigen::Vector3i::Unit(axis)))
                    visitFace(voxel, axis, side, structure, state);
    }

  private:
    void visitFace(const Eigen::Vector3i& voxel, int axis, int side, const Structure& structure,
                   StructureState& state) const {
        const Eigen::Vector3d normal = normalAt(voxel, axis, side, structure);
        const Eigen::Vector3d& h = scanned_.spacing();
        const double cosine = side * normal[axis];
        if (!(cosine > 0)) return;
        const double area = cosine * h.prod() / h[axis];
        Eigen::Vector3d start = voxel.cast<double>().cwiseProduct(h);
        start[axis] += side * h[axis] / 2;
        const double was = coverAt(scanned_, start, normal);
        if (was == 0) return;
        const double is = coverAt(now_, start, normal);
        if (is == 0)
            state.exposed += area;
        else if (is <= task_.skeletonised && is < was - step_ / 2)
            state.skeletonised += area;
        else
            state.covered += area;
    }

    // The middle of the structure's voxels around a face lies behind the face.
    Eigen::Vector3d normalAt(const Eigen::Vector3i& voxel, int axis, int side,
                             const Structure& structure) const {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        const Eigen::Vector3d& h = scanned_.spacing();
        Eigen::Vector3d face = Eigen::Vector3d::Zero();
        face[axis] = side * 0.5;
        const double reach = kNormalReach * voxel_;
        const Eigen::Vector3i window = window_.matrix();
        forEachIndex({-window, window}, [&](const Eigen::Vector3i& d) {
            const Eigen::Vector3d way = (d.cast<double>() - face).cwiseProduct(h);
            if (way.squaredNorm() < reach * reach && task_.isOf(structure, voxel + d)) sum -= way;
        });
        const double length = sum.norm();
        return length > 0 ? Eigen::Vector3d(sum / length)
                          : Eigen::Vector3d(side * Eigen::Vector3d::Unit(axis));
    }

    // In m along the normal, at most a step more than what is asked for; 0: there is no bone over it.
    double coverAt(const VoxelVolume& volume, const Eigen::Vector3d& start,
                   const Eigen::Vector3d& normal) const {
        const double gap = kGap * voxel_, most = gap + task_.skeletonised + 2 * step_;
        double begin = -1;
        for (double s = step_; s < most; s += step_) {
            const bool is_bone = densityAt(volume, start + s * normal) >= double(volume.iso());
            if (is_bone && begin < 0) begin = s;
            if (begin < 0 && s > gap) return 0;
            if (!is_bone && begin >= 0) return s - begin;
            if (begin >= 0 && s - begin > task_.skeletonised) return s - begin;
        }
        return begin < 0 ? 0 : most - begin;
    }

    const VoxelVolume& scanned_;
    const VoxelVolume& now_;
    const JudgedTask& task_;
    double voxel_, step_;  // m
    Eigen::Array3i window_;
};

}  // namespace

std::vector<StructureState> structuresLeft(const VoxelVolume& scanned, const VoxelVolume& now,
                                           const JudgedTask& task) {
    std::vector<StructureState> states;
    for (const Structure& structure : task.structures) states.push_back({.name = structure.name});
    if (states.empty()) return states;
    const StructureSurvey survey(scanned, now, task);
    forEachIndex({Eigen::Vector3i::Zero(), scanned.dims().array() - 1}, [&](const Eigen::Vector3i& v) {
        const MaterialId material = task.properties ? task.properties->material(v) : kNoMaterial;
        const ZoneId zone = task.map->at(v);
        if (material == kNoMaterial && zone == kNoZone) return;
        for (size_t n = 0; n < states.size(); ++n) {
            const Structure& structure = task.structures[n];
            if (structure.zone != kNoZone ? structure.zone == zone : structure.material == material)
                survey.visit(v, structure, states[n]);
        }
    });
    return states;
}

void addStructureFigures(const std::vector<StructureState>& states, double voxel_volume, Figures& figures) {
    for (const StructureState& state : states) {
        const auto add = [&](const char* what, const char* label, double value, const char* unit) {
            figures.push_back({std::string("structure.") + what + ":" + state.name, kStructureVersion,
                               state.name + ": " + label, value, unit});
        };
        constexpr double kPerMm2 = kPerMillimetre * kPerMillimetre;
        add("lost_voxels", "lost", double(state.lost), "");
        add("lost_volume", "lost", double(state.lost) * voxel_volume * kPerCubicMillimetre, "mm3");
        const double area = state.exposed + state.skeletonised + state.covered;
        if (area == 0) continue;
        add("exposed_area", "without bone over it", state.exposed * kPerMm2, "mm2");
        add("skeletonised_area", "under a thin shell that was left", state.skeletonised * kPerMm2, "mm2");
        add("covered_area", "under bone", state.covered * kPerMm2, "mm2");
        add("exposed", "without bone over it", 100 * state.exposed / area, "percent");
        add("skeletonised", "under a thin shell that was left", 100 * state.skeletonised / area, "percent");
    }
}

}  // namespace bonemill
