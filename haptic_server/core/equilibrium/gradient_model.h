// By the default law the tool's pose minimises contact energy + coupling energy + damping against
// the last pose, by a few Gauss-Newton steps with Cholesky factors, Levenberg damping, a trust
// radius and a line search. The energy never rises inside a tick, so that no contact can make the
// tool diverge (docs/explanation/stability.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/pose.h"
#include "haptic_server/core/contact/contact_configs.h"
#include "haptic_server/core/contact/gradient_contact.h"
#include "haptic_server/core/equilibrium/spo_model.h"
#include "haptic_server/core/tool/growing_field.h"

namespace bonemill {

// Learns from the steps of a solve what Gauss-Newton leaves out of the second derivative.
//
// The sum over the points of J'J is too stiff along a surface: where the normals of the tool differ from
// point to point, as they do at its edges, each resists to a part of a sliding motion that the tool's
// curvature takes back. The difference, a symmetric S, is not computed but learnt: after a step s the
// gradient has changed by y, and (J'J + S) s = y shall hold. The update is the one of Dennis, Gay and Welsch
// (1981, "An adaptive nonlinear least-squares algorithm", eq. 2.5 ff.) with their sizing, which lets S
// shrink when the contact does. It lasts over ticks, in which a contact hardly changes.
//
// All is in one coordinate system whose six units are the same. It is RT-safe, and for one thread.
class CurvatureSecant {
  public:
    // What has been learnt, to be added to J'J.
    const Matrix6d& matrix() const noexcept { return S_; }
    void forget() noexcept { S_.setZero(); }
    bool isEmpty() const noexcept { return S_.isZero(0); }
    // The `step` changed the energy's gradient by `change`; `gauss_newton` is J'J behind it.
    void learn(const Vector6d& step, const Vector6d& change, const Matrix6d& gauss_newton) noexcept {
        const double along = step.dot(change), length = step.norm() * change.norm();
        if (!(along > kMinCosine * length)) return;
        const Vector6d wanted = change - gauss_newton * step;
        const double so_far = std::abs(step.dot(S_ * step));
        if (so_far > 0) S_ *= std::min(1.0, std::abs(step.dot(wanted)) / so_far);
        const Vector6d miss = wanted - S_ * step;
        const Matrix6d outer = miss * change.transpose();
        S_ += (outer + outer.transpose()) / along -
              (miss.dot(step) / (along * along)) * change * change.transpose();
        if (!S_.allFinite()) forget();
    }

  private:
    // A gradient that has turned away from the step says nothing of a minimum.
    static constexpr double kMinCosine = 1e-3;
    Matrix6d S_ = Matrix6d::Zero();
};

class GradientModel final : public SpoModel {
  public:
    // Allocates the room for contact points.
    GradientModel(const GradientConfig& config, const SpoWorld& world, const SpoTool& tool, double dt);

    SpoTraits traits() const noexcept override { return {.has_energy = true, .wants_estimate = true}; }
    SpoStep advance(const Pose& X_VT, const Pose& X_VT_device) noexcept override;
    void restart() noexcept override;
    void expectOtherBone() noexcept override { knows_depth_ = false; }
    void setAccuracy(const AccuracySettings& settings) noexcept override;
    void setTool(const SpoTool& tool) noexcept override;
    void setCoupling(const SpoCoupling& coupling) noexcept override;
    void setContact(const GradientContactConfig& contact) noexcept override;
    void setAffordableSamples(size_t most) noexcept override { affordable_samples_ = most; }
    void setEffects(ContactWeights* weights, SolveEnergy* energy) noexcept override;
    size_t listContacts(std::span<SurfaceContact> out) noexcept override;
    size_t mostCandidates() const noexcept override { return contact_.room(); }

    // Returns all energy (J) of the last advance() at its final pose, damping included, for
    // tests and reports.
    double energy() const noexcept { return energy_; }

