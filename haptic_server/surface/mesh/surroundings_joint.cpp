#include "haptic_server/surface/mesh/surroundings_joint.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "haptic_server/surface/mesh/smooth_gradient.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr double kLeastWidth = 0.5;  // of the joint, in cells of the scan
constexpr int kLeastPlanes = 4;      // per axis: the two outermost ones, and one for each face of the region

struct Node {
    Vector3i voxel;  // of the rim (V) or of the scan (S)
    bool is_rim;

    auto key() const { return std::array<int, 4>{is_rim, voxel.x(), voxel.y(), voxel.z()}; }
    bool operator==(const Node& other) const { return key() == other.key(); }
};

// These are the corners of a face of a cell, counter-clockwise as seen from outside: (0 or 1) per axis.
std::array<Vector3i, 4> faceCorners(int axis, int side) {
    const Vector3i base = side * Vector3i::Unit(axis), u = Vector3i::Unit((axis + 1) % 3),
                   v = Vector3i::Unit((axis + 2) % 3);
    if (side == 1) return {base, base + u, base + u + v, base + v};
    return {base, base + v, base + u + v, base + u};
}

template <class DensityAt>
Vector3f gradientAt(const Vector3i& voxel, const IndexBox& readable, const Vector3d& spacing,
                    DensityAt&& density_at) {
    if (!readable.contains(voxel)) return Vector3f::Zero();
    constexpr size_t kStride[] = {1, 3, 9};
    std::array<Density, 27> around{};
    size_t n = 0;
    forEachIndex(IndexBox{voxel, voxel}.grown(1),
                 [&](const Vector3i& v) { around[n++] = readable.contains(v) ? density_at(v) : Density(0); });
    return smoothGradient(voxel, readable, spacing.cwiseInverse().cast<float>(), &around[13], kStride);
}

}  // namespace

// One part in the making.
class JointPart {
  public:
    JointPart(const SurroundingsJoint& joint, const IndexBox& cells)
        : joint_(joint), scan_(joint.surroundings_.volume), rim_(joint.surroundings_.rim) {
        Vector3d low;
        for (int axis = 0; axis < 3; ++axis)
            low[axis] = joint.planes_[size_t(axis)].low[size_t(cells.min[axis] - joint.cells_.min[axis])];
        first_step_ = joint.grid_.stepsAt(low).array() - 1;
        joint.grid_.begin(mesh_, first_step_);
        forEachIndex(cells, [this](const Vector3i& cell) { addCell(cell); });
    }
    NodeMesh take() { return std::move(mesh_); }

  private:
    using Ring = std::vector<Node>;

    // Planes count from the lowest one on. The outermost ones are the scan's.
    int last(int axis) const { return int(joint_.planes_[size_t(axis)].rim.size()) - 1; }
    Node nodeAt(const Vector3i& corner) const {
        const Vector3i plane = corner - joint_.cells_.min;
        Vector3i voxel;
        for (int axis = 0; axis < 3; ++axis) {
            if (plane[axis] == 0 || plane[axis] == last(axis)) return {corner, false};
            voxel[axis] = joint_.planes_[size_t(axis)].rim[size_t(plane[axis])];
        }
        return {voxel, true};
    }

    IndexBox readableScan() const { return {Vector3i::Constant(-1), scan_.dims()}; }
    Density densityOf(const Node& node) const {
        if (node.is_rim) return rim_.at(node.voxel);
        if (!readableScan().contains(node.voxel)) return 0;
        return scan_.at(node.voxel.x(), node.voxel.y(), node.voxel.z());
    }
    bool isBone(const Node& node) const { return densityOf(node) >= scan_.iso(); }
    Vector3f gradientOf(const Node& node) const {
        if (node.is_rim)
            return gradientAt(node.voxel, rim_.readable(), rim_.spacing(),
                              [this](const Vector3i& v) { return rim_.at(v); });
        return gradientAt(node.voxel, readableScan(), scan_.spacing(),
                          [this](const Vector3i& v) { return scan_.at(v.x(), v.y(), v.z()); });
    }
    Vector3d placeOf(const Node& node) const {  // V
        const Vector3d voxel = node.voxel.cast<double>();
        if (node.is_rim) return rim_.spacing().cwiseProduct(voxel);
        return joint_.surroundings_.X_VS.position + scan_.spacing().cwiseProduct(voxel);
    }

