#include "haptic_server/lab/accuracy_report/probing_path.h"

#include <algorithm>
#include <cmath>

#include "common/config/scene_geometry.h"
#include "haptic_server/core/contact/into_tool.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 50e-6;            // m: thinner than any wall that a scan shows
constexpr double kTolerance = 1e-6;        // m
constexpr AccuracySettings kExactField{};  // analytic if the tool has shapes

constexpr double kPush = 20e-6;  // m: how deep the tool is pushed to learn where the bone pushes back
constexpr size_t kMaxScenarioPlaces = 2;
constexpr int kAzimuths = 8;
constexpr double kLyingHeight = 6;  // burr radii over the place: where the laid tool starts
constexpr double kBeyond = 4;       // burr radii from the place to the laid tool's burr
constexpr double kShaftArm = 2;     // burr radii from the tool point to the force: the shaft touches

// The tool travels until it touches; there the place is.
struct Approach {
    TouchProbe& probe;
    std::vector<ProbingPlace>& places;

    bool along(const std::string& name, const TouchProbe::PoseAt& pose_at, double length) {
        const auto way = probe.freeWay(pose_at, length);
        if (!way) return false;
        const Vector3d normal = probe.pushOn(pose_at(*way + kPush));
        if (normal.isZero(0)) return false;
        const Pose X_WT = pose_at(*way);
        const auto back = probe.freeWay(X_WT, normal, 2 * ProbingPlace::kMaxRoom);
        const double room = std::min(ProbingPlace::kMaxRoom, 0.5 * back.value_or(2 * ProbingPlace::kMaxRoom));
        if (room < kPush) return false;
        places.push_back({name, X_WT, normal, room});
        return true;
    }
};

TouchProbe::PoseAt straight(const Pose& from, const Vector3d& direction) {
    return [=](double way) { return Pose{from.position + way * direction, from.rotation}; };
}

void addScenarioPlaces(const scene::SimulatedOperator& scenario, Approach& approach) {
    for (int n = 0; n + 1 < scenario.waypoint_size() && approach.places.size() < kMaxScenarioPlaces; ++n) {
        const Pose from = poseOf(scenario.waypoint(n)), to = poseOf(scenario.waypoint(n + 1));
        const double length = (to.position - from.position).norm();
        if (length == 0) continue;
        const auto pose_at = [=](double way) {
            const double share = way / length;
            return Pose{from.position + share * (to.position - from.position),
                        from.rotation.slerp(share, to.rotation)};
        };
        approach.along("on the scenario's way, segment " + std::to_string(n + 1), pose_at, length);
    }
}

// The shaft points back to where the tool comes from.
void addFacePlaces(const BoneModel& bone, Approach& approach) {
    const VolumeGeometry& geometry = bone.volume.geometry();
    const Vector3d size = geometry.spacing.cwiseProduct(geometry.dims.cast<double>());
    const Vector3d middle = geometry.X_WV * (size / 2);
    for (int face = 0; face < 6 && approach.places.size() < kMaxScenarioPlaces; ++face) {
        const Vector3d outward =
            geometry.X_WV.rotation * ((face & 1 ? 1.0 : -1.0) * Vector3d::Unit(2 - face / 2));
        const double way = size.norm();
        const Pose from{middle + way * outward, rotationBetween(Vector3d::UnitY(), outward)};
        approach.along("from the volume's face " + std::to_string(face + 1), straight(from, -outward), way);
    }
}

void addPlacesBeside(const ProbingPlace& first, double burr_radius, Approach& approach) {
    const Vector3d t = tangentOf(first.normal_W);
    for (const Vector3d& side : {t, Vector3d(first.normal_W.cross(t))}) {
        const Pose from{first.X_WT.position + 2 * burr_radius * first.normal_W + 1.5 * burr_radius * side,
                        first.X_WT.rotation};
        approach.along("1.5 burr radii beside it", straight(from, -first.normal_W), 4 * burr_radius);
    }
}

// The tool is laid down across the normal, its shaft over the place and the burr beyond it, in that of
// several directions in which the shaft touches farthest from the tool point.
void addLyingPlace(const ProbingPlace& first, double burr_radius, Approach& approach) {
    const Vector3d t = tangentOf(first.normal_W), u = first.normal_W.cross(t);
    const Vector3d shaft = first.X_WT.rotation * Vector3d::UnitY();
    const double height = kLyingHeight * burr_radius;
    std::optional<ProbingPlace> best;
    double longest_arm = kShaftArm * burr_radius;
    for (int n = 0; n < kAzimuths; ++n) {
        const double azimuth = 2 * M_PI * n / kAzimuths;
        const Vector3d along = std::cos(azimuth) * t + std::sin(azimuth) * u;
        const Pose from{first.X_WT.position + height * first.normal_W - kBeyond * burr_radius * along,
                        rotationBetween(shaft, along) * first.X_WT.rotation};
        std::vector<ProbingPlace> found;
        Approach lying{approach.probe, found};
        if (!lying.along("lying on its shaft there", straight(from, -first.normal_W),
                         height + 4 * burr_radius))
            continue;
        const Pose pushed{found[0].X_WT.position - kPush * found[0].normal_W, found[0].X_WT.rotation};
        const double arm = approach.probe.armOf(pushed);
        if (arm <= longest_arm) continue;
        longest_arm = arm;
        best = found[0];
    }
    if (best) approach.places.push_back(*best);
}

