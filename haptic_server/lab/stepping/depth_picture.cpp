#include "haptic_server/lab/stepping/depth_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "common/base/user_error.h"
#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {
namespace {

void check(const DepthCamera& camera) {
    constexpr double kUnitTolerance = 1e-3;  // as of a hand's quaternion
    const auto& [p_WC, q_WC] = camera.X_WC;
    if (!p_WC.allFinite() || !(std::abs(q_WC.norm() - 1) <= kUnitTolerance))
        throw UserError("the camera's pose is not finite, or its quaternion (w, x, y, z) not of length 1");
    if (!(camera.field_of_view > 0 && camera.field_of_view < std::numbers::pi))
        throw UserError("the camera's field of view is not between 0 and 180 degrees");
    if (std::min(camera.width, camera.height) < 1 ||
        std::max(camera.width, camera.height) > kMaxDepthPictureEdge)
        throw UserError("a picture of " + std::to_string(camera.width) + " x " +
                        std::to_string(camera.height) + " pixels: each is 1 to " +
                        std::to_string(kMaxDepthPictureEdge));
    if (!(camera.far > kNearestDepth && camera.far <= kFarthestDepth))
        throw UserError("the camera sees as far as " + std::to_string(camera.far) + " m: give " +
                        std::to_string(kNearestDepth) + " to " + std::to_string(kFarthestDepth));
}

// Where pixels lie in the plane 1 m before the camera.
struct Screen {
    explicit Screen(const DepthCamera& camera)
        : width(camera.width),
          height(camera.height),
          pixel(2 * std::tan(camera.field_of_view / 2) / camera.height) {}
    double x(double column) const { return pixel * (column + 0.5 - 0.5 * width); }
    double y(double row) const { return pixel * (0.5 * height - row - 0.5); }
    double column(double x) const { return x / pixel + 0.5 * width - 0.5; }
    double row(double y) const { return 0.5 * height - 0.5 - y / pixel; }

    int width, height;
    double pixel;  // edge, m
};

// A straight way through the voxels: `at + depth * per_m`, in indices.
struct VoxelRay {
    Eigen::Array3d at, per_m;

    Eigen::Array3d point(double depth) const { return at + depth * per_m; }
    // Where it is in the box of indices, within `depths`; empty (low > high) where it is not.
    std::pair<double, double> within(const Eigen::Array3d& low, const Eigen::Array3d& high,
                                     std::pair<double, double> depths) const {
        for (int axis = 0; axis < 3; ++axis) {
            if (per_m[axis] == 0) {
                if (at[axis] < low[axis] || at[axis] > high[axis]) return {1, 0};
                continue;
            }
            const double a = (low[axis] - at[axis]) / per_m[axis], b = (high[axis] - at[axis]) / per_m[axis];
            depths = {std::max(depths.first, std::min(a, b)), std::min(depths.second, std::max(a, b))};
        }
        return depths;
    }
};

class BoneRays {
  public:
    BoneRays(const BoneModel& bone, const Pose& X_WC) : bone_(bone) {
        const Pose X_VC = bone.volume.geometry().X_WV.inverse() * X_WC;
        eye_ = X_VC.position.array() / bone.volume.spacing().array();
        R_VC_ = X_VC.rotation.toRotationMatrix();
    }