    void addCell(const Vector3i& cell) {
        const Vector3i plane = cell - joint_.cells_.min;
        bool is_joint = false;
        for (int axis = 0; axis < 3; ++axis) is_joint |= plane[axis] == 0 || plane[axis] + 1 == last(axis);
        if (!is_joint) return;  // of the region
        next_.clear();
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) addFace(cell, axis, side);
        fillLoops();
    }

    void addFace(const Vector3i& cell, int axis, int side) {
        std::array<Node, 4> corners;
        bool is_on_rim = true;
        const std::array<Vector3i, 4> at = faceCorners(axis, side);
        for (size_t n = 0; n < 4; ++n) {
            corners[n] = nodeAt(cell + at[n]);
            is_on_rim &= corners[n].is_rim;
        }
        if (is_on_rim) return addSquares(corners, axis, side);
        Ring ring;
        for (size_t n = 0; n < 4; ++n) addEdge(corners[n], corners[(n + 1) % 4], ring);
        addSegments(ring);
    }

    // All of the edge but its end: there are more nodes on one of the rim.
    static void addEdge(const Node& from, const Node& to, Ring& ring) {
        ring.push_back(from);
        if (!from.is_rim || !to.is_rim) return;
        const Vector3i way = to.voxel - from.voxel, step = way.cwiseSign();
        for (int n = 1; n < way.cwiseAbs().maxCoeff(); ++n) ring.push_back({from.voxel + n * step, true});
    }

    void addSquares(const std::array<Node, 4>& corners, int axis, int side) {
        IndexBox squares;
        for (const Node& corner : corners) squares.include(corner.voxel);
        for (const int across : {(axis + 1) % 3, (axis + 2) % 3}) --squares.max[across];
        const std::array<Vector3i, 4> at = faceCorners(axis, side);
        forEachIndex(squares, [&](const Vector3i& low) {
            Ring ring;
            for (const Vector3i& corner : at)
                ring.push_back({low + corner - side * Vector3i::Unit(axis), true});
            addSegments(ring);
        });
    }

    // Each run of bone is cut off by itself, as in marching_cubes_table.cpp.
    void addSegments(const Ring& ring) {
        const size_t count = ring.size();
        for (size_t n = 0; n < count; ++n) {
            if (isBone(ring[n]) || !isBone(ring[(n + 1) % count])) continue;
            size_t end = (n + 1) % count;
            while (isBone(ring[(end + 1) % count])) end = (end + 1) % count;
            next_[vertexBetween(ring[n], ring[(n + 1) % count])] =
                vertexBetween(ring[end], ring[(end + 1) % count]);
        }
    }

    void fillLoops() {
        while (!next_.empty()) {
            std::vector<uint32_t> loop;
            for (auto at = next_.begin(); at != next_.end(); at = next_.find(loop.back())) {
                if (loop.empty()) loop.push_back(at->first);
                loop.push_back(at->second);
                next_.erase(at);
            }
            loop.pop_back();  // it is the first one again
            if (loop.size() > 2) fill(loop);
        }
    }

    // From its middle: a diagonal could lie in a face, where another cell's may lie, too.
    void fill(const std::vector<uint32_t>& loop) {
        if (loop.size() == 3) {
            mesh_.indices.insert(mesh_.indices.end(), loop.begin(), loop.end());
            return;
        }
        Vector3d middle = Vector3d::Zero();
        Vector3f normal = Vector3f::Zero();
        for (const uint32_t vertex : loop) {
            middle += places_[vertex] / double(loop.size());
            normal += normals_[vertex];
        }
        if (normal.norm() < 0.5f) normal = areaOf(loop, middle).cast<float>();
        const uint32_t apex = addVertex(middle, normal);
        for (size_t n = 0; n < loop.size(); ++n)
            for (const uint32_t corner : {apex, loop[n], loop[(n + 1) % loop.size()]})
                mesh_.indices.push_back(corner);
    }
    Vector3d areaOf(const std::vector<uint32_t>& loop, const Vector3d& middle) const {
        Vector3d area = Vector3d::Zero();
        for (size_t n = 0; n < loop.size(); ++n)
            area += (places_[loop[n]] - middle).cross(places_[loop[(n + 1) % loop.size()]] - middle);
        return area;
    }

    uint32_t vertexBetween(const Node& a, const Node& b) {
        const bool is_in_order = a.key() < b.key();
        const Node &low = is_in_order ? a : b, &high = is_in_order ? b : a;
        const auto [found, is_new] = vertices_.try_emplace({low.key(), high.key()}, 0);
        if (is_new) found->second = vertexOn(low, high);
        return found->second;
    }

    uint32_t vertexOn(const Node& low, const Node& high) {
        const Density at_low = densityOf(low), at_high = densityOf(high);
        const int steps = stepsToIso(at_low, at_high, scan_.iso(), RimGrid::kStepsPerCell);
        const float share = float(steps) / RimGrid::kStepsPerCell;
        const Vector3f gradient = gradientOf(low) * (1 - share) + gradientOf(high) * share;
        const Vector3d from = placeOf(low), way = placeOf(high) - from;
        const Vector3f way_out = (at_low > at_high ? way : Vector3d(-way)).cast<float>();
        const bool is_of_scan = !low.is_rim && !high.is_rim;
        const Vector3d place = is_of_scan ? joint_.grid_.placeInScan(RimGrid::kStepsPerCell * low.voxel +
                                                                     steps * (high.voxel - low.voxel))
                                          : Vector3d(from + double(share) * way);
        return addVertex(place, gradient.isZero(0) ? way_out : Vector3f(-gradient));
    }

    uint32_t addVertex(const Vector3d& place, const Vector3f& normal) {
        const Vector3i steps = joint_.grid_.stepsAt(place) - first_step_;
        const OctahedralNormal packed = encodeNormal(normal);
        mesh_.vertices.push_back(
            {uint16_t(steps.x()), uint16_t(steps.y()), uint16_t(steps.z()), packed.u, packed.v});
        places_.push_back(place);
        normals_.push_back(normal.normalized());
        if (joint_.shade_) {
            const Vector3f p_S = (place - joint_.surroundings_.X_VS.position).cast<float>();
            mesh_.materials.push_back(joint_.shade_->under(p_S, normal));
        }
        return uint32_t(mesh_.vertices.size() - 1);
    }

    const SurroundingsJoint& joint_;
    const VoxelVolume& scan_;
    const RegionRim& rim_;
    Vector3i first_step_;
    NodeMesh mesh_;
    std::vector<Vector3d> places_;                                                    // per vertex; V, m
    std::vector<Vector3f> normals_;                                                   // per vertex; V, unit
    std::map<std::pair<std::array<int, 4>, std::array<int, 4>>, uint32_t> vertices_;  // by their edges
    std::map<uint32_t, uint32_t> next_;  // segments of the cell in hand, by the vertex where they begin
};

