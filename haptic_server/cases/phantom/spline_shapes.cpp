#include "haptic_server/cases/phantom/spline_shapes.h"

#include <limits>

namespace bonemill {
namespace {

constexpr int kPiecesPerPoint = 8;

// It is a uniform Catmull-Rom spline from b (t = 0) to c (t = 1).
template <class T>
T catmullRom(const T& a, const T& b, const T& c, const T& d, double t) {
    return 0.5 *
           (2 * b + t * (c - a) + t * t * (2 * a - 5 * b + 4 * c - d) + t * t * t * (3 * b - a - 3 * c + d));
}

// Goes through the points 0 .. n - 1 of point(i), which goes on straight beyond its ends.
template <class Point>
auto splineAt(const Point& point, int n, double t) {
    const auto extended = [&](int i) -> decltype(point(0)) {
        if (i < 0) return 2 * point(0) - point(1);
        return i < n ? point(i) : decltype(point(0))(2 * point(n - 1) - point(n - 2));
    };
    const int piece = std::clamp(int(std::floor(t)), 0, n - 2);
    using T = decltype(point(0));
    return catmullRom<T>(extended(piece - 1), point(piece), point(piece + 1), extended(piece + 2), t - piece);
}

double distanceToPiece(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector3d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (p - a - t * along).norm();
}

}  // namespace

SplineTube::SplineTube(const std::vector<Eigen::Vector3d>& points, double radius) : radius_(radius) {
    const int n = int(points.size()), pieces = (n - 1) * kPiecesPerPoint;
    const auto point = [&](int i) -> Eigen::Vector3d { return points[size_t(i)]; };
    for (int k = 0; k <= pieces; ++k) {
        curve_.push_back(splineAt(point, n, double(k) / kPiecesPerPoint));
        box_.extend(curve_.back());
    }
    box_.min().array() -= radius;
    box_.max().array() += radius;
}

double SplineTube::signedDistance(const Eigen::Vector3d& p) const noexcept {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 1; k < curve_.size(); ++k)
        nearest = std::min(nearest, distanceToPiece(p, curve_[k - 1], curve_[k]));
    return nearest - radius_;
}

SplineSheet::SplineSheet(Lattice lattice, double thickness)
    : lattice_(std::move(lattice)), thickness_(thickness) {
    const Eigen::Vector2d steps(double(lattice_.heights[0].size() - 1), double(lattice_.heights.size() - 1));
    high_ = lattice_.low + lattice_.spacing.cwiseProduct(steps);
}

double SplineSheet::heightAt(double x, double y) const noexcept {
    const auto& rows = lattice_.heights;
    const Eigen::Vector2d at = (Eigen::Vector2d(x, y) - lattice_.low).cwiseQuotient(lattice_.spacing);
    const auto height_of_row = [&](int row) {
        const auto& heights = rows[size_t(row)];
        return splineAt([&](int i) { return heights[size_t(i)]; }, int(heights.size()), at.x());
    };
    return splineAt(height_of_row, int(rows.size()), at.y());
}

bool SplineSheet::contains(const Eigen::Vector3d& p) const noexcept {
    if ((p.head<2>().array() < lattice_.low.array()).any() || (p.head<2>().array() > high_.array()).any())
        return false;
    const double above = p.z() - heightAt(p.x(), p.y());
    return above >= 0 && above < thickness_;
}

}  // namespace bonemill