    // The depth at which the ray through this place of the screen meets bone; `far` where it does not.
    double depth(double x, double y, double far) const {
        Eigen::Array3d per_m = (R_VC_ * Eigen::Vector3d(x, y, -1)).array() / volume().spacing().array();
        // Along a node's border rounding would not say on which side of it the ray is.
        per_m = (per_m.abs() < kLeastShare * per_m.abs().maxCoeff()).select(0, per_m);
        const VoxelRay ray{eye_, per_m};
        const auto [begin, end] = ray.within(Eigen::Array3d::Constant(-1),
                                             volume().dims().cast<double>().array(), {kNearestDepth, far});
        const double step = kStepVoxels / ray.per_m.abs().maxCoeff();
        if (begin < end && isBone(ray, begin)) return begin;  // the camera is in it
        for (double from = begin; from < end;) {
            const Node node = nodeAround(ray.point(from + kProgress * step));
            const double leaves = ray.within(node.cells.min.cast<double>().array(),
                                             node.cells.max.cast<double>().array() + 1, {begin, end})
                                      .second,
                         to = std::min(std::max(leaves, from + kProgress * step), end);
            if (node.may_hold_bone)
                if (const double hit = firstBone(ray, from, to, step); hit <= to) return hit;
            from = to;
        }
        return far;
    }

  private:
    static constexpr double kStepVoxels = 0.5;   // thinner bone may be passed by
    static constexpr double kProgress = 1e-3;    // of a step, at least: into the next leaf
    static constexpr double kLeastShare = 1e-9;  // of the largest part of a direction
    static constexpr int kHalvings = 8;          // of a step: 1/512 of a voxel

    const VoxelVolume& volume() const { return bone_.volume; }
    Eigen::Vector3i cellAt(const Eigen::Array3d& place) const {
        return floorIndices(place.matrix())
            .cwiseMax(Eigen::Vector3i::Constant(-1))
            .cwiseMin(volume().dims() - Eigen::Vector3i::Ones());
    }
    // A leaf, or the largest node around it that has no bone.
    struct Node {
        IndexBox cells;
        bool may_hold_bone;
    };
    Node nodeAround(const Eigen::Array3d& place) const {
        const LeafLattice& lattice = bone_.lattice;
        const Eigen::Vector3i cell = cellAt(place);
        Eigen::Vector3i node = lattice.leavesOfCells({cell, cell}).min, nodes = lattice.leavesPerAxis(),
                        size = lattice.leafCells();
        const auto cells = [&] {
            const Eigen::Vector3i low = node.cwiseProduct(size).array() - 1;
            return IndexBox{low, (low + size).array() - 1};
        };
        Node found{cells(), true};
        for (int level = 0; level < lattice.levelCount(); ++level) {
            if (lattice.range(level, uint32_t(placeIn(nodes, node))).max >= volume().iso()) break;
            found = {cells(), false};
            node /= 2;
            nodes = (nodes.array() + 1) / 2;
            size *= 2;
        }
        return found;
    }
    bool isBone(const VoxelRay& ray, double depth) const {
        const Eigen::Array3d place = ray.point(depth);
        const Eigen::Vector3i c = cellAt(place);
        const Density* const d = volume().ownerData() + volume().offset(c.x(), c.y(), c.z());
        const Eigen::Array3d f = place - c.cast<double>().array();
        const auto row = [&](size_t at) { return d[at] + f.x() * (double(d[at + 1]) - d[at]); };
        constexpr size_t kY = VoxelVolume::kStrideY, kZ = VoxelVolume::kStrideZ;
        const double low = row(0) + f.y() * (row(kY) - row(0)),
                     high = row(kZ) + f.y() * (row(kY + kZ) - row(kZ));
        return low + f.z() * (high - low) >= volume().iso();
    }
    // Steps on from air at `from`; more than `to` where there is no bone.
    double firstBone(const VoxelRay& ray, double from, double to, double step) const {
        for (double air = from; air < to;) {
            double bone = std::min(air + step, to);
            if (!isBone(ray, bone)) {
                air = bone;
                continue;
            }
            for (int n = 0; n < kHalvings; ++n) {
                const double middle = 0.5 * (air + bone);
                (isBone(ray, middle) ? bone : air) = middle;
            }
            return bone;
        }
        return std::numeric_limits<double>::infinity();
    }