SurroundingsJoint::SurroundingsJoint(const Surroundings& surroundings, ScanShade* shade)
    : surroundings_(surroundings), grid_(surroundings), shade_(shade) {
    const RegionRim& rim = surroundings.rim;
    const IndexBox faces = rim.region().grown(1);
    for (int axis = 0; axis < 3; ++axis) {
        const double fine = rim.spacing()[axis], coarse = surroundings.volume.spacing()[axis],
                     at = surroundings.X_VS.position[axis];
        const auto placeInScan = [&](int voxel) { return (fine * voxel - at) / coarse; };
        const int low = int(std::floor(placeInScan(faces.min[axis]) - kLeastWidth));
        const int high =
            std::max(int(std::ceil(placeInScan(faces.max[axis]) + kLeastWidth)), low + kLeastPlanes - 1);
        cells_.min[axis] = low;
        cells_.max[axis] = high - 1;
        Planes& planes = planes_[size_t(axis)];
        for (int plane = low; plane <= high; ++plane) {
            const double place = at + coarse * plane;
            int on_rim = std::clamp(int(std::lround(place / fine)), faces.min[axis], faces.max[axis]);
            if (plane <= low + 1) on_rim = faces.min[axis];
            if (plane >= high - 1) on_rim = faces.max[axis];
            planes.rim.push_back(on_rim);
            planes.low.push_back(std::min(place, fine * on_rim));
        }
    }
    parts_ = (cells_.max - cells_.min).array() / grid_.partCells() + 1;
}

NodeMesh SurroundingsJoint::mesh(uint32_t part) const {
    const int n = int(part);
    const Vector3i index(n % parts_.x(), n / parts_.x() % parts_.y(), n / (parts_.x() * parts_.y()));
    const Vector3i first = cells_.min + grid_.partCells() * index;
    const IndexBox cells =
        IndexBox{first, first.array() + grid_.partCells() - 1}.clamped(cells_.min, cells_.max);
    return JointPart(*this, cells).take();
}

}  // namespace bonemill
