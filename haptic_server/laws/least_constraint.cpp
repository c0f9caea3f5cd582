#include "haptic_server/laws/least_constraint.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

namespace bonemill {
namespace {

constexpr double kDependent = 1e-10;  // of a squared row: what the active rows leave of it
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The rows in force, in coordinates in which K is the identity, with their multipliers.
class ActiveSet {
  public:
    static constexpr int kMax = 6;
    using Small = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMax, 1>;
    using SmallSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMax, kMax>;

    int count() const noexcept { return count_; }
    const Vector6d& row(int n) const noexcept { return row_[n]; }
    size_t index(int n) const noexcept { return index_[n]; }
    double multiplier(int n) const noexcept { return multiplier_[n]; }
    bool has(size_t index) const noexcept {
        return std::find(index_, index_ + count_, index) != index_ + count_;
    }

    void add(const Vector6d& row, size_t index, double multiplier) noexcept {
        row_[count_] = row;
        index_[count_] = index;
        multiplier_[count_++] = multiplier;
    }
    void drop(int n) noexcept {
        --count_;
        row_[n] = row_[count_], index_[n] = index_[count_], multiplier_[n] = multiplier_[count_];
    }

    // Splits `row` into a combination of the active ones (`share`) and the rest of it, which is returned.
    Vector6d across(const Vector6d& row, Small& share) const noexcept {
        share.setZero(count_);
        if (count_ == 0) return row;
        SmallSquare products(count_, count_);
        Small with_row(count_);
        for (int i = 0; i < count_; ++i) {
            with_row[i] = row_[i].dot(row);
            for (int j = 0; j <= i; ++j) products(i, j) = products(j, i) = row_[i].dot(row_[j]);
        }
        share = products.ldlt().solve(with_row);
        Vector6d rest = row;
        for (int i = 0; i < count_; ++i) rest -= share[i] * row_[i];
        return rest;
    }
    // The first multiplier that would change its sign does so after this step along -share.
    double longestStep(const Small& share, int& blocking) const noexcept {
        double longest = kInfinite;
        for (int i = 0; i < count_; ++i) {
            if (!(share[i] > 0)) continue;
            const double step = multiplier_[i] / share[i];
            if (step < longest) longest = step, blocking = i;
        }
        return longest;
    }
    void lower(const Small& share, double step) noexcept {
        for (int i = 0; i < count_; ++i) multiplier_[i] = std::max(0.0, multiplier_[i] - step * share[i]);
    }

  private:
    Vector6d row_[kMax];
    size_t index_[kMax] = {};
    double multiplier_[kMax] = {};
    int count_ = 0;
};

// Makes `row` hold: x moves until row · x = bound, and active rows that pull instead of pushing are dropped
// on the way. False: it cannot hold together with the active ones.
bool enforce(ActiveSet& active, Vector6d& x, const Vector6d& row, double bound, size_t index) noexcept {
    double multiplier = 0;
    for (int n = 0; n <= ActiveSet::kMax; ++n) {
        ActiveSet::Small share;
        const Vector6d rest = active.across(row, share);
        const bool is_free =
            active.count() < ActiveSet::kMax && rest.squaredNorm() > kDependent * row.squaredNorm();
        int blocking = -1;
        const double longest = active.longestStep(share, blocking);
        const double whole = is_free ? (bound - row.dot(x)) / rest.dot(row) : kInfinite;
        const double step = std::min(longest, whole);
        if (!(step < kInfinite)) return false;
        if (is_free) x += step * rest;
        active.lower(share, step);
        multiplier += step;
        if (whole <= longest) {
            active.add(row, index, multiplier);
            return true;
        }
        active.drop(blocking);
    }
    return false;
}

}  // namespace

LeastConstraint::Result LeastConstraint::solve(const Vector6d& free, const Matrix6d& K) noexcept {
    Result result{.motion = free};
    const Eigen::LLT<Matrix6d> factors(K);
    if (factors.info() != Eigen::Success || !free.allFinite()) {
        result.is_feasible = false;
        result.motion.setZero();
        return result;
    }
    ActiveSet active;
    Vector6d x = factors.matrixU() * free;
    for (int pivot = 0; pivot < kMaxPivots; ++pivot) {
        result.motion = factors.matrixU().solve(x);
        size_t worst = 0;
        double most = kSlack;
        for (size_t n = 0; n < count_; ++n) {
            const double violation = bounds_[n] - rows_[n].dot(result.motion);
            if (violation > most && !active.has(n)) most = violation, worst = n;
        }
        if (most == kSlack) break;
        const Vector6d row = factors.matrixL().solve(rows_[worst]);
        if (enforce(active, x, row, bounds_[worst], worst)) continue;
        bounds_[worst] = -kInfinite;  // it is given up
        result.is_feasible = false;
    }
    result.active = active.count();
    for (int n = 0; n < active.count(); ++n) result.reaction += active.multiplier(n) * rows_[active.index(n)];
    return result;
}

}  // namespace bonemill
