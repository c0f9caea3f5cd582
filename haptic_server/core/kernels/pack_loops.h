// These loops pack points of cells side by side. They are part of kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// kCellLanes points on their way into the arrays.
struct PointLanes {
    alignas(64) float at[3][kCellLanes], normal[3][kCellLanes], area[kCellLanes];
    alignas(64) int key[kCellLanes], has_area[kCellLanes];
};

inline void placeOnAxis(const int* index, int first, const float* at, float spacing, float* out) {
    Ints cell;
    Floats in_cell;
    load(index, cell), load(at, in_cell);
    store((__builtin_convertvector(cell + first, Floats) + in_cell) * spacing, out);
}

// Reads kWidth cells from `n` on.
inline void pointLanes(const CellList& cells, const CellPoints& points, const float spacing[3], int axis_bits,
                       int n, PointLanes& out) {
    const int to = n % kCellLanes;
    placeOnAxis(cells.i + n, cells.first[0], points.x + n, spacing[0], out.at[0] + to);
    placeOnAxis(cells.j + n, cells.first[1], points.y + n, spacing[1], out.at[1] + to);
    placeOnAxis(cells.k + n, cells.first[2], points.z + n, spacing[2], out.at[2] + to);
    Ints lane, i, j, k;
    Floats area;
    load(cells.i + n, i), load(cells.j + n, j), load(cells.k + n, k);
    store(i | j << axis_bits | k << 2 * axis_bits, out.key + to);
    load(points.area + n, area);
    area *= points.unit_area;
    store(area, out.area + to);
    countLanes(lane);
    store((area > 0) & (n + lane < cells.count), out.has_area + to);
}

int packPoints(const CellList& cells, const CellPoints& points, const float spacing[3], int axis_bits,
               const PackedPoints& out) {
    const float* const normal[3] = {points.nx, points.ny, points.nz};
    float *const at[3] = {out.x, out.y, out.z}, *const facing[3] = {out.nx, out.ny, out.nz};
    int count = 0;
    for (int first = 0; first < cells.count; first += kCellLanes) {
        PointLanes lanes;
        for (int to = 0; to < kCellLanes; to += kWidth)
            pointLanes(cells, points, spacing, axis_bits, first + to, lanes);
        for (int axis = 0; axis < 3; ++axis) {
            __builtin_memcpy(lanes.normal[axis], normal[axis] + first, sizeof lanes.normal[axis]);
            packLanes(lanes.at[axis], lanes.has_area, at[axis] + count);
            packLanes(lanes.normal[axis], lanes.has_area, facing[axis] + count);
        }
        packLanes(lanes.area, lanes.has_area, out.area + count);
        count += packLanes(lanes.key, lanes.has_area, out.key + count);
    }
    return count;
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
