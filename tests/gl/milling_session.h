// A burr mills a bone, told by the messages that a server would send: meshes of what changed and tool states,
// at 60 per second. The cut is a ball's, finer than a voxel. There is no network and no clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/base/units.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"
#include "render_client/look/render_scene/render_scene.h"
#include "tests/gl/synthetic_scene.h"

namespace bonemill::test {

// It says how the burr runs during a stroke.
struct BurrRun {
    double spin_speed = 3000;  // rad/s
    double force = 3;          // N on the hand, away from the bone
    double power = 6;          // W while it cuts
    bool is_pedal_down = true;
};

class MillingSession {
  public:
    static constexpr double kPeriod = 1.0 / 60;  // s
    static constexpr Density kIso = 32768;

    // The distance is that of the bone's surface, m, negative inside; V = W.
    static VoxelVolume makeVolume(const VolumeGeometry& geometry, const DistanceFunction& distance) {
        VoxelVolume volume(geometry, kIso);
        const Eigen::Vector3d spacing = geometry.spacing;
        volume.fill([&](int i, int j, int k) {
            return densityOf(distance(spacing.cwiseProduct(Eigen::Vector3d(i, j, k))), spacing.x());
        });
        return volume;
    }
    MillingSession(const VoxelVolume& bone, double burr_radius) : volume_(bone), burr_radius_(burr_radius) {
        lattice_.emplace(volume_, Eigen::Vector3i::Constant(16));
        mesher_.emplace(volume_, *lattice_);
    }

    void show(RenderScene& scene) {
        for (LeafId leaf = 0; leaf < lattice_->leafCount(); ++leaf) sendLeaf(scene, leaf, false);
    }
    // The burr moves along a line at constant speed and removes what is in its way.
    void stroke(RenderScene& scene, const Pose& from, const Pose& to, double seconds, const BurrRun& run) {
        const int states = std::max(1, int(std::lround(seconds / kPeriod)));
        for (int n = 1; n <= states; ++n) {
            Pose X_WT = to;
            X_WT.position = from.position + (to.position - from.position) * (double(n) / states);
            const double removed = run.is_pedal_down ? cut(scene, X_WT.position) : 0;
            sendTool(scene, X_WT, run, removed);
            after_state ? after_state() : scene.advance(kPeriod);
        }
    }
    void wait(RenderScene& scene, const Pose& X_WT, double seconds, const BurrRun& run) {
        stroke(scene, X_WT, X_WT, seconds, run);
    }

    std::function<void()> after_state;  // instead of advancing the scene by kPeriod

  private:
    static Density densityOf(double distance, double spacing) {
        return Density(std::lround(kIso - std::clamp(distance / spacing / 2, -1.0, 0.99) * 32767));
    }
    void sendLeaf(RenderScene& scene, LeafId leaf, bool is_change) {
        NodeMesh mesh = mesher_->mesh(leaf).value();
        mesh.leaf = leaf;
        if (!mesh.isEmpty() || is_change) scene.setNode(std::move(mesh));
    }
    double cut(RenderScene& scene, const Eigen::Vector3d& centre) {
        const Eigen::Vector3d spacing = volume_.spacing();
        const double reach = burr_radius_ + 2 * spacing.x();
        const Eigen::Array3d low = ((centre.array() - reach) / spacing.array()).ceil(),
                             high = ((centre.array() + reach) / spacing.array()).floor();
        const IndexBox box = IndexBox{low.cast<int>(), high.cast<int>()}.clamped(Eigen::Vector3i::Zero(),
                                                                                 volume_.dims().array() - 1);
        IndexBox changed;
        int gone = 0;
        if (!box.isEmpty())
            forEachIndex(box, [&](const Eigen::Vector3i& v) {
                const double inside = burr_radius_ - (spacing.cwiseProduct(v.cast<double>()) - centre).norm();
                const Density old = volume_.at(v.x(), v.y(), v.z()), left = densityOf(inside, spacing.x());
                if (left >= old) return;
                gone += old >= kIso && left < kIso;
                volume_.set(v.x(), v.y(), v.z(), left);
                changed.include(v);
            });
        if (changed.isEmpty()) return 0;
        forEachIndex(lattice_->leavesOfWrite(changed),
                     [&](const Eigen::Vector3i& leaf) { sendLeaf(scene, lattice_->leafId(leaf), true); });
        return gone * volume_.voxelVolume();
    }
    void sendTool(RenderScene& scene, const Pose& X_WT, const BurrRun& run, double removed) {
        topics::ToolState tool = makeToolState(X_WT, X_WT, run.is_pedal_down ? 1 : 0);
        tool.set_epoch(1);
        tool.set_tick(++tick_);
        const bool is_cutting = removed > 0;
        setVector(X_WT.rotation * Eigen::Vector3d(0, is_cutting ? run.force : 0, 0), tool.mutable_force_n());
        tool.mutable_effects()->set_spin_speed(run.spin_speed);
        tool.mutable_effects()->set_burr_force_n(is_cutting ? run.force : 0);
        tool.mutable_effects()->set_cutting_power_w(is_cutting ? run.power : 0);
        tool.mutable_effects()->set_removed_mm3(removed * kPerCubicMillimetre);
        scene.setToolState(tool);
    }

    VoxelVolume volume_;
    std::optional<LeafLattice> lattice_;
    std::optional<LeafMesher> mesher_;
    double burr_radius_;
    uint64_t tick_ = 0;
};

// The shaft goes along this direction from the burr (W).
inline Pose toolAt(const Eigen::Vector3d& position, const Eigen::Vector3d& shaft) {
    return {position, rotationBetween(Eigen::Vector3d::UnitY(), shaft)};
}

}  // namespace bonemill::test
