#include "haptic_server/accuracy_report/pareto.h"

#include <tuple>

namespace bonemill {
namespace {

bool isBetter(const ParetoPoint& a, const ParetoPoint& b) {
    return a.error <= b.error && a.time <= b.time && (a.error < b.error || a.time < b.time);
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
    std::optional<size_t> best;
    for (size_t n = 0; n < points.size(); ++n) {
        if (!points[n].is_candidate || points[n].time > budget) continue;
        if (!best ||
            std::tie(points[n].error, points[n].time) < std::tie(points[*best].error, points[*best].time))
            best = n;
    }
    return best;
}

std::optional<size_t> nextBetter(std::span<const ParetoPoint> points, size_t from) {
    std::optional<size_t> next;
    for (size_t n = 0; n < points.size(); ++n) {
        if (!points[n].is_candidate || points[n].error >= points[from].error) continue;
        if (!next ||
            std::tie(points[n].time, points[n].error) < std::tie(points[*next].time, points[*next].error))
            next = n;
    }
    return next;
}

}  // namespace bonemill
