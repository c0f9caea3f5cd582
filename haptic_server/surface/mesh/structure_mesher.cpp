#include "haptic_server/surface/mesh/structure_mesher.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "haptic_server/core/volume/marching_cubes_table.h"

namespace bonemill {
namespace {

constexpr int64_t kMaxSamples = int64_t(1) << 25;  // of a structure's box; a larger one is looked at coarsely
constexpr float kMaxMoved = 0.5f;                  // voxels of the labels per axis, by smoothing
constexpr float kAround = 1.5f;                    // voxels of the labels, that count for how full it is
constexpr float kMaxOfFullness = 1.25f;            // the same, where the structure is thin
constexpr float kNearestToSample = 0.1f;
constexpr int kMaxStride = 16;          // voxels
constexpr float kMaxFiner = 3;          // labels in steps: what spreads farther takes too long
constexpr double kSamplesPerLabel = 2;  // per axis, of labels on coarser voxels: structures of one voxel stay
constexpr float kSimplified = 0.06f;    // voxels that the surface may move by fewer triangles
constexpr double kMaxThicker = 0.25;    // voxels of the labels, that give back what smoothing took
constexpr int kThickenings = 3;         // each leaves a small part of the error of the one before
// A pass shrinks by the first factor and grows by the second: what bends slower than 1/kShrink + 1/kGrow
// tells stays as it is.
constexpr int kPasses = 60;
constexpr float kShrink = 0.5f, kGrow = -0.508f;

struct Surface {
    std::vector<Eigen::Vector3f> positions;  // V, m
    std::vector<float> fullness;             // share of the box around each that is inside: flat 0.5
    std::vector<uint32_t> indices;
};

std::array<IndexBox, kMaxMaterials + 1> boxesOf(const BoneProperties& properties) {
    std::array<IndexBox, kMaxMaterials + 1> boxes;
    const BrickMap bricks(properties.dims());
    forEachIndex({Eigen::Vector3i::Zero(), bricks.bricksPerAxis().array() - 1},
                 [&](const Eigen::Vector3i& brick) {
                     const IndexBox voxels = bricks.voxelsOf(brick);
                     if (properties.placeOf(voxels.min) == BrickMap::kNowhere) return;
                     forEachIndex(voxels, [&](const Eigen::Vector3i& voxel) {
                         boxes[properties.material(voxel)].include(voxel);
                     });
                 });
    return boxes;
}

// Finds the surface between samples, each of a cube of voxels, of one material and all others.
class MaterialSurface {
  public:
    MaterialSurface(const BoneProperties& properties, MaterialId material, const IndexBox& box,
                    const Eigen::Vector3d& spacing, int least_stride, float label_edge)
        : stride_(strideOf(box, least_stride)),
          first_(box.min.array() - stride_),
          size_((box.max - box.min) / stride_ + Eigen::Vector3i::Constant(4)),
          step_((spacing * stride_).cast<float>()),
          grain_(step_.cwiseMax(label_edge)),
          around_((kAround * grain_.array() / step_.array()).cast<int>()),
          share_(size_t(size_.cast<int64_t>().prod())) {
        size_t at = 0;
        forEachIndex({Eigen::Vector3i::Zero(), size_.array() - 1}, [&](const Eigen::Vector3i& sample) {
            const Eigen::Vector3i low = first_ + stride_ * sample;
            int count = 0;
            forEachIndex({low, low.array() + (stride_ - 1)},
                         [&](const Eigen::Vector3i& v) { count += properties.material(v) == material; });
            share_[at++] = float(count) / float(stride_ * stride_ * stride_);
        });
    }

    const Eigen::Vector3f& step() const { return step_; }
    const Eigen::Vector3f& grain() const { return grain_; }  // the labels' voxels
    double volume() const {                                  // m3, of the labels
        return std::accumulate(share_.begin(), share_.end(), 0.0) * step_.cast<double>().prod();
    }

    Surface make() {
        forEachIndex({Eigen::Vector3i::Zero(), size_.array() - 2}, [&](const Eigen::Vector3i& cell) {
            int config = 0;
            const size_t low = indexOf(cell);
            for (int corner = 0; corner < 8; ++corner)
                config |= int(isInside(low + cornerOffset(corner))) << corner;
            if (config == 0 || config == 255) return;
            const CubeTriangles& triangles = cubeTriangles()[size_t(config)];
            for (int t = 0; t < triangles.count; ++t)
                for (const uint8_t edge : triangles.edges[size_t(t)])
                    surface_.indices.push_back(vertexOn(cell, kCubeEdges[edge]));
        });
        return std::move(surface_);
    }

