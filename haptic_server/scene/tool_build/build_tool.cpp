#include "haptic_server/scene/tool_build/build_tool.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/math/pinned_math.h"
#include "haptic_server/scans/solid_mesh/mesh_distance.h"
#include "haptic_server/scans/solid_mesh/mesh_file.h"

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

constexpr double kDefaultShaftRadius = 0.8;      // of the burr's
constexpr double kShaftOverlap = 0.2;            // of half the burr's length, that the shaft begins inside it
constexpr double kFinestBurrRadiusSpacings = 2;  // below it the grid no longer shows a ball
constexpr int64_t kMostNodes = int64_t(1) << 26;  // 256 MiB of distances
constexpr double kLipschitzSlack = 1.001;         // float rounding

std::string text(const char* format, auto... values) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

// Sizes that the radius alone does not tell.
void checkBurr(const ToolConfig& config) {
    if (config.burr_kind == BurrKind::kBall) return;
    if (!(config.burr_length > 0) || !std::isfinite(config.burr_length))
        throw UserError("tool.burr_length_mm must be a positive number: the burr is no ball");
    if (!(config.burr_tip_radius >= 0) || !std::isfinite(config.burr_tip_radius))
        throw UserError("tool.burr_tip_radius_mm must be a number not below 0");
}

void checkConfig(const ToolConfig& config) {
    if (!config.shapes.empty() && !config.mesh_path.empty())
        throw UserError("tool: both shape and mesh_path are given; keep one of them");
    for (size_t i = 0; i < config.shapes.size(); ++i)
        checkShape(config.shapes[i], "tool.shape[" + std::to_string(i) + "]");
    if (!(config.burr_radius > 0) || !std::isfinite(config.burr_radius))
        throw UserError("tool.burr_radius_mm must be a positive number");
    checkBurr(config);
    if (!(config.sdf_spacing > 0) || !std::isfinite(config.sdf_spacing))
        throw UserError("tool.sdf_spacing_mm must be a positive number");
    const auto nodes = config.sdf_nodes.cast<int64_t>();
    if ((nodes.array() < 4).any() || (nodes.array() > kMostNodes).any() ||
        nodes.x() * nodes.y() > kMostNodes || nodes.x() * nodes.y() * nodes.z() > kMostNodes)
        throw UserError(text(
            "tool.sdf_nodes: %d x %d x %d is not usable; each must be at least 4, their product at most %lld",
            config.sdf_nodes.x(), config.sdf_nodes.y(), config.sdf_nodes.z(), (long long)kMostNodes));
    if (config.sdf_origin_T && !config.sdf_origin_T->allFinite())
        throw UserError("tool.sdf_origin_mm must be finite numbers");
}

Vector3d gridSize(const ToolConfig& config) {
    return config.sdf_spacing * (config.sdf_nodes.array() - 1).cast<double>();
}

double marginedBurrEnd(const ToolConfig& config, double burr_end_y) {
    return burr_end_y - kBurrMarginSpacings * config.sdf_spacing;
}

// Returns the burr's farthest place from the hand, along y.
double burrEnd(const ToolConfig& config) {
    return config.burr_kind == BurrKind::kBall ? -config.burr_radius : -config.burr_length / 2;
}

Vector3d gridOrigin(const ToolConfig& config, const Eigen::AlignedBox3d& tool_box) {
    if (config.sdf_origin_T) return *config.sdf_origin_T;
    Vector3d origin = tool_box.center() - gridSize(config) / 2;
    origin.y() = marginedBurrEnd(config, tool_box.min().y());
    return origin;
}

// `distance` takes a Vector3d, returns a double, negative inside, and is called for neighbours along
// x in turn.
template <class Distance>
SdfGrid sample(const ToolConfig& config, const Vector3d& origin, Distance&& distance) {
    const Eigen::Vector3i& n = config.sdf_nodes;
    std::vector<float> values;
    values.reserve(size_t(n.x()) * size_t(n.y()) * size_t(n.z()));
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i)
                values.push_back(float(distance(Vector3d(origin + config.sdf_spacing * Vector3d(i, j, k)))));
    return {n, config.sdf_spacing, origin, std::move(values)};
}

