#include "haptic_server/surface/mesh/leaf_mesher.h"

#include <algorithm>

#include "haptic_server/surface/mesh/smooth_gradient.h"

namespace bonemill {

static_assert(kMaxMaterials == kMaxVertexMaterials);
namespace {

constexpr uint32_t kNoVertex = UINT32_MAX;
// So much denser than the iso-value the scan was where milling opened it: more than a vertex's place is
// rounded by.
constexpr float kWasInside = kMaxDensity / 128.0f;
static_assert(kMaxMaterials < kMilledBit);

}  // namespace

LeafMesher::LeafMesher(const VoxelVolume& volume, const LeafLattice& lattice, int most_steps_per_cell,
                       const VertexLook& look, const RegionRim* rim)
    : volume_(volume),
      lattice_(lattice),
      look_(look),
      rim_(rim),
      readable_(rim ? rim->readable() : IndexBox{Eigen::Vector3i::Constant(-1), volume.dims()}),
      grid_(volume, lattice, most_steps_per_cell),
      triangles_(cubeTriangles()),
      crossed_(lattice.leafCells()),
      inverse_spacing_(volume.spacing().cwiseInverse().cast<float>()) {}

std::optional<NodeMesh> LeafMesher::mesh(LeafId leaf) {
    NodeMesh mesh;
    mesh.leaf = leaf;
    mesh.revision = lattice_.version(leaf);
    mesh.origin = grid_.leafOrigin(leaf);
    mesh.step = grid_.step();
    vertices_.clear();
    indices_.clear();
    materials_.clear();
    const bool is_being_written = (mesh.revision & 1) != 0;
    if (is_being_written) return std::nullopt;
    readVoxels(lattice_.cellsOf(leaf));
    // The voxels were read with acquire, so this read cannot be older than they are.
    if (lattice_.version(leaf) != mesh.revision) return std::nullopt;
    meshCells();
    mesh.vertices = vertices_;  // exactly as much memory as they need
    mesh.indices = indices_;
    const auto has_material = [](MaterialId material) { return material != kNoMaterial; };
    if (std::ranges::any_of(materials_, has_material)) mesh.materials = materials_;
    return mesh;
}

// Copies all voxels that the mesh depends on: those around the cells, and one more on each side for
// the gradients.
void LeafMesher::readVoxels(const IndexBox& cells) {
    first_voxel_ = cells.min;
    cells_ = cells.max - cells.min + Eigen::Vector3i::Ones();
    stride_[1] = size_t(cells_.x()) + 3;
    stride_[2] = stride_[1] * (size_t(cells_.y()) + 3);
    density_.resize(stride_[2] * (size_t(cells_.z()) + 3) + kCellLanes);
    const IndexBox around{cells.min.array() - 1, cells.max.array() + 2};
    const IndexBox voxels = around.clamped(Eigen::Vector3i::Constant(-1), volume_.dims());
    volume_.forEachPart(voxels, [&](const IndexBox& part, size_t from) {
        const Eigen::Vector3i size = part.max - part.min + Eigen::Vector3i::Ones();
        Density* to = density_.data() + cornerIndex(part.min - first_voxel_);
        for (int k = 0; k < size.z(); ++k)
            for (int j = 0; j < size.y(); ++j) {
                const size_t row =
                    from + VoxelVolume::kStrideY * size_t(j) + VoxelVolume::kStrideZ * size_t(k);
                Density* out = to + stride_[1] * size_t(j) + stride_[2] * size_t(k);
                for (int i = 0; i < size.x(); ++i) out[i] = volume_.at(row + size_t(i));
            }
    });
    if (rim_) readRim(around.clamped(readable_.min, readable_.max));
}

void LeafMesher::readRim(const IndexBox& voxels) {
    const IndexBox inner{Eigen::Vector3i::Zero(), volume_.dims().array() - 1};
    if (inner.contains(voxels.min) && inner.contains(voxels.max)) return;
    forEachIndex(voxels, [&](const Eigen::Vector3i& v) {
        if (!inner.contains(v)) density_[cornerIndex(v - first_voxel_)] = rim_->at(v);
    });
}

// Are there voxels on both sides of iso among the cells' corners?
bool LeafMesher::hasSurface() const noexcept {
    Density low = kMaxDensity, high = 0;
    for (int k = 0; k <= cells_.z(); ++k)
        kernels().range_of_rows(density_.data() + cornerIndex({0, 0, k}), cells_.x() + 1, stride_[1],
                                cells_.y() + 1, low, high);
    return low < volume_.iso() && high >= volume_.iso();
}

void LeafMesher::meshCells() {
    if (!hasSurface()) return;
    edge_vertex_.assign(3 * density_.size(), kNoVertex);
    crossed_.find(
        cells_,
        [&](int k, size_t row_size, uint8_t* sides) {
            kernels().cell_sides({density_.data() + cornerIndex({0, 0, k}), stride_[1], stride_[2]},
                                 cells_.x() + 1, cells_.y(), volume_.iso(), row_size, sides);
        },
        [&](int i, int j, int k, int inside) {
            emitCell(inside, {i, j, k});
        });
}

void LeafMesher::emitCell(int config, const Eigen::Vector3i& cell) {
    if (left_out_.contains(first_voxel_ + cell)) return;
    const CubeTriangles& triangles = triangles_[size_t(config)];
    for (int t = 0; t < triangles.count; ++t)
        for (const uint8_t edge : triangles.edges[size_t(t)]) {
            const CubeEdge e = kCubeEdges[edge];
            const Eigen::Vector3i low(e.low_corner & 1, e.low_corner >> 1 & 1, e.low_corner >> 2 & 1);
            indices_.push_back(vertexOnEdge(cell + low, e.axis));
        }
}

uint32_t LeafMesher::vertexOnEdge(const Eigen::Vector3i& local, int axis) {
    uint32_t& vertex = edge_vertex_[3 * cornerIndex(local) + size_t(axis)];
    if (vertex == kNoVertex) {
        vertex = uint32_t(vertices_.size());
        addVertex(local, axis);
    }
    return vertex;
}

void LeafMesher::addVertex(const Eigen::Vector3i& local, int axis) {
    const size_t low = cornerIndex(local);
    const size_t high = low + stride_[axis];
    const int steps = stepsToIso(density_[low], density_[high], volume_.iso(), grid_.stepsPerCell());
    Eigen::Vector3i position = local * grid_.stepsPerCell();
    position[axis] += steps;

    const Eigen::Vector3i voxel = first_voxel_ + local;
    const Eigen::Vector3i next = voxel + Eigen::Vector3i::Unit(axis);
    const float fraction = float(steps) / float(grid_.stepsPerCell());
    const auto gradientAt = [&](const Eigen::Vector3i& at, size_t corner) {
        return smoothGradient(at, readable_, inverse_spacing_, density_.data() + corner, stride_);
    };
    const Eigen::Vector3f gradient =
        gradientAt(voxel, low) * (1 - fraction) + gradientAt(next, high) * fraction;
    // A one-voxel plate or grain has no gradient: the way out of the bone along the edge is a normal too.
    const float way_out = density_[low] > density_[high] ? 1.0f : -1.0f;
    const Eigen::Vector3f normal = gradient.isZero(0) ? Eigen::Vector3f(way_out * Eigen::Vector3f::Unit(axis))
                                                      : Eigen::Vector3f(-gradient);
    const OctahedralNormal packed = encodeNormal(normal);  // of any length
    vertices_.push_back(
        {uint16_t(position.x()), uint16_t(position.y()), uint16_t(position.z()), packed.u, packed.v});
    if (look_.properties || look_.shade || look_.scanned || paint_)
        materials_.push_back(shownAt(density_[low] >= volume_.iso(), voxel, axis, low, normal, fraction));
}

uint8_t LeafMesher::shownAt(bool is_low_inside, const Eigen::Vector3i& low_voxel, int axis, size_t low,
                            const Eigen::Vector3f& normal, float fraction) const {
    const Eigen::Vector3i high_voxel = low_voxel + Eigen::Vector3i::Unit(axis);
    // The rim's bone is of the zone and material of the voxel beside it.
    const Eigen::Vector3i inside =
        (is_low_inside ? low_voxel : high_voxel).array().max(0).min(volume_.dims().array() - 1);
    if (paint_)
        if (const uint8_t shown = paint_->between(inside, is_low_inside ? high_voxel : low_voxel))
            return shown;
    const MaterialId material = look_.properties
                                    ? materialUnder(inside, is_low_inside ? low : low + stride_[axis], normal)
                                    : kNoMaterial;
    const Eigen::Vector3i& outside = is_low_inside ? high_voxel : low_voxel;
    const bool is_whole = isLaidOpen(material, inside, outside, is_low_inside ? low : low + stride_[axis]);
    const uint8_t milled =
        look_.scanned && !is_whole ? milledBit(low_voxel, axis, low, fraction) : uint8_t(0);
    if (!look_.shade || (look_.properties && !look_.shade->scale().stands_for[material]))
        return material | milled;
    const Eigen::Vector3f place = low_voxel.cast<float>() + fraction * Eigen::Vector3f::Unit(axis);
    return look_.shade->under(place.cwiseQuotient(inverse_spacing_), normal) | milled;
}

// Bone was taken off a protected structure, of which itself nothing is gone here.
bool LeafMesher::isLaidOpen(MaterialId material, const Eigen::Vector3i& inside,
                            const Eigen::Vector3i& outside, size_t inside_corner) const noexcept {
    if (!look_.materials || !look_.properties || !look_.scanned) return false;
    if (material >= look_.materials->size() || !(*look_.materials)[material].is_protected) return false;
    if (look_.properties->material(inside) != material) return true;  // it still has bone over it
    return look_.properties->material(outside) != material &&
           density_[inside_corner] == look_.scanned->at(inside.x(), inside.y(), inside.z());
}

// The edge alone decides it, so that leaves agree. What lies beyond the volume never changes.
uint8_t LeafMesher::milledBit(const Eigen::Vector3i& low_voxel, int axis, size_t low,
                              float fraction) const noexcept {
    const IndexBox inner{Eigen::Vector3i::Zero(), volume_.dims().array() - 1};
    const auto scannedAt = [&](const Eigen::Vector3i& v, size_t corner) {
        return inner.contains(v) ? look_.scanned->at(v.x(), v.y(), v.z()) : density_[corner];
    };
    const size_t high = low + stride_[axis];
    const Density was_low = scannedAt(low_voxel, low);
    const Density was_high = scannedAt(low_voxel + Eigen::Vector3i::Unit(axis), high);
    if (was_low == density_[low] && was_high == density_[high]) return 0;
    const float was = float(was_low) + fraction * (float(was_high) - float(was_low));
    return was > float(volume_.iso()) + kWasInside ? kMilledBit : uint8_t(0);
}

// The voxels around the edge alone decide it, so that leaves agree. Outside the volume the original
// density is 0.
MaterialId LeafMesher::materialUnder(const Eigen::Vector3i& inside, size_t corner,
                                     const Eigen::Vector3f& normal) const noexcept {
    const Eigen::Vector3f inwards = -normal.cwiseProduct(inverse_spacing_).normalized();
    const Eigen::Vector3i step = inwards.array().round().cast<int>();
    const Eigen::Vector3i below = inside + step;
    const size_t below_corner = size_t(ptrdiff_t(corner) + step.x() + step.y() * ptrdiff_t(stride_[1]) +
                                       step.z() * ptrdiff_t(stride_[2]));
    const bool is_denser_below = density_[below_corner] >= volume_.iso() &&
                                 look_.properties->original(below) > look_.properties->original(inside);
    return look_.properties->material(is_denser_below ? below : inside);
}

}  // namespace bonemill