  private:
    static int strideOf(const IndexBox& box, int least) {
        int stride = least;
        while (box.count() / (int64_t(stride) * stride * stride) > kMaxSamples) ++stride;
        return stride;
    }
    bool isInside(size_t sample) const { return share_[sample] > 0.5f; }
    size_t indexOf(const Eigen::Vector3i& at) const { return placeIn(size_, at); }
    size_t cornerOffset(int corner) const { return indexOf({corner & 1, corner >> 1 & 1, corner >> 2 & 1}); }
    uint32_t vertexOn(const Eigen::Vector3i& cell, const CubeEdge& edge) {
        const size_t place = indexOf(cell) + cornerOffset(edge.low_corner);
        const auto [found, is_new] =
            vertex_of_edge_.try_emplace(3 * place + edge.axis, uint32_t(surface_.positions.size()));
        if (is_new) {
            const int c = edge.low_corner;
            Eigen::Vector3f sample = (cell + Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1)).cast<float>();
            const float low = share_[place], high = share_[place + cornerOffset(1 << edge.axis)];
            sample[edge.axis] +=
                std::clamp((0.5f - low) / (high - low), kNearestToSample, 1 - kNearestToSample);
            // The samples are in the middle of their voxels.
            const Eigen::Vector3f origin = (first_.cast<float>().array() + 0.5f * float(stride_ - 1))
                                               .matrix()
                                               .cwiseProduct(step_ / float(stride_));
            surface_.positions.push_back(origin + sample.cwiseProduct(step_));
            surface_.fullness.push_back(
                fullnessAt(cell + Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2 & 1), edge.axis));
        }
        return found->second;
    }

    // Of the edge that begins at this sample. On voxels of their own labels move as on a flat side.
    float fullnessAt(const Eigen::Vector3i& sample, int axis) const {
        if (around_.maxCoeff() <= 1) return 0.5f;
        IndexBox box{sample - around_, sample + around_};
        box.min[axis] += 1;
        int count = 0;
        forEachIndex(box.clamped(Eigen::Vector3i::Zero(), size_.array() - 1),
                     [&](const Eigen::Vector3i& at) { count += isInside(indexOf(at)); });
        return float(count) / float(box.count());
    }

    int stride_;
    Eigen::Vector3i first_, size_;
    Eigen::Vector3f step_, grain_;
    Eigen::Vector3i around_;
    std::vector<float> share_;  // of each sample's voxels that are of the material
    std::unordered_map<size_t, uint32_t> vertex_of_edge_;
    Surface surface_;
};

// Each vertex has its neighbours in a row of `neighbours`, one per triangle: the surface is closed.
struct Neighbours {
    std::vector<uint32_t> first, neighbours;

    explicit Neighbours(const Surface& surface) : first(surface.positions.size() + 1, 0) {
        for (const uint32_t index : surface.indices) ++first[index + 1];
        for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
        neighbours.resize(surface.indices.size());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (size_t t = 0; t < surface.indices.size(); t += 3)
            for (size_t corner = 0; corner < 3; ++corner)
                neighbours[next[surface.indices[t + corner]]++] = surface.indices[t + (corner + 1) % 3];
    }
};

// The labels' voxels are `grain`, and the triangles as long as `step`. Thin parts move less: what is as thin
// as a label would become a line.
void smooth(Surface& surface, const Eigen::Vector3f& step, const Eigen::Vector3f& grain) {
    const Neighbours around(surface);
    const std::vector<Eigen::Vector3f> start = surface.positions;
    std::vector<Eigen::Vector3f> moved(start.size());
    const float finer = std::min(kMaxFiner, (grain.array() / step.array()).maxCoeff());
    const int passes = int(std::lround(kPasses * finer * finer));  // what spreads takes so long
    for (int pass = 0; pass < 2 * passes; ++pass) {
        const float factor = pass % 2 == 0 ? kShrink : kGrow;
        for (size_t v = 0; v < start.size(); ++v) {
            Eigen::Vector3f sum = Eigen::Vector3f::Zero();
            for (uint32_t n = around.first[v]; n < around.first[v + 1]; ++n)
                sum += surface.positions[around.neighbours[n]];
            const Eigen::Vector3f& p = surface.positions[v];
            const Eigen::Vector3f middle = sum / float(around.first[v + 1] - around.first[v]);
            const Eigen::Array3f away = (p + factor * (middle - p) - start[v]).array();
            const Eigen::Array3f most =
                std::min(kMaxMoved, kMaxOfFullness * surface.fullness[v]) * grain.array();
            moved[v] = start[v] + away.max(-most).min(most).matrix();
        }
        surface.positions.swap(moved);
    }
}

std::vector<Eigen::Vector3f> normalsOf(const Surface& surface) {
    std::vector<Eigen::Vector3f> normals(surface.positions.size(), Eigen::Vector3f::Zero());
    for (size_t t = 0; t < surface.indices.size(); t += 3) {
        const uint32_t* corner = &surface.indices[t];
        const Eigen::Vector3f& a = surface.positions[corner[0]];
        const Eigen::Vector3f area =
            (surface.positions[corner[1]] - a).cross(surface.positions[corner[2]] - a);
        for (int i = 0; i < 3; ++i) normals[corner[i]] += area;
    }
    for (Eigen::Vector3f& normal : normals)
        normal = normal.squaredNorm() > 0 ? normal.normalized() : Eigen::Vector3f::UnitZ();
    return normals;
}

