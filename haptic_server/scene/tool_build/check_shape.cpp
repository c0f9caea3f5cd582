#include "haptic_server/scene/tool_build/check_shape.h"

#include <cmath>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

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

}  // namespace bonemill