// A true distance changes by no more than the step. Where parts of a mesh pass through each other or a part
// is inside out, the sign jumps.
void checkLipschitz(const SdfGrid& sdf, const std::string& file) {
    const double most = kLipschitzSlack * sdf.spacing();
    const Eigen::Vector3i& n = sdf.nodes();
    for (int k = 0; k < n.z(); ++k)
        for (int j = 0; j < n.y(); ++j)
            for (int i = 0; i < n.x(); ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    const Eigen::Vector3i next = Eigen::Vector3i(i, j, k) + Eigen::Vector3i::Unit(axis);
                    if ((next.array() >= n.array()).any()) continue;
                    if (std::abs(sdf.at(next.x(), next.y(), next.z()) - sdf.at(i, j, k)) <= most) continue;
                    const Vector3d p = kPerMillimetre * sdf.nodePosition(i, j, k);
                    throw UserError(
                        file + text(": inside and outside cannot be told apart near (%.3f, %.3f, %.3f) mm: "
                                    "parts pass through each other or are inside out; merge them into one "
                                    "solid (boolean union), then export again",
                                    p.x(), p.y(), p.z()));
                }
}

void checkNotEmpty(const SdfGrid& sdf) {
    if (!sdf.box().isEmpty()) return;
    throw UserError(
        text("tool: no node of its distance grid lies inside the tool: it is thinner than "
             "tool.sdf_spacing_mm (%.3f mm) or outside of the grid; lower the spacing, or correct "
             "tool.sdf_origin_mm, the shapes or the mesh",
             sdf.spacing() * kPerMillimetre));
}

struct Sampled {
    SdfGrid sdf;
    Eigen::AlignedBox3d tool_box;
};

Sampled sampleShapes(const ToolConfig& config) {
    const std::vector<ToolShape> shapes = toolShapes(config);
    Eigen::AlignedBox3d box;
    for (const ToolShape& shape : shapes) box.extend(boundingBox(shape));
    const auto distance = [&](const Vector3d& p) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const ToolShape& shape : shapes) nearest = std::min(nearest, signedDistance(shape, p));
        return nearest;
    };
    return {sample(config, gridOrigin(config, box), distance), box};
}

TriangleMesh readClosedMesh(const ToolConfig& config) {
    return closedMesh(readMeshFile(config.mesh_path), config.mesh_path.string());
}

Sampled sampleMesh(const ToolConfig& config) {
    const TriangleMesh mesh = readClosedMesh(config);
    const MeshDistance mesh_distance(mesh);
    uint32_t guess = 0;
    const auto distance = [&](const Vector3d& p) {
        const MeshDistance::Nearest nearest = mesh_distance.query(p, guess);
        guess = nearest.triangle;
        return nearest.distance;
    };
    const Eigen::AlignedBox3d box = mesh.box();
    SdfGrid sdf = sample(config, gridOrigin(config, box), distance);
    checkLipschitz(sdf, config.mesh_path.string());
    return {std::move(sdf), box};
}

Sampled sampleTool(const ToolConfig& config) {
    return config.mesh_path.empty() ? sampleShapes(config) : sampleMesh(config);
}

// Makes the same tool in the same space with more nodes.
ToolConfig refined(const ToolConfig& config, const SdfGrid& coarse, int refinement) {
    ToolConfig fine = config;
    if (fine.mesh_path.empty()) fine.shapes = toolShapes(config);
    fine.sdf_nodes = ((coarse.nodes().array() - 1) * refinement + 1).matrix();
    fine.sdf_spacing = coarse.spacing() / refinement;
    fine.sdf_origin_T = coarse.origin();
    return fine;
}

// The far (+y) end is where the shaft goes on to the hand.
std::vector<std::string> cutWarnings(const SdfGrid& sdf, const Eigen::AlignedBox3d& tool_box) {
    std::vector<std::string> warnings;
    const double tolerance = 1e-6 * sdf.spacing();
    for (int axis = 0; axis < 3; ++axis) {
        const double below = sdf.gridBox().min()[axis] - tool_box.min()[axis];
        const double above = axis == 1 ? 0 : tool_box.max()[axis] - sdf.gridBox().max()[axis];
        const double most = std::max(below, above);
        if (most <= tolerance) continue;
        const char name = "xyz"[axis];
        warnings.push_back(
            text("tool: it sticks out of its distance grid by %.3f mm at the %c%c side, and is not felt "
                 "there; raise tool.sdf_nodes_%c or tool.sdf_spacing_mm, or move tool.sdf_origin_mm",
                 most * kPerMillimetre, below >= above ? '-' : '+', name, name));
    }
    return warnings;
}

