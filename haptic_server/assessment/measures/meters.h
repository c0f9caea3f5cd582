// Measures of technique that sum up ticks and samples of motion, one meter for each subject. SI. One normal
// thread; memory is bounded: add() allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"
#include "haptic_server/assessment/measures/distribution.h"
#include "haptic_server/assessment/measures/figure.h"
#include "haptic_server/assessment/measures/motion.h"

namespace bonemill {

// Measures how still shaft and force are held, within seconds that are all contact: a shaft that is turned
// slowly on purpose is no unrest.
class Steadiness {
  public:
    static constexpr int kSamples = int(MotionSample::kRate);  // of a second

    void add(const MotionSample& sample) noexcept {
        if (!sample.follows || sample.contact < 1) {
            axes_W_.setZero();
            force_ = force_squared_ = 0;
            count_ = 0;
        }
        if (sample.contact < 1) return;
        axes_W_ += sample.axis_W;
        force_ += sample.force;
        force_squared_ += sample.force * sample.force;
        if (++count_ == kSamples) endSecond();
    }
    void append(Figures& figures) const {
        put(figures, "steady.axis", axis_unrest_.median() / kDegree);
        put(figures, "steady.force", force_unrest_.median());
    }

  private:
    // The angular deviation of directions is sqrt(-2 ln R), R the length of their mean.
    void endSecond() noexcept {
        const double length = std::min(1.0, axes_W_.norm() / count_);
        axis_unrest_.add(std::sqrt(-2 * std::log(length)));
        const double mean = force_ / count_;
        force_unrest_.add(std::sqrt(std::max(0.0, force_squared_ / count_ - mean * mean)));
        axes_W_.setZero();
        force_ = force_squared_ = 0;
        count_ = 0;
    }

    Eigen::Vector3d axes_W_ = Eigen::Vector3d::Zero();
    double force_ = 0, force_squared_ = 0;
    int count_ = 0;
    Distribution axis_unrest_, force_unrest_;  // rad, N
};

// Measures how the time of an attempt was spent, and how far the burr went.
class TimeMeter {
  public:
    void add(const TickStep& step) noexcept {
        session_ += step.dt;
        if (step.record.buttons & kButtonRemove) pedal_ += step.dt;
        if (step.isInContact()) contact_ += step.dt;
    }
    void addLost(double time) noexcept { lost_ += time; }
    // Returns the way since the sample before.
    double add(const MotionSample& sample) noexcept {
        const double way = sample.follows ? (sample.p_W - last_.p_W).norm() : 0;
        path_ += way;
        if (sample.contact >= 0.5) contact_path_ += way;
        last_ = sample;
        return way;
    }
    // `cutting` in s, `removed` in m³.
    void append(Figures& figures, double cutting, double removed) const {
        put(figures, "time.session", session_);
        put(figures, "time.pedal", pedal_);
        put(figures, "time.contact", contact_);
        put(figures, "time.cutting", cutting);
        put(figures, "time.idle", session_ - contact_);
        if (lost_ > 0) put(figures, "time.lost", lost_);
        put(figures, "path.length", path_ * kPerMillimetre);
        put(figures, "path.contact", contact_path_ * kPerMillimetre);
        if (removed > 0)
            put(figures, "path.per_volume", path_ * kPerMillimetre / (removed * kPerCubicMillimetre));
    }

  private:
    double session_ = 0, pedal_ = 0, contact_ = 0, lost_ = 0;  // s
    double path_ = 0, contact_path_ = 0;                       // m
    MotionSample last_;
};

// Measures what happened to each protected structure: episodes of damage (a new one after 0.5 s without),
// what was cut of it, how near the burr came and how hard it pressed.
class StructureMeter {
  public:
    static constexpr double kEpisodeGap = 0.5;  // s

    struct Structure {
        double distance = std::numeric_limits<double>::infinity();  // m, least
        double force = 0;                                           // N, largest
        size_t episodes = 0;
        double damaged = 0;      // m³
        double damage_time = 0;  // s
        double last_damage_s = -std::numeric_limits<double>::infinity();
        bool isTouched() const noexcept { return force > 0 || episodes > 0; }
    };

    explicit StructureMeter(const TechniqueScene& scene)
        : scene_(scene), structures_(scene.recorded.protection ? scene.materials.size() : 0) {}

