// This makes the iso-surface of one octree leaf by marching cubes over the leaf's cells, with vertices on the
// grid edges.
//
// A vertex lies where the density, interpolated linearly along its edge, equals the iso-value, rounded to the
// steps of MeshGrid and kept one step away from both voxels, so that vertices of different edges never
// coincide. Its normal is minus the density's smoothed gradient (smooth_gradient.h), interpolated by the same
// fraction. Position and normal depend only on the voxels around the edge, in integer or IEEE single
// arithmetic: the leaves that share an edge get the same vertex, bit for bit. A voxel is inside the bone when
// its density >= iso.
//
// With `properties` a vertex also says what the bone under it is made of: as the inside voxel of its edge, or
// as the next one below the surface if that is bone, too, and was denser: a voxel that bone fills only partly
// looks like something less dense. A paint takes its place where it has something to show (vertex_paint.h).
// With `scanned` it says, where no paint has something to show, whether milling opened the bone there.
//
// Beyond the volume there is air, or, with a `rim`, the bone around it, which is shown as far as the first
// layer of it: what the tick took away at a face leaves a wall there, and the surface ends where
// SurroundingsJoint goes on, at the same vertices whatever the tick does.
//
// It is not RT-safe (it allocates).
#pragma once

#include <optional>
#include <vector>

#include "haptic_server/core/volume/bone_properties.h"
#include "haptic_server/core/volume/crossed_cells.h"
#include "haptic_server/core/volume/marching_cubes_table.h"
#include "haptic_server/core/volume/region_rim.h"
#include "haptic_server/surface/mesh/mesh_grid.h"
#include "haptic_server/surface/mesh/scan_shade.h"
#include "haptic_server/surface/mesh/vertex_paint.h"

namespace bonemill {

// What vertices show; without any of it they have no material. All must outlive who uses them.
struct VertexLook {
    const BoneProperties* properties = nullptr;
    ScanShade* shade = nullptr;                // of what bone was where no material says it
    const VoxelVolume* scanned = nullptr;      // the bone as it was; never changes
    const MaterialTable* materials = nullptr;  // which of them are protected: laid open is not cut
};

// It meshes one leaf after another with reused memory, for one thread at a time. Volume and lattice
// must outlive it.
class LeafMesher {
  public:
    // most_steps_per_cell is as for MeshGrid. The rim (null: none) must outlive this object.
    LeafMesher(const VoxelVolume& volume, const LeafLattice& lattice,
               int most_steps_per_cell = MeshGrid::kMaxStepsPerCell, const VertexLook& look = {},
               const RegionRim* rim = nullptr);

    // From now on vertices show this; null: none. It must outlive this object.
    void setPaint(const VertexPaint* paint) noexcept { paint_ = paint; }

    // From now on these cells make no surface.
    void leaveOut(const IndexBox& cells) noexcept { left_out_ = cells; }

    // The revision is the leaf's version; the mesh is empty without surface. There is none if the voxels were
    // written while they were copied, which is the shorter part of the work.
    std::optional<NodeMesh> mesh(LeafId leaf);

  private:
    void readVoxels(const IndexBox& cells);
    void readRim(const IndexBox& voxels);
    bool hasSurface() const noexcept;
    void meshCells();
    void emitCell(int config, const Eigen::Vector3i& cell);
    uint32_t vertexOnEdge(const Eigen::Vector3i& local, int axis);
    void addVertex(const Eigen::Vector3i& local, int axis);
    uint8_t shownAt(bool is_low_inside, const Eigen::Vector3i& low_voxel, int axis, size_t low,
                    const Eigen::Vector3f& normal, float fraction) const;
    bool isLaidOpen(MaterialId material, const Eigen::Vector3i& inside, const Eigen::Vector3i& outside,
                    size_t inside_corner) const noexcept;
    uint8_t milledBit(const Eigen::Vector3i& low_voxel, int axis, size_t low, float fraction) const noexcept;
    MaterialId materialUnder(const Eigen::Vector3i& inside, size_t corner,
                             const Eigen::Vector3f& normal) const noexcept;

    size_t cornerIndex(const Eigen::Vector3i& local) const noexcept {
        return size_t(local.x() + 1) + stride_[1] * size_t(local.y() + 1) +
               stride_[2] * size_t(local.z() + 1);
    }

    const VoxelVolume& volume_;
    const LeafLattice& lattice_;
    VertexLook look_;
    const RegionRim* rim_;
    IndexBox readable_;  // voxels; others have no density
    IndexBox left_out_;  // cells
    const VertexPaint* paint_ = nullptr;
    MeshGrid grid_;
    const std::array<CubeTriangles, 256>& triangles_;
    CrossedCells crossed_;
    Eigen::Vector3f inverse_spacing_;
    Eigen::Vector3i first_voxel_;  // of the leaf in hand; locals count from here
    Eigen::Vector3i cells_;        // of the leaf in hand, per axis
    size_t stride_[3] = {1, 0, 0};
    std::vector<Density> density_;  // cells_ + 3 voxels per axis from local (-1, -1, -1) on, x fastest
    std::vector<PackedVertex> vertices_;
    std::vector<uint32_t> indices_;
    std::vector<uint8_t> materials_;     // per vertex, with a look or a paint
    std::vector<uint32_t> edge_vertex_;  // per corner and axis: vertex on the edge that starts there
};

}  // namespace bonemill
