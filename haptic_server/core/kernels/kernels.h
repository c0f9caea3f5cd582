// The inner loops of the tick and the mesher, compiled for several instruction sets; the best that this CPU
// has is chosen at the start.
//
// All levels compute the same IEEE operations in the same order on every element, and sums in the same lanes,
// so their results agree bit for bit: a replay's hash does not depend on the CPU. The baseline is the oracle
// of the tests. RT-safe, any thread; no kernel keeps a pointer.
#pragma once

#include <cstddef>
#include <cstdint>

#include "haptic_server/core/kernels/cell_arrays.h"

namespace bonemill {

enum class CpuLevel : uint8_t { kBaseline, kAvx2, kAvx512 };
inline constexpr CpuLevel kCpuLevels[] = {CpuLevel::kBaseline, CpuLevel::kAvx2, CpuLevel::kAvx512};

// The names are "x86-64", "avx2", "avx512".
const char* cpuLevelName(CpuLevel level) noexcept;
bool isSupported(CpuLevel level) noexcept;

// These are the rows of a rotation, and a translation: out = R (p - origin).
template <class Scalar>
struct FrameChange {
    Scalar R[9];
    Scalar origin[3];
};

// The solid is all points within `radius` of the segment that starts at `from` and goes `length` along the
// unit vector `axis`.
template <class Scalar>
struct RoundSolid {
    Scalar from[3], axis[3];
    Scalar length, radius;
};

// All points within `edge_radius` of a truncated cone with flat ends about the segment that starts at `from`
// and goes `length` > 0 along the unit vector `axis`.
template <class Scalar>
struct ConeSolid {
    Scalar from[3], axis[3];
    Scalar normal[3];  // unit, any to the axis
    Scalar length;
    Scalar radius[2];  // where the segment starts and where it ends
    Scalar side[2];    // unit, from the first rim to the second: along and off the axis
    Scalar edge_radius;
};

// The frame leads from the tool's axes to the bone's, and says where the tool point lies among the
// contact points.
struct ContactFrame {
    double R_VT[9];    // rows
    double p_OT[3];    // m
    double depth_cap;  // m: deeper contact pulls no stronger
};

// These are sums over contact points: energy, wrench on the tool and Gauss-Newton stiffness, about the
// tool point, V.
struct ContactSums {
    double energy = 0;          // J
    double force[3] = {};       // N
    double torque[3] = {};      // N·m
    double stiffness[21] = {};  // rows of the upper triangle
    double max_depth = 0;       // m
};
inline constexpr int kContactBatch = 64;

// How a burr turns and moves that rubs on bone: SI, V, about the tool point.
struct RubbingMotion {
    double axis[3] = {};  // unit
    double spin = 0;      // rad/s about it
    double velocity[3] = {}, angular_velocity[3] = {};
    double friction = 0;         // tangential per normal force of what slides
    double slow_squared = 0;     // m²/s²: what slides slower than its root pulls less
    double held_per_moment = 0;  // N·m that the bone holds of a spindle that stalls, per N·m of force times ρ
};
// At most kContactBatch contacts on the burr.
struct RubbingPoints {
    const float *rx, *ry, *rz;  // from the tool point, m
    const float *nx, *ny, *nz;  // unit: where the bone pushes the tool
    const float* force;         // N along that
    const double* spread;       // m²: what the patch adds to the square of its distance from the axis
    const double* rho;          // m: that distance with it
    int count;
};
// These are sums over contacts: the pull of the spin, and of dampers d against the tool's own motion, that of
// d, of d r, and the upper triangles of those of d r rᵀ and of d w wᵀ, w = (n, r × n).
struct RubbingSums {
    double force[3] = {};   // N
    double torque[3] = {};  // N·m
    double per_speed = 0;   // N·s/m
    double of_r[3] = {}, of_rr[6] = {}, of_ww[21] = {};
};

// It says what makes a contact point worth a closer look. A place of its patch is nearer to the tool
// than the point by what lies in the patch's plane of the way to the tool, and by what the bone bends
// towards the tool.
struct NearTest {
    float R_VT[9];      // rows
    float patch_reach;  // m: no place of a point's patch is farther from the point
    float bend;         // m: by which a patch may bend towards the tool, off the plane at the point
    float margin;       // m: points with a place nearer than this
};

template <class Scalar>
struct PointKernels {
    void (*into_frame)(const FrameChange<Scalar>& frame, const float* x, const float* y, const float* z,
                       int count, Scalar* out_x, Scalar* out_y, Scalar* out_z);
    // This makes out = min(out, distance).
    void (*nearer_round)(const RoundSolid<Scalar>& solid, const Scalar* x, const Scalar* y, const Scalar* z,
                         int count, Scalar* out);
    // Writes the solid's distance and gradient where it is nearer than `distance`; on the axis the gradient
    // is zero.
    void (*sample_nearer_round)(const RoundSolid<Scalar>& solid, const Scalar* x, const Scalar* y,
                                const Scalar* z, int count, Scalar* distance, Scalar* gx, Scalar* gy,
                                Scalar* gz);
    // This does the same; on the axis the gradient is of length 1 too.
    void (*nearer_cone)(const ConeSolid<Scalar>& solid, const Scalar* x, const Scalar* y, const Scalar* z,
                        int count, Scalar* out);
    void (*sample_nearer_cone)(const ConeSolid<Scalar>& solid, const Scalar* x, const Scalar* y,
                               const Scalar* z, int count, Scalar* distance, Scalar* gx, Scalar* gy,
                               Scalar* gz);
    // Adds at most kContactBatch points inside the tool (distance < 0), from the frame's origin, with their
    // stiffness `weight` (N/m); gradients are in the tool's axes.
    void (*add_contacts)(const ContactFrame& frame, const float* x, const float* y, const float* z,
                         const float* weight, const Scalar* distance, const Scalar* gx, const Scalar* gy,
                         const Scalar* gz, int count, ContactSums& sums);
};

// The burr's limit in a plane of voxels (milling/burr_limit.h), counts and m. The burr's centre goes a way in
// the tick, and the limit is that of all its places on it.
struct BurrPlane {
    float first_x, step_x;    // from where the centre sets out to the plane's first voxel, along x
    float first_y, step_y;    // along y
    float off_plane_squared;  // m²: of the plane from there
    float way_x, way_y;       // unit, the way's direction, whose z has its part in off_plane_along
    float off_plane_along;    // m: of the plane along the way
    float way;                // m: its length; 0: the centre stays
    float radius, slope;      // counts per m
    float reach_squared;      // m²: no limit from there on
    float core_squared;       // m²: inside, the limit is the last density there is
    int iso;
    int amount;  // at most this many count towards the limit
};

struct MilledPlane {
    int removed;          // voxels that fell below iso
    int added;            // that rose to iso or above
    uint32_t is_changed;  // rows, bit by row
};

struct LaidPlane {
    int added;            // voxels that rose to iso or above
    uint32_t is_changed;  // rows, bit by row
    bool is_owed;         // some voxels are still below what they shall have
};

// These are voxels in memory, x fastest and side by side.
struct VoxelBox {
    const uint16_t* first;
    size_t stride_y, stride_z;
};
// The sides of N cells are looked at together: the bytes of a word.
inline constexpr int kCellsAtOnce = 8;

// These are the voxels in their bricks (brick_layout.h), for kernels that look at any of them; -1 .. dims is
// readable on each axis.
struct DensityView {
    const uint16_t* bricks;
    const uint32_t* slots;  // per brick, x fastest: which of `bricks`
    int bricks_x, bricks_y;
    int dims[3];
    int iso;
    float inverse_spacing[3];  // 1/m
    float origin[3];           // m: of the points' coordinates
};
// These points move onto the surface, in m, as structure of arrays that go on to the next multiple
// of kCellLanes. Where there is no way, or it is longer than `reach`, they stay.
struct SurfacePoints {
    float *x, *y, *z;  // in: where they start; out: where they ended
    float reach;       // m
    int count;
};

// Triangles of iso-surface are cut into pieces, by halves across their longest edges
// (contact/surface_pieces.h). All are structures of arrays that go on to the next multiple of kCellLanes.

// Where the cells lie whose triangles are wanted.
struct CellPlaces {
    const float *x, *y, *z;  // m: of their first corners
    float steps[3];          // m
    float R_TV[9];           // rows
    float most_sag;          // m: the trilinear surface is taken to be no farther off a triangle
};
struct SurfaceTriangles {
    float* corner[9];     // m: x, y, z of the first corner, then of the others
    float* area;          // m²
    float *nx, *ny, *nz;  // T, unit
    float* sag;           // m: the surface is no farther off it
    float* bend;  // 1/m: times the square of a piece's longest edge, how far the surface may be off it
    int* cell;    // which it lies in
    int* finest;  // the last level to which its pieces are cut; none: -1
};
struct PieceArrays {
    float* corner[9];  // m: x, y, z of the first corner, then of the others
    float* area;       // m²
    float* longest;    // m²: the square of its longest edge
    int* edge;         // which that is: it leads from this corner to the next
    int* triangle;     // which it is a part of
};
struct MeasuredPieces {
    float *x, *y, *z;     // m: centroids
    float* reach;         // m: no point of a piece is farther from its centroid
    float *nx, *ny, *nz;  // T, unit
    float* sag;           // m: the surface is no farther off it
    float* triangle_sag;  // m: nor off its triangle
    int* finest;          // of its triangle
};
// A piece has to be cut at the level n if the square of its longest edge is from 2^n to 2^(n+1) times that of
// the spacing; or it is finished, and its centroid perhaps out of reach; or all of it is out of reach.
inline constexpr int kPieceLevels = 32, kPieceFinished = kPieceLevels, kPieceFar = kPieceLevels + 1,
                     kPieceDropped = kPieceLevels + 2;
struct PieceRules {
    float margin;               // m: what is not nearer to the tool is dropped
    float fine_within;          // m: what is nearer is cut,
    float length_per_distance;  // and what is longer than this for its distance,
    float longest_enough;       // or than this, m
    float per_spacing_squared;  // 1/m²
};

// Places on the surface that sink into the bone, against the density's gradient, as structure of arrays that
// go on to the next multiple of kCellLanes.
struct SinkingPoints {
    float *x, *y, *z;           // in: m; out: where they come to, voxel steps
    const float* recession;     // m
    const float* least_excess;  // counts: there is taken to be so much density where they come to
    float* drop;                // out: the densities around there must fall by so many counts
    int count;
};
// These are voxels around a place, with weights that fall to zero at `width` along each axis.
struct VoxelHat {
    float at[3];  // voxel steps
    float width;
    int first[3], count[3];  // voxels
    size_t stride_y, stride_z;
};

// The voxels with a weight around places, from low to high at most: the first and how many on each axis, 0
// or less where there is none. The arrays go on to the next multiple of kCellLanes.
struct HatBoxes {
    const float* at[3];  // voxel steps
    float width;
    int low[3], high[3];  // voxels
    int *first[3], *count[3];
};

struct Kernels {
    PointKernels<float> single;
    PointKernels<double> twice;
    void (*add_rubbing)(const RubbingMotion& motion, const RubbingPoints& points, RubbingSums& sums);
    // Selects the near ones of at most kContactBatch points: writes their indices, and of all points how
    // near a place of its patch comes. Distances and gradients (T) and normals (V); the arrays go on to a
    // multiple of kCellLanes.
    int (*select_near)(const NearTest& test, const float* distance, const float* gx, const float* gy,
                       const float* gz, const float* nx, const float* ny, const float* nz, int count,
                       float* nearest, int* selected);
    // A brick's plane of `rows` rows of `count` voxels, kBrickStrideY apart and both at most kBrickCells,
    // after milling with limits from above (remove) or from below (add): the rows that changed are written to
    // out, kBrickCells apart.
    MilledPlane (*remove_plane)(const BurrPlane& burr, const uint16_t* first, int count, int rows,
                                uint16_t* out);
    MilledPlane (*add_plane)(const BurrPlane& burr, const uint16_t* first, int count, int rows,
                             uint16_t* out);
    // The same for voxels that rise towards densities that they shall have, by `amount` at most, and not at
    // all in the core of `place`. Both planes' rows are kBrickStrideY apart.
    LaidPlane (*lay_plane)(const BurrPlane& place, const uint16_t* shall, const uint16_t* first, int count,
                           int rows, uint16_t* out);
    // Returns how many of these cells the surface crosses.
    int (*read_cells)(const DensityView& density, const CellList& cells, const ReadCells& out);
    // triangles[kTrianglesPerCell * inside + triangle] has the crossed edges a + 16 b + 256 c of the cell,
    // not all zero; it is zero beyond the last triangle.
    void (*cell_patches)(const CellArrays& cells, const int* triangles, const float steps[3],
                         const CellPatches& out);
    // Writes which share of each cell is bone, 0 to 1: the volume behind its triangles.
    void (*cell_fills)(const CellArrays& cells, const int* triangles, float* fills);
    // Makes at most `most_steps` Newton steps along the slope times `steepness`, until the density is within
    // `tolerance` times the largest excess at the corners.
    void (*project_into_cells)(const CellArrays& cells, const float steepness[3],
                               const float inverse_spacing[3], float tolerance, int most_steps,
                               const CellProjections& out);
    // Packs the points of those cells that have an area. A key joins the cell's indices, of `axis_bits` bits
    // each, with i lowest. Returns how many.
    int (*pack_points)(const CellList& cells, const CellPoints& points, const float spacing[3], int axis_bits,
                       const PackedPoints& out);
    // Takes Newton steps up or down the density's gradient, from cell to cell.
    void (*move_onto_surface)(const DensityView& density, int steps, const SurfacePoints& points);
    // Takes a step down into the bone from each place. By its drop all corners of the cell there must fall,
    // so that the surface comes to it; those that come to rest at zero leave the rest to the others.
    void (*sink_surface)(const DensityView& density, const SinkingPoints& points);
    void (*hat_boxes)(const HatBoxes& boxes, int count);
    // Adds the hat's weights times the area, and those times the drop, to sums whose first ones are those of
    // the hat's first voxel. Rows may be read and written up to kCellLanes - 1 beyond their ends.
    void (*add_hat)(const VoxelHat& hat, float area, float drop, float* drops, float* weights);
    // The same for weights alone, where there are any.
    void (*add_hat_where_any)(const VoxelHat& hat, float area, float* weights);
    // Appends the triangles in these cells; all but `finest` is written, and up to kCellLanes behind the
    // last. Returns how many there are.
    int (*cell_triangles)(const CellArrays& cells, const int* triangles, const CellPlaces& places,
                          const SurfaceTriangles& out);
    // Writes the halves of these pieces: the first ones from `to` on, the others so much farther as it
    // returns, which is the next multiple of kCellLanes. The list of pieces goes on to that multiple, with
    // any of them.
    int (*halve_pieces)(const PieceArrays& pieces, const int* which, int count, int to);
    // Finds the longest edges of the pieces from `first` on, and what decides about them. Writes up to
    // kCellLanes - 1 beyond them.
    void (*measure_pieces)(const PieceArrays& pieces, const SurfaceTriangles& triangles, int first, int count,
                           const MeasuredPieces& out);
    // Lowers the distances of pieces' centroids, and bounds of those of their other points, to those of a
    // convex solid, which has these distances and gradients (T) at the centroids; the pieces have these
    // normals and reaches: along a plane its distance falls no faster than at the start. The arrays go on to
    // a multiple of kCellLanes.
    void (*lower_bounds)(const float* distance, const float* gx, const float* gy, const float* gz,
                         const float* nx, const float* ny, const float* nz, const float* reach, int count,
                         float* centroids, float* bounds);
    // Takes the sags from the pieces' bounds, and finds their levels.
    void (*level_pieces)(const PieceRules& rules, const float* longest, const MeasuredPieces& pieces,
                         const float* centroids, int count, float* nearest, int* level);
    // Returns the least of (value - lowest) * scale over the elements, but never more than `most`.
    float (*least_scaled)(const float* value, const float* lowest, const float* scale, int count, float most);
    // Finds the least and the largest of `rows` rows that lie `stride` voxels apart, joined with
    // what is there.
    void (*range_of_rows)(const uint16_t* row, int count, size_t stride, int rows, uint16_t& least,
                          uint16_t& largest);

    // Says of each column of a layer of cells which of its four voxels are iso or more, in bits 0, 2, 4 and 6
    // for (y, z), (y + 1, z), (y, z + 1) and (y + 1, z + 1). There are `rows` rows, row_size bytes apart; the
    // kCellsAtOnce bytes after the last column repeat it, and after kCellLanes more than the columns nothing
    // is written. Reads up to kCellLanes - 1 voxels beyond each row.
    void (*cell_sides)(const VoxelBox& box, int columns, int rows, uint16_t iso, size_t row_size,
                       uint8_t* out);

    template <class Scalar>
    const PointKernels<Scalar>& points() const noexcept {
        if constexpr (sizeof(Scalar) == sizeof(float))
            return single;
        else
            return twice;
    }
};

// These are the kernels of the best level. The environment variable BONEMILL_CPU_LEVEL (x86-64, avx2,
// avx512), read once at the start, chooses a lower one.
const Kernels& kernels() noexcept;
// These are the kernels of a level that this CPU supports; for tests.
const Kernels& kernelsOf(CpuLevel level) noexcept;

}  // namespace bonemill
