// Gauss' principle of least constraint: of all motions that the contacts allow, the one nearest to the free
// motion. That is a quadratic programme in six unknowns, solved exactly by a dual active-set method (Goldfarb
// and Idnani 1983): from the free motion on, the most violated contact joins until none is violated.
//
//   min ½ (Δ - Δ_free)ᵀ K (Δ - Δ_free)   subject to   J_i Δ >= b_i
//
// It is RT-safe but for construction: at most kMaxPivots passes over the rows. For one thread at a time.
#pragma once

#include <vector>

#include "common/geometry/pose.h"

namespace bonemill {

class LeastConstraint {
  public:
    static constexpr int kMaxPivots = 40;
    static constexpr double kSlack = 1e-9;  // m: less is not violated

    explicit LeastConstraint(size_t most_rows) : rows_(most_rows), bounds_(most_rows) {}

    void clear() noexcept { count_ = 0; }
    // Adds J Δ >= b, in m; false if there is no room for it.
    bool add(const Vector6d& J, double bound) noexcept {
        if (count_ == rows_.size()) return false;
        rows_[count_] = J;
        bounds_[count_++] = bound;
        return true;
    }
    size_t count() const noexcept { return count_; }

    struct Result {
        Vector6d motion;
        Vector6d reaction = Vector6d::Zero();  // Σ λ_i J_iᵀ: what holds the motion back, λ_i >= 0
        int active = 0;
        bool is_feasible = true;  // false: contacts contradict each other; the motion obeys some of them
    };
    // K is symmetric and positive definite.
    Result solve(const Vector6d& free, const Matrix6d& K) noexcept;

  private:
    std::vector<Vector6d> rows_;
    std::vector<double> bounds_;
    size_t count_ = 0;
};

}  // namespace bonemill
