#include "haptic_server/core/tool/tool_shape.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double segmentDistance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
    const Vector2d ab = b - a;
    const double length2 = ab.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    return (p - a - t * ab).norm();
}

double distanceTo(const SphereShape& s, const Vector3d& p) {
    return (p - s.center).norm() - s.radius;
}

double distanceTo(const CapsuleShape& s, const Vector3d& p) {
    const Vector3d axis = s.to - s.from;
    const double length2 = axis.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - s.from).dot(axis) / length2, 0.0, 1.0) : 0.0;
    return (p - s.from - t * axis).norm() - s.radius;
}

// The profile is the trapezoid between the axis, the two ends and the side.
double distanceToSharp(const ConeShape& s, const Vector3d& p) {
    const double length = (s.to - s.from).norm();
    const Vector3d axis = (s.to - s.from) / length;
    const double along = (p - s.from).dot(axis);
    const Vector2d q(along, (p - s.from - along * axis).norm());
    const double distance = std::min({segmentDistance(q, {0, 0}, {0, s.from_radius}),
                                      segmentDistance(q, {0, s.from_radius}, {length, s.to_radius}),
                                      segmentDistance(q, {length, 0}, {length, s.to_radius})});
    const double side = s.from_radius + (s.to_radius - s.from_radius) * along / length;
    return along > 0 && along < length && q.y() < side ? -distance : distance;
}

double distanceTo(const ConeShape& s, const Vector3d& p) {
    const ConeShape inside = insideEdges(s);
    return distanceToSharp(inside, p) - inside.edge_radius;
}

// What an end of this radius allows, where the side rises from it by the sine `rise` of its angle to the
// axis.
double roundestAt(double radius, double rise, double edge_radius) {
    constexpr double kShareOfEnd = 0.5;
    const double run = std::sqrt(1 - rise * rise);
    if (rise > 0 && radius == 0) return rise < 1 ? edge_radius * rise / (1 - rise) : edge_radius;
    return rise < 1 ? kShareOfEnd * radius * run / (1 - rise) : kShareOfEnd * radius;
}

double distanceTo(const CylinderShape& s, const Vector3d& p) {
    return distanceTo(asCone(s), p);
}

void extendByBall(Eigen::AlignedBox3d& box, const Vector3d& center, double radius) {
    box.extend((center.array() - radius).matrix());
    box.extend((center.array() + radius).matrix());
}

void extendByDisc(Eigen::AlignedBox3d& box, const Vector3d& center, const Vector3d& axis, double radius) {
    const Vector3d reach = radius * (1 - axis.array().square()).max(0).sqrt();
    box.extend(center - reach);
    box.extend(center + reach);
}

Eigen::AlignedBox3d boxOf(const SphereShape& s) {
    Eigen::AlignedBox3d box;
    extendByBall(box, s.center, s.radius);
    return box;
}

Eigen::AlignedBox3d boxOf(const CapsuleShape& s) {
    Eigen::AlignedBox3d box;
    extendByBall(box, s.from, s.radius);
    extendByBall(box, s.to, s.radius);
    return box;
}

Eigen::AlignedBox3d boxOf(const ConeShape& s) {
    const Vector3d axis = (s.to - s.from).normalized();
    Eigen::AlignedBox3d box;
    extendByDisc(box, s.from, axis, s.from_radius);
    extendByDisc(box, s.to, axis, s.to_radius);
    return box;
}

Eigen::AlignedBox3d boxOf(const CylinderShape& s) {
    return boxOf(asCone(s));
}

}  // namespace

ConeShape insideEdges(const ConeShape& s) {
    const double length = (s.to - s.from).norm();
    const Vector3d axis = (s.to - s.from) / length;
    const Vector2d side = Vector2d(length, s.to_radius - s.from_radius).normalized();
    const double r = std::min({s.edge_radius, length / 4, roundestAt(s.from_radius, side.y(), s.edge_radius),
                               roundestAt(s.to_radius, -side.y(), s.edge_radius)});
    // The side, moved inwards by r, is so far off the axis.
    const auto off = [&](double along) { return s.from_radius + (side.y() * along - r) / side.x(); };
    double from = r, to = length - r;
    if (off(from) < 0) from = (r - s.from_radius * side.x()) / side.y();
    if (off(to) < 0) to = (r - s.from_radius * side.x()) / side.y();
    return {s.from + from * axis, s.from + to * axis, std::max(0.0, off(from)), std::max(0.0, off(to)), r};
}

double signedDistance(const ToolShape& shape, const Eigen::Vector3d& p_T) {
    return std::visit([&](const auto& s) { return distanceTo(s, p_T); }, shape);
}

Eigen::AlignedBox3d boundingBox(const ToolShape& shape) {
    return std::visit([](const auto& s) { return boxOf(s); }, shape);
}

}  // namespace bonemill
