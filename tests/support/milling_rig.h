// Puts a block of bone under a burr that a hand presses with a constant force, or leads along a path.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "haptic_server/core/tick/fixed_tick.h"
#include "haptic_server/core/tick/tick_budget.h"
#include "haptic_server/surface/mesh/mesh_check.h"
#include "tests/support/test_bodies.h"
#include "tests/support/typical_effects.h"
#include "tests/support/voxel_fields.h"

namespace bonemill::test {

inline constexpr double kKrpm = 1000 * 2 * M_PI / 60;  // rad/s

struct RigConfig {
    Eigen::Vector3d size{4e-3, 4e-3, 3e-3};  // of the volume
    double surface = 2e-3;                   // of the bone: the plane z = this
    // The bone is a wall of these thicknesses along x and y around the middle; zero makes a block as large as
    // the volume.
    Eigen::Vector2d wall = Eigen::Vector2d::Zero();
    Eigen::Vector3d spacing = Eigen::Vector3d::Constant(0.125e-3);
    double ramp = 2;  // voxels from the surface to full density
    double is_hard_below =
        0;  // m under the surface: from there on four times the specific energy; 0: nowhere
    Density iso = kTestIso;
    double rate = 1000;  // Hz
    int periods = 1;     // that each tick lives through: in those before it none ran
    // Either of these is listed instead of energy_removal.
    std::optional<TimeRemovalConfig> time_removal;
    std::optional<AddMaterialConfig> add_material;
    double shaft_radius = 0;  // m, along the tool's axis, behind a cylinder with flat ends; 0: none
    double shaft_end = 8e-3;  // m from the tool's origin
    Burr burr{.radius = 1e-3, .speed = 40 * kKrpm};
    double edge_radius = 0;                                        // m, of a cylindrical burr
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  // of the tool
    EnergyRemovalConfig removal = kSharpRemoval;
    Preset preset = Preset::kBalanced;
    int shell_factor = 1;
    size_t most_milled_cells = TickConfig{}.most_milled_cells;
    double hand_stiffness = 3000;  // N/m: of the coupling
    // As much time as at 1 kHz on a plain PC (TickBudget); else plenty.
    bool has_budget = false;
    std::optional<SurfaceFrictionConfig> friction = {};
};

inline std::vector<ToolShape> shapesOf(const Burr& burr, double edge_radius = 0) {
    const Eigen::Vector3d half = burr.length / 2 * Eigen::Vector3d::UnitY();
    if (burr.kind == BurrKind::kCylinder) return {CylinderShape{-half, half, burr.radius, edge_radius}};
    if (burr.kind == BurrKind::kCone) return {ConeShape{-half, half, burr.tip_radius, burr.radius}};
    return {SphereShape{Eigen::Vector3d::Zero(), burr.radius}};
}

inline std::vector<ToolShape> shapesOf(const RigConfig& config) {
    std::vector<ToolShape> shapes = shapesOf(config.burr, config.edge_radius);
    const Eigen::Vector3d end = config.shaft_end * Eigen::Vector3d::UnitY();
    if (config.shaft_radius > 0 && config.burr.kind == BurrKind::kCylinder)
        shapes.push_back(
            CylinderShape{config.burr.length / 2 * Eigen::Vector3d::UnitY(), end, config.shaft_radius});
    else if (config.shaft_radius > 0)
        shapes.push_back(CapsuleShape{Eigen::Vector3d::Zero(), end, config.shaft_radius});
    return shapes;
}

inline SdfGrid gridOf(const std::vector<ToolShape>& shapes, double spacing) {
    const ShapeField field(shapes);
    const Eigen::Vector3d origin = field.box().min().array() - 3 * spacing;
    const Eigen::Vector3i nodes = ((field.box().sizes() / spacing).array().ceil() + 7).cast<int>();
    std::vector<float> values;
    forEachIndex({Eigen::Vector3i::Zero(), nodes.array() - 1}, [&](const Eigen::Vector3i& n) {
        values.push_back(float(field.distanceBound(origin + spacing * n.cast<double>())));
    });
    return {nodes, spacing, origin, std::move(values)};
}

class MillingRig final : private TickIo {
  public:
    // It says where the hand wants the tool at time t, given where the simulated one is.
    using Hand = std::function<Eigen::Vector3d(double t, const Eigen::Vector3d& p_spo)>;

    explicit MillingRig(const RigConfig& config)
        : config(config),
          bone(blockOf(config), Eigen::Vector3i::Constant(16), {.levels = {{config.shell_factor}}}),
          tool_(gridOf(shapesOf(config), config.burr.radius / 8), shapesOf(config), config.burr.radius),
          tick_(tickConfigOf(config, bone.volume, tool_), bone),
          volume_before_(boneVolume()) {}

    // It runs from `start` on.
    void run(double seconds, const Eigen::Vector3d& start, Hand hand, uint32_t buttons = kButtonRemove) {
        if (records.empty()) spo_ = start;
        hand_ = std::move(hand);
        buttons_ = buttons;
        left_ = int(std::lround(seconds * config.rate / config.periods));
        records.reserve(records.size() + size_t(left_));
        tick_.run(*this, [this](const TickRecord& record) {
            spo_ = Eigen::Map<const Eigen::Vector3d>(record.p_WT);
            records.push_back(record);
        });
    }
    // The hand presses along `direction` (unit) with this force, which comes up within kRise, ahead of the
    // tool by what it moved in the last tick; across it the hand stays where it starts.
    void press(double seconds, const Eigen::Vector3d& start, const Eigen::Vector3d& direction, double force,
               uint32_t buttons = kButtonRemove) {
        const double way = force / config.hand_stiffness, begin = t_;
        const double from = records.empty() ? 0 : (spo_ - start).dot(direction);
        run(
            seconds, start,
            [=, last = from](double t, const Eigen::Vector3d& p) mutable -> Eigen::Vector3d {
                const double now = (p - start).dot(direction), moved = now - std::exchange(last, now);
                return start + direction * (now + moved + way * std::min(1.0, (t - begin) / kRise));
            },
            buttons);
    }
    static constexpr double kRise = 0.02;  // s
    // The hand moves at a steady speed.
    void feed(double seconds, const Eigen::Vector3d& start, const Eigen::Vector3d& velocity,
              uint32_t buttons = kButtonRemove) {
        const double from = t_;
        run(
            seconds, start, [=](double t, const Eigen::Vector3d&) { return start + velocity * (t - from); },
            buttons);
    }

