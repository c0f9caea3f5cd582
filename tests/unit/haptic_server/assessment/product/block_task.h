// A block of bone with a margin of air, milled by formula, and a task on it.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>

#include "haptic_server/assessment/product/product.h"

namespace bonemill::test {

class BlockTask {
  public:
    // `size` voxels of bone, with `margin` of air around them.
    explicit BlockTask(const Eigen::Vector3i& size, double voxel = 0.25e-3, int margin = 4)
        : size_(size),
          margin_(margin),
          geometry_{size.array() + 2 * margin, Eigen::Vector3d::Constant(voxel), {}},
          scanned_(geometry_, kIso),
          now_(geometry_, kIso),
          ids_(geometry_.voxelCount(), kNoZone) {
        const auto density = [&](int i, int j, int k) {
            return isBlock({i, j, k}) ? kMaxDensity : Density(0);
        };
        scanned_.fill(density);
        now_.fill(density);
    }

    // The block lies from 0 to this, m in B, whose axes are V's.
    Eigen::Vector3d extent() const { return size_.cast<double>() * geometry_.spacing.x(); }
    Eigen::Vector3d inB(const Eigen::Vector3i& voxel) const {
        return (voxel.cast<double>().array() - margin_ + 0.5).matrix() * geometry_.spacing.x();
    }
    Eigen::Vector3d inV(const Eigen::Vector3d& p_B) const {
        return p_B + Eigen::Vector3d::Constant((margin_ - 0.5) * geometry_.spacing.x());
    }
    bool isBlock(const Eigen::Vector3i& v) const {
        return (v.array() >= margin_).all() && (v.array() < margin_ + size_.array()).all();
    }

    // in(p_B) says where.
    template <class In>
    void addZone(const std::string& name, ZoneRole role, In&& in) {
        task.zones.push_back({name, role});
        forEachIndex(box(), [&](const Eigen::Vector3i& v) {
            if (in(inB(v))) ids_[indexOf(v)] = ZoneId(task.zones.size());
        });
    }
    template <class In>
    void mill(In&& in) {
        forEachIndex(box(), [&](const Eigen::Vector3i& v) {
            if (in(inB(v))) now_.set(v.x(), v.y(), v.z(), 0);
        });
    }
    // As a burr leaves it, with a ramp of densities: distance(p_B) is in m, negative inside of what goes.
    template <class Distance>
    void carve(Distance&& distance) {
        forEachIndex(box(), [&](const Eigen::Vector3i& v) {
            const double share = std::clamp(0.5 + distance(inB(v)) / geometry_.spacing.x(), 0.0, 1.0);
            const Density left = Density(share * kMaxDensity);
            if (left < now_.at(v.x(), v.y(), v.z())) now_.set(v.x(), v.y(), v.z(), left);
        });
    }
    void finishZones() { task.map = std::make_shared<const VoxelIds>(geometry_.dims, ids_); }
    Figures figures(std::optional<double> breach = {}) const {
        return measureProduct({scanned_, now_, task, breach}).figures;
    }

    IndexBox box() const { return {Eigen::Vector3i::Zero(), geometry_.dims.array() - 1}; }
    const VoxelVolume& scanned() const { return scanned_; }
    VoxelVolume& scanned() { return scanned_; }
    VoxelVolume& now() { return now_; }

    JudgedTask task;

  private:
    static constexpr Density kIso = 32768;

    size_t indexOf(const Eigen::Vector3i& v) const {
        return size_t(v.x()) +
               size_t(geometry_.dims.x()) * (size_t(v.y()) + size_t(geometry_.dims.y()) * size_t(v.z()));
    }

    Eigen::Vector3i size_;
    int margin_;
    VolumeGeometry geometry_;
    VoxelVolume scanned_, now_;
    std::vector<ZoneId> ids_;
};

inline double valueOf(const Figures& figures, const std::string& id) {
    const Figure* figure = findFigure(figures, id);
    return figure ? figure->value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace bonemill::test