  private:
    // All of this is computed at one pose.
    struct State {
        Pose X_VT;
        EnergyTerm total;
        double stored = 0;    // of that, J: what neither the damping nor the effects hold
        Wrench effects = {};  // of that: the effects'
        uint32_t contacts = 0;
        double max_depth = 0;
        double contact_force = 0;  // N
        bool isFinite() const noexcept;
    };
    // It stays the same during a tick.
    struct Tick {
        Pose X_VT_start, X_VT_device;
        SpoStep* out;
    };
    bool isToolGrowing() const noexcept { return growing_.offset() > 0; }
    void useTool() noexcept;
    void saturate() noexcept;
    void fitTool(const Tick& tick) noexcept;
    void growTool() noexcept;
    State begin(const Tick& tick) noexcept;
    bool hasBoneAppeared(const State& state) const noexcept;
    void makeRoom(double depth) noexcept;
    void gather(const Pose& X_VT, double margin, SpoStep& out) noexcept;
    State evaluate(const Pose& X_VT, const Tick& tick) noexcept;
    void goOn(State& state, const Tick& tick) noexcept;
    bool descend(State& state, const Tick& tick) noexcept;
    bool tryOtherwise(const State& state, const Tick& tick, bool is_last) noexcept;
    void noteCutShort(const State& state, const Tick& tick) noexcept;
    static bool isFelt(const State& state) noexcept;
    void feel(const Pose& X_VT, const Tick& tick) noexcept;
    // N; rotation in units of the solve.
    static double outOfBalance(const State& state) noexcept;
    static Matrix6d scaledStiffness(const State& state) noexcept;
    void learnFrom(const State& before, const State& after) noexcept;
    Vector6d newtonStep(const State& state) const noexcept;
    Vector6d withinSpeed(const State& state, const Vector6d& newton, const Tick& tick) const noexcept;
    Vector6d limited(const State& state, const Vector6d& newton, const Tick& tick) noexcept;
    Vector6d swept(const State& state, const Vector6d& step, const Tick& tick) noexcept;
    bool isLostInNoise(const State& state, const Vector6d& step) const noexcept;
    bool moveDown(State& state, const Vector6d& step, const Tick& tick) noexcept;
    static void dropTraces(SpoStep& step) noexcept;
    double reachOf(const Vector6d& step) const noexcept;
    double trustRadius() const noexcept;
    size_t pointTestsLeft() const noexcept {
        return point_tests_ < most_point_tests_ ? most_point_tests_ - point_tests_ : 0;
    }
    // A gathering is followed by looks at what it found.
    bool canGatherAgain() const noexcept { return pointTestsLeft() > 2 * gathering_tests_; }
    bool canLookAgain() const noexcept { return pointTestsLeft() > contact_.candidateCount(); }

    GradientConfig config_;
    SpoWorld world_;
    SpoTool tool_;
    EnergyCouplingConfig wished_;
    EnergyCoupling coupling_;  // of tool_
    double most_pull_ = std::numeric_limits<double>::infinity();
    std::optional<double> saturation_force_;  // N, in place of tool_'s
    double dt_;
    AccuracySettings settings_;
    int level_ = 0;
    const ToolField* field_;  // of tool_, or growing_
    GrowingField growing_;
    bool is_new_tool_ = false;
    double last_depth_ = 0;     // m
    bool knows_depth_ = false;  // last_depth_ is that of the tick before
    GradientContact contact_;
    SolveEnergy* effects_ = nullptr;
    Pose X_VT_end_;  // of the last advance()
    Pose X_VT_gathered_;
    size_t affordable_samples_ = SIZE_MAX;
    size_t most_point_tests_ = 0;                        // with this field
    size_t point_tests_ = 0;                             // in this tick
    size_t gathering_tests_ = 0;                         // of the last gathering
    bool is_cut_short_ = false, was_cut_short_ = false;  // this tick, and the last one
    ContinuousRotation way_;
    RelaxingSpring relaxing_;
    CurvatureSecant curvature_;
    double lambda_ = 0;                        // Levenberg, share of the damping matrix
    Vector6d last_motion_ = Vector6d::Zero();  // of the last tick
    double last_reach_ = 0;                    // m, of that
    double energy_ = 0;
};

}  // namespace bonemill