// Returns how far at most the burr reaches out of the tool, m, at places all over its surface.
double burrOutside(const Burr& burr, const SdfGrid& sdf) {
    constexpr int kAround = 24, kAlong = 24;
    double farthest = 0;
    for (int i = 0; i < kAround; ++i)
        for (int k = 0; k <= kAlong; ++k) {
            const double angle = 2 * M_PI * i / kAround,
                         along = 2.0 * k / kAlong - 1;  // -1: far from the hand
            double y = burr.length / 2 * along;
            double off_axis = burr.radius;
            if (burr.kind == BurrKind::kCone)
                off_axis = burr.tip_radius + (burr.radius - burr.tip_radius) * (1 + along) / 2;
            if (burr.kind == BurrKind::kBall) {
                y = burr.radius * pinned::sin(M_PI / 2 * along);
                off_axis = burr.radius * pinned::cos(M_PI / 2 * along);
            }
            const Vector3d p(off_axis * pinned::cos(angle), y, off_axis * pinned::sin(angle));
            if (sdf.gridBox().contains(p)) farthest = std::max(farthest, double(sdf.distance(p)));
        }
    return farthest;
}

std::vector<std::string> warningsFor(const ToolConfig& config, const Sampled& sampled) {
    std::vector<std::string> warnings = cutWarnings(sampled.sdf, sampled.tool_box);
    if (config.burr_radius < kFinestBurrRadiusSpacings * config.sdf_spacing)
        warnings.push_back(
            text("tool: burr_radius_mm %.3f is below %g spacings of the distance grid (%.3f mm each): its "
                 "shape is lost; lower tool.sdf_spacing_mm",
                 config.burr_radius * kPerMillimetre, kFinestBurrRadiusSpacings,
                 config.sdf_spacing * kPerMillimetre));
    if (sampled.sdf.distance(Vector3d::Zero()) >= 0)
        warnings.push_back(
            "tool: the origin of frame T, where the burr cuts, is not inside the tool: bone goes where the "
            "tool is not; move the shapes or the mesh so that the burr's centre is at (0, 0, 0)");
    else if (const double outside = burrOutside(config.burr(), sampled.sdf); outside > config.sdf_spacing)
        warnings.push_back(
            text("tool: its burr sticks out of it by %.3f mm: that part cuts nothing it touches; "
                 "correct burr_kind and the burr's sizes, or the shapes or the mesh",
                 outside * kPerMillimetre));
    return warnings;
}

}  // namespace

void checkShape(const ToolShape& shape, const std::string& name) {
    std::visit([&](const auto& s) { check(s, name); }, shape);
}

BuiltTool buildTool(const ToolConfig& config, const std::vector<int>& refinements) {
    checkConfig(config);
    Sampled sampled = sampleTool(config);
    checkNotEmpty(sampled.sdf);
    BuiltTool tool{
        {std::move(sampled.sdf), config.mesh_path.empty() ? toolShapes(config) : std::vector<ToolShape>{},
         config.burr_radius},
        {}};
    tool.warnings = warningsFor(config, {tool.model.grid(), sampled.tool_box});
    for (const int refinement : refinements)
        tool.model.addRefinedGrid(refinement, sampleTool(refined(config, tool.model.grid(), refinement)).sdf);
    return tool;
}

std::vector<ToolShape> toolShapes(const ToolConfig& config) {
    if (!config.shapes.empty() || !config.mesh_path.empty()) return config.shapes;
    const double radius = kDefaultShaftRadius * config.burr_radius;
    const double first =
        config.sdf_origin_T ? config.sdf_origin_T->y() : marginedBurrEnd(config, burrEnd(config));
    const double hand_end = config.burr_kind == BurrKind::kBall ? config.burr_radius : config.burr_length / 2;
    const Vector3d last = std::max(first + gridSize(config).y() + radius, hand_end) * Vector3d::UnitY();
    if (config.burr_kind == BurrKind::kBall)
        return {SphereShape{Vector3d::Zero(), config.burr_radius},
                CapsuleShape{Vector3d::Zero(), last, radius}};
    const Vector3d half = config.burr_length / 2 * Vector3d::UnitY();
    // The shaft begins inside a cone, which is as wide as the shaft only there.
    const CylinderShape shaft{(1 - kShaftOverlap) * half, last + radius * Vector3d::UnitY(), radius,
                              kEdgeRadius};
    if (config.burr_kind == BurrKind::kCylinder)
        return {CylinderShape{-half, half, config.burr_radius, kEdgeRadius}, shaft};
    return {ConeShape{-half, half, config.burr_tip_radius, config.burr_radius, kEdgeRadius}, shaft};
}

TriangleSurface toolSurface(const ToolConfig& config) {
    checkConfig(config);
    return config.mesh_path.empty() ? surfaceOf(toolShapes(config)) : surfaceOf(readClosedMesh(config));
}

}  // namespace bonemill