    void add(const TickStep& step) noexcept {
        const EffectRecord& effects = step.record.effects;
        if (Structure* nearest = of(effects.protected_id))
            nearest->distance = std::min(nearest->distance, double(effects.protected_distance));
        Structure* const touched = of(effects.touched_id);
        if (touched && (effects.events & kEventProtectedTouched))
            touched->force = std::max(touched->force, double(effects.protected_force));
        const double damaged = std::max(0.0, double(effects.damaged_volume) - damaged_);
        damaged_ = effects.damaged_volume;
        Structure* const hit = of(effects.damaged_id);
        if (!hit || !(effects.events & kEventProtectedDamaged)) return;
        if (step.t() - hit->last_damage_s > kEpisodeGap) ++hit->episodes;
        hit->last_damage_s = step.t();
        hit->damaged += damaged;
        hit->damage_time += step.dt;
    }
    // In the scene's order of materials; empty where nothing is protected.
    const std::vector<Structure>& structures() const noexcept { return structures_; }
    // A structure that was never in reach was not cut: a gate may ask for that. How far it was is unknown.
    void append(Figures& figures) const {
        for (size_t id = 0; id < structures_.size(); ++id) {
            const Structure& structure = structures_[id];
            const bool was_in_reach = std::isfinite(structure.distance);
            if (!scene_.isProtected(id) && !was_in_reach && !structure.isTouched()) continue;
            const std::string& name = scene_.materials[id];
            put(figures, "damage.episodes", double(structure.episodes), name);
            put(figures, "damage.volume", structure.damaged * kPerCubicMillimetre, name);
            put(figures, "damage.time", structure.damage_time, name);
            put(figures, "structure.force", structure.force, name);
            if (was_in_reach) put(figures, "structure.distance", structure.distance * kPerMillimetre, name);
        }
    }

  private:
    Structure* of(uint32_t id) noexcept {
        return id >= 1 && id <= structures_.size() ? &structures_[id - 1] : nullptr;
    }

    TechniqueScene scene_;
    std::vector<Structure> structures_;
    double damaged_ = 0;  // m³, of all, so far
};

// Measures how long, how fast and with which burr bone is removed: voxels that fell below the iso-value.
class RemovalMeter {
  public:
    explicit RemovalMeter(const TechniqueScene& scene)
        : scene_(scene), of_(scene.tools.size()), near_of_(scene.tools.size()) {}

    void add(const TickStep& step) noexcept {
        const double removed = step.record.removed;
        removed_ += removed;
        friction_work_ += double(step.record.effects.cutting_power) * step.dt;
        addAngle(step);
        const size_t tool = step.record.tool;
        const bool is_near = step.distance() < kNear;
        if (is_near) near_removed_ += removed;
        if (tool >= of_.size()) return;
        of_[tool] += removed;
        if (is_near) near_of_[tool] += removed;
    }
    void add(const MotionSample& sample) noexcept {
        if (sample.removed > 0) cutting_ += MotionSample::kDt;
    }
    double removed() const noexcept { return removed_; }  // m³
    double cutting() const noexcept { return cutting_; }  // s
    void append(Figures& figures) const {
        const double mm3 = removed_ * kPerCubicMillimetre;
        put(figures, "removal.volume", mm3);
        put(figures, "removal.rate", mm3 / cutting_);
        if (scene_.recorded.burr) put(figures, "removal.friction_energy", friction_work_ / mm3);
        for (size_t tool = 0; tool < of_.size(); ++tool) {
            if (of_[tool] <= 0) continue;
            const std::string& name = scene_.tools[tool];
            put(figures, "burr.volume", of_[tool] * kPerCubicMillimetre, name);
            put(figures, "burr.share", 100 * of_[tool] / removed_, name);
            if (scene_.recorded.protection)
                put(figures, "burr.near_share", 100 * near_of_[tool] / near_removed_, name);
        }
        put(figures, "angle.normal", angle_.median());
        put(figures, "angle.side_share", 100 * side_removed_ / removed_with_direction_);
    }

  private:
    static constexpr double kNear = 2e-3;     // m from a structure
    static constexpr double kMinForce = 0.2;  // N: below, the force has no direction that counts
    static constexpr double kSide = 45;       // degrees from the bone's normal: beyond, the side cuts

    // The force on the hand points away from the bone, but for friction.
    void addAngle(const TickStep& step) noexcept {
        const double force = step.force();
        if (!step.isInContact() || force < kMinForce) return;
        const double cosine = std::clamp(step.f_W().dot(step.axis_W()) / force, -1.0, 1.0);
        const double angle = std::acos(cosine) / kDegree;
        angle_.add(angle, step.dt);
        removed_with_direction_ += step.record.removed;
        if (angle > kSide) side_removed_ += step.record.removed;
    }