void simplify(Surface& surface, float most_moved) {
    const auto reduce = [&surface](size_t triangles, float error) {
        std::vector<uint32_t> fewer(surface.indices.size());
        fewer.resize(meshopt_simplify(fewer.data(), surface.indices.data(), surface.indices.size(),
                                      surface.positions[0].data(), surface.positions.size(),
                                      sizeof(Eigen::Vector3f), 3 * triangles, error));
        if (!fewer.empty()) surface.indices = std::move(fewer);
    };
    const float scale =
        meshopt_simplifyScale(surface.positions[0].data(), surface.positions.size(), sizeof(Eigen::Vector3f));
    reduce(0, most_moved / scale);
    if (surface.indices.size() > 3 * kMaxStructureTriangles) reduce(kMaxStructureTriangles, 1);
}

struct Extent {
    double volume = 0, area = 0;
};

Extent extentOf(const Surface& surface) {
    Extent extent;
    const Eigen::Vector3d origin = surface.positions[surface.indices[0]].cast<double>();
    for (size_t t = 0; t < surface.indices.size(); t += 3) {
        std::array<Eigen::Vector3d, 3> corner;
        for (size_t i = 0; i < 3; ++i)
            corner[i] = surface.positions[surface.indices[t + i]].cast<double>() - origin;
        extent.volume += corner[0].dot(corner[1].cross(corner[2])) / 6;
        extent.area += (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm() / 2;
    }
    return extent;
}

// Where the surface bends, smoothing and flat triangles take from the inside, in total several percent of a
// nerve: the surface moves outwards until it holds the labels' volume (m3) again.
void thicken(Surface& surface, const std::vector<Eigen::Vector3f>& normals, double volume, double grain) {
    double moved = 0;
    for (int pass = 0; pass < kThickenings; ++pass) {
        const Extent extent = extentOf(surface);
        if (!(extent.area > 0)) return;
        const double next = std::clamp(moved + (volume - extent.volume) / extent.area, -kMaxThicker * grain,
                                       kMaxThicker * grain);
        for (size_t v = 0; v < normals.size(); ++v) surface.positions[v] += float(next - moved) * normals[v];
        moved = next;
    }
}

NodeMesh packed(MaterialId material, const Surface& surface, const std::vector<Eigen::Vector3f>& normals) {
    constexpr float kSteps = 65535;
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : surface.positions) box.extend(p);
    NodeMesh mesh;
    mesh.leaf = material;
    mesh.revision = 1;
    mesh.origin = box.min();
    mesh.step.setConstant(box.sizes().maxCoeff() / kSteps);
    mesh.indices = surface.indices;
    for (size_t v = 0; v < surface.positions.size(); ++v) {
        const Eigen::Array3f at = (surface.positions[v] - mesh.origin).array() / mesh.step.array();
        const Eigen::Array3i steps = (at + 0.5f).max(0.0f).min(kSteps).cast<int>();
        const OctahedralNormal normal = encodeNormal(normals[v]);
        mesh.vertices.push_back(
            {uint16_t(steps.x()), uint16_t(steps.y()), uint16_t(steps.z()), normal.u, normal.v});
    }
    return mesh;
}

}  // namespace

std::vector<NodeMesh> meshStructures(const BoneProperties& properties, const MaterialTable& materials,
                                     const Eigen::Vector3d& spacing, double label_edge, const Pose& X_VP) {
    // Labels that are much coarser are looked at as if they were not.
    label_edge = std::min(label_edge, kSamplesPerLabel * kMaxStride * spacing.maxCoeff());
    const int stride = std::max(1, int(std::lround(label_edge / (kSamplesPerLabel * spacing.maxCoeff()))));
    const auto boxes = boxesOf(properties);
    std::vector<NodeMesh> meshes;
    for (size_t id = 1; id < materials.size(); ++id) {
        if (!materials[id].is_protected || boxes[id].isEmpty()) continue;
        MaterialSurface samples(properties, MaterialId(id), boxes[id], spacing, stride, float(label_edge));
        Surface surface = samples.make();
        if (surface.indices.empty()) continue;
        smooth(surface, samples.step(), samples.grain());
        for (Eigen::Vector3f& p : surface.positions) p = (X_VP * p.cast<double>().eval()).cast<float>();
        const std::vector<Eigen::Vector3f> normals = normalsOf(surface);
        simplify(surface, kSimplified * samples.step().minCoeff());
        thicken(surface, normals, samples.volume(), samples.grain().minCoeff());
        meshes.push_back(packed(MaterialId(id), surface, normals));
    }
    return meshes;
}

}  // namespace bonemill
