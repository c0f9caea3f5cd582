#include "haptic_server/tool/build/shapes.h"

#include <algorithm>
#include <cmath>

#include "common/config/user_error.h"

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

// Profile: the trapezoid between the axis, the two ends and the side.
double distanceTo(const ConeShape& s, const Vector3d& p) {
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

ConeShape asCone(const CylinderShape& s) {
    return {s.from, s.to, s.radius, s.radius};
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

void require(bool condition, const std::string& name, const char* complaint) {
    if (!condition) throw UserError(name + " " + complaint);
}

void requireRadius(double radius, const std::string& name) {
    require(std::isfinite(radius) && radius > 0, name, "has no positive radius: give one in mm");
}

void requireEnds(const Vector3d& from, const Vector3d& to, const std::string& name) {
    require(from.allFinite() && to.allFinite(), name, "has an end that is not a finite number");
}

void requireLength(const Vector3d& from, const Vector3d& to, const std::string& name) {
    require((to - from).norm() > 0, name, "has no length: from_mm and to_mm must differ");
}

void check(const SphereShape& s, const std::string& name) {
    require(s.center.allFinite(), name, "has a centre that is not a finite number");
    requireRadius(s.radius, name);
}

void check(const CapsuleShape& s, const std::string& name) {
    requireEnds(s.from, s.to, name);
    requireRadius(s.radius, name);
}

void check(const CylinderShape& s, const std::string& name) {
    requireEnds(s.from, s.to, name);
    requireLength(s.from, s.to, name);
    requireRadius(s.radius, name);
}

void check(const ConeShape& s, const std::string& name) {
    requireEnds(s.from, s.to, name);
    requireLength(s.from, s.to, name);
    const bool usable = std::isfinite(s.from_radius) && std::isfinite(s.to_radius) && s.from_radius >= 0 &&
                        s.to_radius >= 0 && s.from_radius + s.to_radius > 0;
    require(usable, name, "needs two radii that are not negative, one of them positive");
}

}  // namespace

void checkShape(const ToolShape& shape, const std::string& name) {
    std::visit([&](const auto& s) { check(s, name); }, shape);
}

double signedDistance(const ToolShape& shape, const Eigen::Vector3d& p_T) {
    return std::visit([&](const auto& s) { return distanceTo(s, p_T); }, shape);
}

Eigen::AlignedBox3d boundingBox(const ToolShape& shape) {
    return std::visit([](const auto& s) { return boxOf(s); }, shape);
}

}  // namespace bonemill