constexpr int kLoopKnots = 24;
constexpr int kPressKnots = 3;
constexpr double kRestTime = 0.04;  // s at the end: the tool comes back to the device

// This is the loop's frame at a place.
struct Loop {
    const ProbingPlace& place;
    Vector3d t, u;
    double radius;
    double turning;

    Vector3d offset(double angle) const {
        return radius * (std::sin(angle) * t + 0.5 * (1 - std::cos(angle)) * u);
    }
    Vector3d rotation(double angle) const {
        return turning * (std::sin(angle) * t + std::sin(2 * angle) * u);
    }
};

// At this height over the place, along its normal, the tool touches there; it is nearly `before` if
// it does not.
double surfaceHeight(const Loop& loop, double angle, double before, TouchProbe& probe) {
    const ProbingPlace& place = loop.place;
    const Pose lifted{place.X_WT.position + place.room * place.normal_W + loop.offset(angle),
                      expRotation(loop.rotation(angle)) * place.X_WT.rotation};
    const auto way = probe.freeWay(lifted, -place.normal_W, place.room + 2 * loop.radius);
    if (!way) return before;
    // The path is no steeper than the loop is wide, for it must stay smooth.
    const double steepest = 2 * M_PI / kLoopKnots * loop.radius;
    return std::clamp(place.room - *way, before - steepest, before + steepest);
}

}  // namespace

TouchProbe::TouchProbe(const BoneModel& bone, const ToolModel& tool)
    : bone_(bone),
      field_(tool.field(kExactField)),
      X_VW_(bone.volume.geometry().X_WV.inverse()),
      level_(levelOf(bone.shell, kExactField)),
      contact_(GradientContactConfig{}) {}

GradientContactResult TouchProbe::contactAt(const Pose& X_WT) {
    const Pose X_VT = X_VW_ * X_WT;
    contact_.gather({bone_.volume, bone_.lattice, bone_.shell, level_, 1, 0}, field_, X_VT, kTolerance);
    return contact_.evaluate<double>(field_, X_VT);
}

bool TouchProbe::isInBone(const Eigen::Vector3d& p_W) const {
    const VoxelVolume& volume = bone_.volume;
    const Eigen::Array3d index = ((X_VW_ * p_W).array() / volume.spacing().array()).round();
    if ((index < 0).any() || (index >= volume.dims().cast<double>().array()).any()) return false;
    const Eigen::Array3i voxel = index.cast<int>();
    return volume.at(voxel.x(), voxel.y(), voxel.z()) >= volume.iso();
}

bool TouchProbe::touches(const Pose& X_WT) {
    return contactAt(X_WT).contacts > 0 || isInBone(X_WT.position);
}

Eigen::Vector3d TouchProbe::pushOn(const Pose& X_WT) {
    const Eigen::Vector3d force = X_VW_.rotation.conjugate() * contactAt(X_WT).term.wrench.force;
    return force.norm() > 0 ? Eigen::Vector3d(force.normalized()) : Eigen::Vector3d::Zero();
}

double TouchProbe::armOf(const Pose& X_WT) {
    const Wrench push = contactAt(X_WT).term.wrench;
    return push.force.norm() > 0 ? push.torque.norm() / push.force.norm() : 0;
}

std::optional<double> TouchProbe::freeWay(const PoseAt& pose_at, double longest) {
    if (touches(pose_at(0))) return std::nullopt;
    for (double free = 0; free < longest;) {
        const double next = std::min(longest, free + kStep);
        if (!touches(pose_at(next))) {
            free = next;
            continue;
        }
        for (double touching = next; touching - free > kTolerance;) {
            const double middle = (free + touching) / 2;
            (touches(pose_at(middle)) ? touching : free) = middle;
        }
        return free;
    }
    return std::nullopt;
}

std::optional<double> TouchProbe::freeWay(const Pose& X_WT, const Eigen::Vector3d& direction,
                                          double longest) {
    return freeWay(straight(X_WT, direction), longest);
}