    double boneVolume() const {
        const auto meshes = meshAll(bone.volume, bone.lattice);
        return meshVolume(meshes, MeshGrid(bone.volume, bone.lattice));
    }
    double removedVolume() const { return volume_before_ - boneVolume(); }
    // work() is ∫ P dt and removedEnergy() is Σ u ΔV as the ticks say, J.
    double work() const {
        double sum = 0;
        for (const TickRecord& r : records)
            sum += double(r.effects.removal_power) * config.periods / config.rate;
        return sum;
    }
    double removedEnergy() const {
        double sum = 0;
        for (const TickRecord& r : records) sum += double(r.effects.removed_energy);
        return sum;
    }
    Eigen::Vector3d position() const { return spo_; }
    // Returns how far the simulated tool was from the hand at most, from this tick on, m.
    double largestLag(size_t from = 0) const {
        double largest = 0;
        for (size_t n = from; n < records.size(); ++n) {
            const Eigen::Map<const Eigen::Vector3d> tool(records[n].p_WT), hand(records[n].p_WT_device);
            largest = std::max(largest, (tool - hand).norm());
        }
        return largest;
    }
    Eigen::Vector3d center() const { return {config.size.x() / 2, config.size.y() / 2, config.surface}; }
    // Returns the mean of a figure over the last N seconds.
    template <class Figure>
    double mean(double seconds, Figure&& figure) const {
        const size_t count = size_t(std::lround(seconds * config.rate));
        double sum = 0;
        for (size_t n = records.size() - count; n < records.size(); ++n) sum += double(figure(records[n]));
        return sum / double(count);
    }

    RigConfig config;
    BoneModel bone;
    std::vector<TickRecord> records;

  private:
    static VoxelVolume blockOf(const RigConfig& config) {
        VolumeGeometry geometry;
        geometry.dims = (config.size.array() / config.spacing.array()).ceil().cast<int>() + 1;
        geometry.spacing = config.spacing;
        VoxelVolume volume(geometry, config.iso);
        const double voxel = config.spacing.maxCoeff();
        volume.fill([&](int i, int j, int k) {
            const Eigen::Vector3d p = config.spacing.cwiseProduct(Eigen::Vector3d(i, j, k));
            double inside = config.surface - p.z();
            for (int axis = 0; axis < 2; ++axis)
                if (config.wall[axis] > 0)
                    inside =
                        std::min(inside, config.wall[axis] / 2 - std::abs(p[axis] - config.size[axis] / 2));
            const double depth = inside / (config.ramp * voxel);
            const double density = config.iso + depth * (depth < 0 ? config.iso : kMaxDensity - config.iso);
            return Density(std::lround(std::clamp(density, 0.0, double(kMaxDensity))));
        });
        return volume;
    }
    static FixedTickConfig tickConfigOf(const RigConfig& config, const VoxelVolume& volume,
                                        const ToolModel& tool) {
        FixedTickConfig tick;
        tick.dt = 1 / config.rate;
        tick.tool = {&tool, config.burr};
        tick.accuracy = presetSettings(config.preset);
        tick.accuracy.shell_factor = config.shell_factor;
        tick.gradient.coupling.translation_stiffness = config.hand_stiffness;
        tick.gradient.coupling.relaxing_share = 0;
        tick.most_milled_cells = config.most_milled_cells;
        if (config.has_budget) TickBudget::apply(tick.dt, tick.gradient, tick.most_milled_cells);
        tick.effects.surface_friction = config.friction;
        tick.effects.time_removal = config.time_removal;
        tick.effects.add_material = config.add_material;
        if (!config.time_removal && !config.add_material) tick.effects.energy_removal = config.removal;
        if (config.is_hard_below > 0) {
            const double hard_below = (config.surface - config.is_hard_below) / config.spacing.z();
            tick.effects.properties = std::make_shared<const BoneProperties>(
                volume, [&](const Eigen::Vector3i& v) { return MaterialId(v.z() < hard_below); });
            tick.effects.materials = {{}, {.specific_energy = 4 * config.removal.specific_energy}};
        }
        return tick;
    }
    bool read(DeviceInput& input) noexcept override {
        if (left_-- <= 0) return false;
        input = {};
        // The simulated tool begins where the hand is.
        input.X_WT_device = {records.empty() ? spo_ : hand_(t_, spo_), config.rotation};
        input.buttons = buttons_;
        input.t_s = t_;
        input.periods = config.periods;
        t_ += config.periods / config.rate;
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return 0; }
    int64_t now() noexcept override { return 0; }

    ToolModel tool_;
    FixedTick tick_;
    double volume_before_;
    Hand hand_;
    uint32_t buttons_ = 0;
    int left_ = 0;
    double t_ = 0;
    Eigen::Vector3d spo_ = Eigen::Vector3d::Zero();
};

}  // namespace bonemill::test
