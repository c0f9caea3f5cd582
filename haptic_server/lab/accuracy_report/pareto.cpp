#include "haptic_server/lab/accuracy_report/pareto.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace bonemill {
namespace {

bool isBetter(const ParetoPoint& a, const ParetoPoint& b) {
    return a.error <= b.error && a.time <= b.time && (a.error < b.error || a.time < b.time);
}

// Looks among the candidates with error <= most_error and time <= most_time.
std::optional<size_t> fastestBelow(std::span<const ParetoPoint> points, double most_error, double most_time) {
    std::optional<size_t> best;
    for (size_t n = 0; n < points.size(); ++n) {
        const ParetoPoint& p = points[n];
        if (!p.is_candidate || p.error > most_error || p.time > most_time) continue;
        if (!best || std::tie(p.time, p.error) < std::tie(points[*best].time, points[*best].error)) best = n;
    }
    return best;
}

}  // namespace

std::vector<bool> paretoFront(std::span<const ParetoPoint> points) {
    std::vector<bool> front;
    for (const ParetoPoint& point : points) {
        bool is_best = point.is_candidate;
        for (const ParetoPoint& other : points) is_best &= !(other.is_candidate && isBetter(other, point));
        front.push_back(is_best);
    }
    return front;
}

std::optional<size_t> bestWithin(std::span<const ParetoPoint> points, double budget) {
    double least = INFINITY;
    for (const ParetoPoint& point : points)
        if (point.is_candidate && point.time <= budget) least = std::min(least, point.error);
    return fastestBelow(points, least * (1 + kSameError), budget);
}

std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from) {
    return fastestBelow(points, points[from].error * (1 - kSameError), INFINITY);
}

}  // namespace bonemill