Eigen::AlignedBox3d TouchProbe::surfaceNear(std::span<const Pose> path, double distance) const {
    Eigen::AlignedBox3d near;
    for (const Pose& X_WT : path) {
        const Pose X_TV = (X_VW_ * X_WT).inverse();
        Eigen::AlignedBox3d box = boxInV(field_.box(), X_VW_ * X_WT);
        box.min().array() -= distance;
        box.max().array() += distance;
        bone_.lattice.forEachSurfaceLeaf(box, bone_.volume.spacing(), bone_.volume.iso(), [&](LeafId leaf) {
            bone_.shell.forEachBlock(level_, leaf, [&](const ShellBlock& block, uint32_t count) {
                for (uint32_t i = 0; i < count; ++i) {
                    const Eigen::Vector3d p_V(block.x[i], block.y[i], block.z[i]);
                    if (!near.contains(p_V) && field_.distanceBound(X_TV * p_V) <= distance) near.extend(p_V);
                }
            });
        });
    }
    return near;
}

Eigen::Vector3d tangentOf(const Eigen::Vector3d& normal) {
    Eigen::Index least;
    normal.cwiseAbs().minCoeff(&least);
    return normal.cross(Vector3d::Unit(least)).normalized();
}

std::vector<ProbingPlace> findProbingPlaces(const scene::SimulatedOperator& scenario, const BoneModel& bone,
                                            double burr_radius, TouchProbe& probe) {
    std::vector<ProbingPlace> places;
    Approach approach{probe, places};
    addScenarioPlaces(scenario, approach);
    if (places.empty()) addFacePlaces(bone, approach);
    if (places.empty()) return places;
    const ProbingPlace first = places.front();
    addPlacesBeside(first, burr_radius, approach);
    addLyingPlace(first, burr_radius, approach);
    return places;
}

PosePath smoothPath(const Eigen::Quaterniond& base, const std::vector<PathKnot>& knots, int ticks) {
    // End knots count three times: the spline starts and ends there.
    const int last = int(knots.size()) - 1;
    const auto knotAt = [&](int n) -> const PathKnot& { return knots[size_t(std::clamp(n - 2, 0, last))]; };
    const int segments = last + 2;
    PosePath path;
    for (int n = 0; n < ticks; ++n) {
        const double at = double(n) / std::max(1, ticks - 1) * segments;
        const int segment = std::min(int(at), segments - 1);
        const double t = at - segment, s = 1 - t;
        const double weights[] = {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                                  (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6};
        PathKnot knot{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        for (int i = 0; i < 4; ++i) {
            knot.position += weights[i] * knotAt(segment + i).position;
            knot.rotation += weights[i] * knotAt(segment + i).rotation;
        }
        path.push_back({knot.position, (expRotation(knot.rotation) * base).normalized()});
    }
    return path;
}

double stretchOf(const EnergyCoupling& coupling, double force) {
    const double most = coupling.saturation_force;
    return std::atanh(force / most) * most / coupling.translation_stiffness;
}

ProbingStroke makeStroke(const ProbingPlace& place, const StrokeConfig& stroke, const FixedTickConfig& tick,
                         TouchProbe& probe) {
    const Vector3d t = tangentOf(place.normal_W);
    const Loop loop{place, t, place.normal_W.cross(t), std::min(stroke.loop_radius, tick.tool.burr.radius),
                    stroke.turning};
    const double heaviest = std::min(stroke.heaviest, kHeaviestShare * tick.tool.saturation_force);
    const double lightest = std::min(stroke.lightest, heaviest / 2);
    const auto pressed = [&](double angle, double height) -> PathKnot {
        const double load = lightest + (heaviest - lightest) * 0.5 * (1 - std::cos(3 * angle));
        const double depth = stretchOf(tick.toolCoupling(), load);
        return {place.X_WT.position + loop.offset(angle) + (height - depth) * place.normal_W,
                loop.rotation(angle)};
    };
    const PathKnot lifted{place.X_WT.position + place.room * place.normal_W};
    std::vector<PathKnot> knots{lifted};
    const PathKnot first = pressed(0, 0);
    for (int n = 1; n < kPressKnots; ++n)
        knots.push_back({lifted.position + double(n) / kPressKnots * (first.position - lifted.position)});
    double height = 0;
    for (int n = 0; n <= kLoopKnots; ++n) {
        const double angle = 2 * M_PI * n / kLoopKnots;
        height = surfaceHeight(loop, angle, height, probe);
        knots.push_back(pressed(angle, height));
    }
    const PathKnot last = knots.back();
    for (int n = kPressKnots - 1; n > 0; --n)
        knots.push_back({lifted.position + double(n) / kPressKnots * (last.position - lifted.position)});
    knots.push_back(lifted);

    ProbingStroke made{place.name,
                       smoothPath(place.X_WT.rotation, knots, int(std::lround(stroke.duration / tick.dt))),
                       stretchOf(tick.toolCoupling(), heaviest)};
    made.device.resize(made.device.size() + size_t(std::lround(kRestTime / tick.dt)), made.device.back());
    return made;
}

}  // namespace bonemill
