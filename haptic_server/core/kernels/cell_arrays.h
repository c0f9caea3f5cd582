// Cells of a volume and what lies in them, as the kernels take them: structures of arrays.
#pragma once

namespace bonemill {

// Cells that the iso-surface crosses, as structure of arrays; the arrays go on to the next multiple of
// kCellLanes, with anything in them.
inline constexpr int kCellLanes = 16;
inline constexpr int kTrianglesPerCell = 5;  // at most

struct CellArrays {
    const float* excess[8];  // density minus iso at the corners
    const int* inside;       // which corners are inside, bit by corner
    int count;
};
// The patches are those of the triangles in each cell; the centroid, in cell steps, is not set where there is
// no area.
struct CellPatches {
    float* area;  // in squares of the unit of `steps`
    float *x, *y, *z;
};
// Cells of a volume by their indices, which count from `first`: together they are -1 .. dims-1. The arrays go
// on to the next multiple of kCellLanes.
struct CellList {
    const int *i, *j, *k;
    int first[3];
    int count;
};
// What densities make of a list of cells; the arrays have room for kCellLanes more.
struct ReadCells {
    int* inside;  // of each: which corners are inside, bit by corner
    // Those that the surface crosses, side by side in the list's order, and their places in it.
    float* excess[8];  // density minus iso at the corners
    int* crossed_inside;
    int* place;
};
// Projects a point of each cell onto its trilinear iso-surface.
struct CellProjections {
    float *x, *y, *z;  // in: where it starts; out: where it ended
    float *normal_x, *normal_y,
        *normal_z;  // unit, against the density's gradient there; zero where that is zero
    int* is_found;  // 0: it left the cell or found no way
};

// Of each cell of a list: where a point of its patch lies, and its normal.
struct CellPoints {
    const float* area;       // in units of `unit_area`
    float unit_area;         // m²
    const float *x, *y, *z;  // cell steps from the cell's first corner
    const float *nx, *ny, *nz;
};
// Points of surface, side by side; the arrays have room for kCellLanes more.
struct PackedPoints {
    float *x, *y, *z;  // m
    float *nx, *ny, *nz;
    float* area;  // m²
    int* key;     // the cell's indices, joined
};

}  // namespace bonemill