    TechniqueScene scene_;
    double removed_ = 0, near_removed_ = 0, cutting_ = 0, friction_work_ = 0;
    std::vector<double> of_, near_of_;                      // m³, by tool
    double side_removed_ = 0, removed_with_direction_ = 0;  // m³
    Distribution angle_;                                    // degrees
};

// Measures how hot the bone got. CEM43 is the dose that tissue research counts with: minutes at 43 °C that do
// as much harm; here of the hottest bone of each instant, wherever it is, hence no less than that of any one
// place.
class HeatMeter {
  public:
    explicit HeatMeter(const TechniqueScene& scene) : is_recorded_(scene.recorded.heat) {}

    void add(const TickStep& step) noexcept {
        if (!is_recorded_) return;
        const double temperature = step.record.effects.temperature;  // °C
        peak_ = std::max(peak_, temperature);
        necrotic_ = step.record.effects.necrotic_volume;
        if (temperature > kHot) hot_ += step.dt;
        if (temperature > kDose) dose_ += step.dt / kMinute * std::exp2(temperature - kDose);
    }
    void append(Figures& figures) const {
        if (!is_recorded_) return;
        put(figures, "heat.peak", peak_);
        put(figures, "heat.above_47", hot_);
        put(figures, "heat.cem43", dose_);
        put(figures, "heat.necrotic", necrotic_ * kPerCubicMillimetre);
    }

  private:
    static constexpr double kHot = 47, kDose = 43;  // °C; above the latter each degree doubles the dose

    bool is_recorded_;
    double peak_ = -std::numeric_limits<double>::infinity();  // °C
    double hot_ = 0, dose_ = 0;                               // s, min
    double necrotic_ = 0;                                     // m³
};

// Of the distance to the nearest protected structure.
class DistanceBins {
  public:
    static constexpr size_t kCount = 4;
    static constexpr std::array<double, kCount - 1> kLimits = {1e-3, 2e-3, 4e-3};  // m
    static constexpr std::array<const char*, kCount> kNames = {"below 1 mm", "1 to 2 mm", "2 to 4 mm",
                                                               "beyond 4 mm"};
    static size_t of(double distance) noexcept {
        size_t bin = 0;
        while (bin < kLimits.size() && !(distance < kLimits[bin])) ++bin;
        return bin;
    }
};

// Measures how hard the trainee presses, and how that and the speed change near protected structures.
class ForceMeter {
  public:
    explicit ForceMeter(const TechniqueScene& scene)
        : limit_(scene.force_limit), has_structures_(scene.recorded.protection) {}

    void add(const TickStep& step) noexcept {
        if (!step.isInContact()) return;
        const double force = step.force();
        const size_t bin = DistanceBins::of(step.distance());
        in_contact_.add(force, step.dt);
        impulse_ += force * step.dt;
        force_at_[bin].add(force, step.dt);
        if (limit_ <= 0 || force <= limit_) return;
        excess_ += step.dt;
        excess_at_[bin] += step.dt;
    }
    // Samples come in the order of time.
    void add(const MotionSample& sample) noexcept {
        if (sample.follows && sample.contact >= 0.5)
            speed_at_[DistanceBins::of(sample.distance)].add(
                (sample.p_W - last_.p_W).norm() * MotionSample::kRate, MotionSample::kDt);
        last_ = sample;
    }
    void append(Figures& figures) const {
        put(figures, "force.mean", in_contact_.mean());
        put(figures, "force.median", in_contact_.median());
        put(figures, "force.p95", in_contact_.quantile(0.95));
        put(figures, "force.max", in_contact_.max());
        put(figures, "force.impulse", impulse_);
        if (limit_ > 0) put(figures, "force.excess", 100 * excess_ / in_contact_.weight());
        if (!has_structures_) return;
        for (size_t bin = 0; bin < DistanceBins::kCount; ++bin) {
            const char* const name = DistanceBins::kNames[bin];
            put(figures, "near.time", force_at_[bin].weight(), name);
            put(figures, "near.force", force_at_[bin].median(), name);
            put(figures, "near.speed", speed_at_[bin].median() * kPerMillimetre, name);
            if (limit_ > 0)
                put(figures, "force.excess", 100 * excess_at_[bin] / force_at_[bin].weight(), name);
        }
    }

  private:
    double limit_;
    bool has_structures_;
    Distribution in_contact_;
    double impulse_ = 0, excess_ = 0;
    std::array<double, DistanceBins::kCount> excess_at_{};
    std::array<Distribution, DistanceBins::kCount> force_at_, speed_at_;
    MotionSample last_;
};

}  // namespace bonemill
