// Finds the springs nearest to the wished ones with which the device comes to rest although no hand holds it:
// the wished ones if they do; else as stiff ones with a larger relaxing share, which is felt only as a
// quicker rise of the force; else softer ones. docs/explanation/stability.md says what rests on it.
//
// It goes on a little in every tick, so that a device that is plugged in costs no period. Everything is
// RT-safe.
#pragma once

namespace bonemill {

// One degree of freedom of the device that the hand holds. Translation and rotation are the same with other
// units: kg, N·s/m, N/m or kg·m², N·m·s/rad, N·m/rad.
struct HandleAxis {
    double inertia = 0;      // of what moves with the handle
    double damping = 0;      // viscous
    double amplifier_s = 0;  // time constant of the amplifiers
    double delay_s = 0;      // from the reading of the encoders until the force that answers it begins
};

struct LoopSprings {
    double stiffness = 0;        // k
    double relaxing_share = 0;   // k_2 / k
    double relaxing_time = 0;    // τ_2, s
    double damping_time = 1e-3;  // τ, s: of the tool
};

// Returns by which factor per tick of dt the slowest motion of the sampled loop shrinks (below 1) or grows,
// when the hand holds nothing but the device: device, amplifier, delay, hold, relaxing spring and lagging
// tool as one linear difference equation per degree of freedom. `wall` times k is behind the tool; infinity
// stands for a wall that never gives way, 0 for free air. Beyond the linear equation, a spring that saturates
// and a wall that ends only take stiffness away.
double growthPerTick(const HandleAxis& axis, const LoopSprings& springs, double wall, double dt) noexcept;

class LoopFit {
  public:
    // A lightly damped swing shrinks at least by this damping ratio. Every eigenvalue of the sampled loop is
    // judged, not the bound of a spring alone.
    static constexpr double kDampingRatio = 0.03;
    // The delay may be longer by this share of a period than the device says.
    static constexpr double kDelaySlack = 0.25;
    static constexpr double kLargestShare = 6;

    LoopFit() = default;
    // k (1 + share) stays within `most_quick`. Without an inertia the wish is all that is known.
    LoopFit(const HandleAxis& axis, const LoopSprings& wish, double most_quick, double dt) noexcept;

    bool isDone() const noexcept { return is_done_; }
    // Goes on with a few eigenvalues.
    void advance() noexcept;
    void finish() noexcept {
        while (!is_done_) advance();
    }
    // Call it when it is done. They are a thousandth of the wish where nothing stiffer is stable.
    const LoopSprings& springs() const noexcept { return best_; }

    // Tells whether the device comes to rest with these springs against walls of any stiffness.
    static bool comesToRest(const HandleAxis& axis, const LoopSprings& springs, double dt) noexcept;

  private:
    // Returns how many eigenvalues it took.
    int tryNext() noexcept;
    bool isStable(const LoopSprings& springs, int& loops) const noexcept;
    LoopSprings shape() const noexcept;  // the candidate's share and time, as stiff as can be wished
    void nextShape() noexcept;
    int soften() noexcept;

    HandleAxis axis_;
    LoopSprings wish_, best_;
    double most_quick_ = 0;
    double dt_ = 1e-3;
    int candidate_ = 0;
    bool is_softening_ = false;     // no candidate is stable at the wished stiffness
    double tried_ = 0, found_ = 0;  // of the candidate the next stiffness, and of the best one
    bool is_done_ = true;
};

}  // namespace bonemill
