#include "haptic_server/assessment/product/breach.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kBreachVersion = 1;
constexpr double kAround = 15e-3;     // m beside the line
constexpr double kMoved = 0.25e-3;    // m
constexpr double kShaftSeen = 40e-3;  // m of the shaft behind the burr
constexpr double kShaftStep = 1e-3;   // m

IndexBox boxOf(const VoxelVolume& scanned, const PlannedLine& line) {
    const Eigen::Array3d low = line.entry_V.cwiseMin(line.tip_V).array() - kAround;
    const Eigen::Array3d high = line.entry_V.cwiseMax(line.tip_V).array() + kAround;
    // Around the scan there is air; a line may lie anywhere.
    const Eigen::Array3d h = scanned.spacing().array(), rim = (kAround / h).ceil();
    const Eigen::Array3d end = scanned.dims().cast<double>().array() - 1 + rim;
    return {(low / h).max(-rim).min(end).floor().cast<int>(),
            (high / h).max(-rim).min(end).ceil().cast<int>()};
}

// Marks what is not bone and leads out of the box.
class OutsideFlood {
  public:
    OutsideFlood(const VoxelVolume& scanned, const IndexBox& box)
        : scanned_(scanned), box_(box), size_(box.max - box.min + Eigen::Vector3i::Ones()) {
        is_outside_.resize(size_t(box.count()));
        forEachIndex(box, [&](const Eigen::Vector3i& v) {
            const bool is_rim = (v.array() == box.min.array()).any() || (v.array() == box.max.array()).any();
            if (is_rim) enter(v);
        });
        while (!open_.empty()) {
            const Eigen::Vector3i v = open_.back();
            open_.pop_back();
            for (int axis = 0; axis < 3; ++axis)
                for (const int side : {-1, 1}) {
                    const Eigen::Vector3i next = v + side * Eigen::Vector3i::Unit(axis);
                    if ((next.array() >= box_.min.array()).all() && (next.array() <= box_.max.array()).all())
                        enter(next);
                }
        }
    }
    bool isOutside(const Eigen::Vector3i& v) const { return is_outside_[indexOf(v)]; }

  private:
    size_t indexOf(const Eigen::Vector3i& v) const {
        const Eigen::Vector3i n = v - box_.min;
        return size_t(n.x()) + size_t(size_.x()) * (size_t(n.y()) + size_t(size_.y()) * size_t(n.z()));
    }
    bool isBone(const Eigen::Vector3i& v) const {
        return (v.array() >= 0).all() && (v.array() < scanned_.dims().array()).all() &&
               scanned_.at(v.x(), v.y(), v.z()) >= scanned_.iso();
    }
    void enter(const Eigen::Vector3i& v) {
        if (isBone(v) || is_outside_[indexOf(v)]) return;
        is_outside_[indexOf(v)] = true;
        open_.push_back(v);
    }

    const VoxelVolume& scanned_;
    IndexBox box_;
    Eigen::Vector3i size_;
    std::vector<bool> is_outside_;
    std::vector<Eigen::Vector3i> open_;
};

SignedField fieldOf(const VoxelVolume& scanned, const PlannedLine& line) {
    const IndexBox box = boxOf(scanned, line);
    const OutsideFlood flood(scanned, box);
    return {box, scanned.spacing(), [&](const Eigen::Vector3i& v) { return !flood.isOutside(v); }};
}

}  // namespace

SolidBone::SolidBone(const VoxelVolume& scanned, const PlannedLine& line)
    : spacing_(scanned.spacing()), field_(fieldOf(scanned, line)) {}

bool SolidBone::isNear(const Eigen::Vector3d& p_V) const noexcept {
    const Eigen::Array3d place = p_V.array() / spacing_.array();
    return (place >= field_.box().min.cast<double>().array()).all() &&
           (place <= field_.box().max.cast<double>().array()).all();
}

BreachMeter::BreachMeter(std::shared_ptr<const SolidBone> bone, const PlannedLine& line)
    : bone_(std::move(bone)), line_(line), along_V_((line.tip_V - line.entry_V).normalized()) {}

void BreachMeter::add(const Pose& X_VT, const BurrProbes& burr) noexcept {
    if (last_V_ && (X_VT.position - *last_V_).squaredNorm() < kMoved * kMoved) return;
    last_V_ = X_VT.position;
    if (!bone_->isNear(X_VT.position)) return;
    double deepest = 0;
    for (const BurrProbe& probe : burr) {
        const Eigen::Vector3d p_V = X_VT * probe.center_T;
        if ((p_V - line_.entry_V).dot(along_V_) < line_.free) continue;
        deepest = std::max(deepest, probe.radius - bone_->depthAt(p_V));
    }
    if (!(deepest > depth_) || !std::isfinite(deepest) || !isShaftInBone(X_VT)) return;
    depth_ = deepest;
}

// A tool beside the bone has not come through it.
bool BreachMeter::isShaftInBone(const Pose& X_VT) const noexcept {
    for (double y = kShaftStep; y < kShaftSeen; y += kShaftStep) {
        const Eigen::Vector3d p_V = X_VT * Eigen::Vector3d(0, y, 0);
        if (!bone_->isNear(p_V)) return false;
        if (bone_->depthAt(p_V) > 0) return true;
    }
    return false;
}

int breachGrade(double depth) noexcept {
    constexpr double kGradeStep = 2e-3;  // m
    if (!(depth > 0)) return 0;
    return std::min(4, 1 + int(depth / kGradeStep));
}

void addBreachFigures(double depth, Figures& figures) {
    figures.push_back({"breach.depth", kBreachVersion, "Out of the bone beside the planned line",
                       depth * kPerMillimetre, "mm"});
    figures.push_back({"breach.grade", kBreachVersion,
                       std::string("Breach of grade ") + char('A' + breachGrade(depth)) +
                           " (Gertzbein-Robbins; 0 is A, 4 is E)",
                       double(breachGrade(depth)), ""});
}

}  // namespace bonemill