    const BoneModel& bone_;
    Eigen::Array3d eye_;
    Eigen::Matrix3d R_VC_;
};

// The part of a triangle (C) that lies before the camera, as its corners in turn: none, three or four.
struct Corners {
    std::array<Eigen::Vector3d, 4> p_C;
    int count = 0;
};
Corners beforeCamera(const std::array<Eigen::Vector3d, 3>& triangle) {
    Corners corners;
    for (size_t n = 0; n < 3; ++n) {
        const Eigen::Vector3d &a = triangle[n], &b = triangle[(n + 1) % 3];
        const double over_a = -a.z() - kNearestDepth, over_b = -b.z() - kNearestDepth;
        if (over_a >= 0) corners.p_C[corners.count++] = a;
        if ((over_a >= 0) != (over_b >= 0))
            corners.p_C[corners.count++] = a + over_a / (over_a - over_b) * (b - a);
    }
    return corners;
}

// On the screen 1/depth is linear across a triangle.
void paintTriangle(const Screen& screen, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c, std::vector<float>& depths) {
    Eigen::Matrix<double, 3, 3> at;  // a column each: x and y on the screen, 1
    Eigen::RowVector3d inverse_depth;
    int n = 0;
    for (const Eigen::Vector3d* p : {&a, &b, &c}) {
        inverse_depth[n] = -1 / p->z();
        at.col(n++) = Eigen::Vector3d(-p->x() / p->z(), -p->y() / p->z(), 1);
    }
    const double area = at.determinant();
    if (std::abs(area) < 1e-18) return;  // seen from its edge
    const Eigen::Matrix3d share = at.inverse();
    const auto inside = [](double first, double size) {
        return int(std::clamp(std::ceil(first), 0.0, size));
    };
    const int left = inside(screen.column(at.row(0).minCoeff()), screen.width),
              top = inside(screen.row(at.row(1).maxCoeff()), screen.height);
    const double right = std::min(screen.column(at.row(0).maxCoeff()), screen.width - 1.0),
                 bottom = std::min(screen.row(at.row(1).minCoeff()), screen.height - 1.0);
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column) {
            const Eigen::Vector3d of = share * Eigen::Vector3d(screen.x(column), screen.y(row), 1);
            if (of.minCoeff() < -1e-9) continue;
            float& depth = depths[size_t(row) * size_t(screen.width) + size_t(column)];
            depth = std::min(depth, float(1 / inverse_depth.dot(of)));
        }
}

void paintTool(const TriangleSurface& surface, const Pose& X_CT, const Screen& screen,
               std::vector<float>& depths) {
    for (size_t n = 0; n + 2 < surface.indices.size(); n += 3) {
        std::array<Eigen::Vector3d, 3> p_C;
        for (size_t corner = 0; corner < 3; ++corner)
            p_C[corner] = X_CT * surface.positions[surface.indices[n + corner]].cast<double>();
        const Corners seen = beforeCamera(p_C);
        for (int last = 2; last < seen.count; ++last)
            paintTriangle(screen, seen.p_C[0], seen.p_C[last - 1], seen.p_C[last], depths);
    }
}

}  // namespace

std::vector<float> depthPicture(const SteppedRun& run, const DepthCamera& camera) {
    check(camera);
    const Pose X_WC{camera.X_WC.position, camera.X_WC.rotation.normalized()};
    const Screen screen(camera);
    std::vector<float> depths(size_t(camera.width) * size_t(camera.height), float(camera.far));
    if (run.ticks() > 0) {
        const auto& [p, q] = std::pair{run.record().p_WT, run.record().q_WT};
        const Pose X_WT{Eigen::Vector3d(p), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
        paintTool(run.setup().tools[run.record().tool].surface, X_WC.inverse() * X_WT, screen, depths);
    }
    const BoneRays rays(run.bone(), X_WC);
    auto depth = depths.begin();
    for (int row = 0; row < camera.height; ++row)
        for (int column = 0; column < camera.width; ++column, ++depth)
            *depth = float(rays.depth(screen.x(column), screen.y(row), *depth));
    return depths;
}

}  // namespace bonemill
