// These loops cut triangles of iso-surface into pieces. They are part of kernel_loops.h, and need
// cell_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

inline Points minus(const Points& a, const Points& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Floats squared(const Points& v) {
    return v.x * v.x + v.y * v.y + v.z * v.z;
}

// Edge n leads from corner n to the next.
inline void findLongest(const Points (&corner)[3], Floats& longest, Ints& edge) {
    longest = squared(minus(corner[1], corner[0]));
    edge = Ints{};
    for (int n = 1; n < 3; ++n) {
        const Floats length = squared(minus(corner[(n + 1) % 3], corner[n]));
        const Ints is_longer = length > longest;
        longest = is_longer ? length : longest;
        edge = is_longer ? Ints{} + n : edge;
    }
}

// Returns how far the trilinear surface is off the triangle, in m: a little more than it is at four places,
// its centroid and the middles of its edges.
inline Floats sagOf(const Floats (&excess)[8], const Points (&at)[3], const float (&inverse)[3]) {
    constexpr float kMore = 1.5f;
    Floats most{};
    for (int n = 0; n < 4; ++n) {
        const Points &a = at[n % 3], &b = at[(n + 1) % 3], &c = at[(n + 2) % 3];
        const Points place = n == 3
                                 ? Points{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3}
                                 : Points{(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2};
        Points slope;
        Floats value;
        sampleCells(excess, place, value, slope);
        slope.x *= inverse[0], slope.y *= inverse[1], slope.z *= inverse[2];
        Floats rise;
        rootOf(squared(slope), rise);
        const Floats off = (value < 0 ? -value : value) / rise;
        const Ints is_more = (rise > 0) & (off > most);
        most = is_more ? off : most;
    }
    return kMore * most;
}

// These are triangles of up to kCellLanes cells, one of each, on their way into the arrays.
struct TriangleLanes {
    static constexpr int kValues = 15;  // nine coordinates, area, normal, sag, bend
    alignas(64) float value[kValues][kCellLanes];
    alignas(64) int is_one[kCellLanes];
};

int appendTriangles(const TriangleLanes& lanes, int first_cell, int count, const SurfaceTriangles& out) {
    float* const to[] = {out.corner[0], out.corner[1], out.corner[2], out.corner[3], out.corner[4],
                         out.corner[5], out.corner[6], out.corner[7], out.corner[8], out.area,
                         out.nx,        out.ny,        out.nz,        out.sag,       out.bend};
    for (int v = 0; v < TriangleLanes::kValues; ++v) packLanes(lanes.value[v], lanes.is_one, to[v] + count);
    for (int l = 0; l < kCellLanes; ++l) {
        out.cell[count] = first_cell + l;
        count -= lanes.is_one[l];
    }
    return count;
}

// The triangle with these corners, in cell steps, of kWidth cells from `first` on.
void triangleOf(const CellArrays& cells, const CellPlaces& places, int first, const Points (&at)[3],
                const Ints& is_wanted, TriangleLanes& lanes, int to) {
    const float* s = places.steps;
    const float inverse[3] = {1 / s[0], 1 / s[1], 1 / s[2]};
    Floats excess[8], bx, by, bz;
    for (int c = 0; c < 8; ++c) load(cells.excess[c] + first, excess[c]);
    load(places.x + first, bx), load(places.y + first, by), load(places.z + first, bz);
    Points corner[3];
    for (int c = 0; c < 3; ++c) corner[c] = {bx + at[c].x * s[0], by + at[c].y * s[1], bz + at[c].z * s[2]};
    const Points u = minus(corner[1], corner[0]), v = minus(corner[2], corner[0]);
    const Points across{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    Floats twice, longest;
    Ints edge;
    rootOf(squared(across), twice);
    findLongest(corner, longest, edge);
    const Ints is_one = is_wanted & (twice > 0);
    const Floats scale = 1 / (is_one ? twice : Floats{} + 1);
    const Points n{across.x * scale, across.y * scale, across.z * scale};
    const float* R = places.R_TV;
    Floats sag = sagOf(excess, at, inverse);
    sag = sag < places.most_sag ? sag : Floats{} + places.most_sag;
    for (int c = 0; c < 3; ++c) {
        store(corner[c].x, &lanes.value[3 * c][to]);
        store(corner[c].y, &lanes.value[3 * c + 1][to]);
        store(corner[c].z, &lanes.value[3 * c + 2][to]);
    }
    store(twice / 2, &lanes.value[9][to]);
    store(R[0] * n.x + R[1] * n.y + R[2] * n.z, &lanes.value[10][to]);
    store(R[3] * n.x + R[4] * n.y + R[5] * n.z, &lanes.value[11][to]);
    store(R[6] * n.x + R[7] * n.y + R[8] * n.z, &lanes.value[12][to]);
    store(sag, &lanes.value[13][to]);
    store(sag / (is_one ? longest : Floats{} + 1), &lanes.value[14][to]);
    store(is_one, &lanes.is_one[to]);
}

// Their order is the same whatever the width of the registers.
int cellTriangles(const CellArrays& cells, const int* triangles, const CellPlaces& places,
                  const SurfaceTriangles& out) {
    constexpr int kParts = kCellLanes / kWidth;
    TriangleLanes lanes{};
    int count = 0;
    for (int block = 0; block < cells.count; block += kCellLanes) {
        CrossedLanes crossed[kParts];
        for (int part = 0; part < kParts; ++part) findCrossings(cells, block + part * kWidth, crossed[part]);
        bool is_any = true;
        for (int n = 0; n < kTrianglesPerCell && is_any; ++n) {
            is_any = false;
            for (int& is_one : lanes.is_one) is_one = 0;
            for (int part = 0; part < kParts; ++part) {
                Ints is_one;
                Points corner[3];
                if (!findTriangles(crossed[part], triangles, n, is_one, corner)) continue;
                is_any = true;
                triangleOf(cells, places, block + part * kWidth, corner, is_one, lanes, part * kWidth);
            }
            count = appendTriangles(lanes, block, count, out);
        }
    }
    return count;
}

inline void loadCorners(const PieceArrays& pieces, int first, Points (&corner)[3]) {
    for (int c = 0; c < 3; ++c) {
        load(pieces.corner[3 * c] + first, corner[c].x);
        load(pieces.corner[3 * c + 1] + first, corner[c].y);
        load(pieces.corner[3 * c + 2] + first, corner[c].z);
    }
}
inline void select(const Ints& mask, const Points& from, Points& to) {
    to.x = mask ? from.x : to.x, to.y = mask ? from.y : to.y, to.z = mask ? from.z : to.z;
}

// Stores pieces that have the corners of others, but for one, which is at `middle`.
inline void storeHalf(const PieceArrays& pieces, const Points (&corner)[3], const Ints& moved,
                      const Points& middle, const Floats& area, const Ints& triangle, int to) {
    for (int c = 0; c < 3; ++c) {
        Points p = corner[c];
        select(moved == c, middle, p);
        store(p.x, pieces.corner[3 * c] + to);
        store(p.y, pieces.corner[3 * c + 1] + to);
        store(p.z, pieces.corner[3 * c + 2] + to);
    }
    store(area, pieces.area + to);
    store(triangle, pieces.triangle + to);
}

int halvePieces(const PieceArrays& pieces, const int* which, int count, int to) {
    const int padded = (count + kCellLanes - 1) / kCellLanes * kCellLanes;
    for (int i = 0; i < padded; i += kWidth) {
        Ints piece, edge, triangle;
        load(which + i, piece);
        Points corner[3];
        for (int c = 0; c < 3; ++c) {
            gather(pieces.corner[3 * c], piece, corner[c].x);
            gather(pieces.corner[3 * c + 1], piece, corner[c].y);
            gather(pieces.corner[3 * c + 2], piece, corner[c].z);
        }
        Floats area;
        gather(pieces.area, piece, area);
        gather(pieces.edge, piece, edge);
        gather(pieces.triangle, piece, triangle);
        Points from = corner[0], till = corner[1];
        for (int n = 1; n < 3; ++n)
            select(edge == n, corner[n], from), select(edge == n, corner[(n + 1) % 3], till);
        const Points middle{(from.x + till.x) / 2, (from.y + till.y) / 2, (from.z + till.z) / 2};
        const Ints next = edge == 2 ? Ints{} : edge + 1;
        storeHalf(pieces, corner, next, middle, area / 2, triangle, to + i);
        storeHalf(pieces, corner, edge, middle, area / 2, triangle, to + padded + i);
    }
    return padded;
}

void measurePieces(const PieceArrays& pieces, const SurfaceTriangles& triangles, int first, int count,
                   const MeasuredPieces& out) {
    // No point of a triangle is farther from its centroid than two thirds of its longest edge.
    constexpr float kReach = 2.0f / 3;
    for (int i = 0; i < count; i += kWidth) {
        Points corner[3];
        loadCorners(pieces, first + i, corner);
        Floats longest, value;
        Ints edge, triangle;
        findLongest(corner, longest, edge);
        store(longest, pieces.longest + first + i);
        store(edge, pieces.edge + first + i);
        store((corner[0].x + corner[1].x + corner[2].x) / 3, out.x + i);
        store((corner[0].y + corner[1].y + corner[2].y) / 3, out.y + i);
        store((corner[0].z + corner[1].z + corner[2].z) / 3, out.z + i);
        rootOf(longest, value);
        store(kReach * value, out.reach + i);
        load(pieces.triangle + first + i, triangle);
        Ints lane;
        countLanes(lane);
        triangle = i + lane < count ? triangle : Ints{};  // beyond there is anything
        gather(triangles.nx, triangle, value), store(value, out.nx + i);
        gather(triangles.ny, triangle, value), store(value, out.ny + i);
        gather(triangles.nz, triangle, value), store(value, out.nz + i);
        gather(triangles.bend, triangle, value), store(value * longest, out.sag + i);
        gather(triangles.sag, triangle, value), store(value, out.triangle_sag + i);
        gather(triangles.finest, triangle, edge), store(edge, out.finest + i);
    }
}

void lowerBounds(const float* distance, const float* gx, const float* gy, const float* gz, const float* nx,
                 const float* ny, const float* nz, const float* reach, int count, float* centroids,
                 float* bounds) {
    for (int i = 0; i < count; i += kWidth) {
        Points g, n;
        Floats far, way, centroid, bound, slope;
        load(gx + i, g.x), load(gy + i, g.y), load(gz + i, g.z);
        load(nx + i, n.x), load(ny + i, n.y), load(nz + i, n.z);
        load(distance + i, far), load(reach + i, way), load(centroids + i, centroid), load(bounds + i, bound);
        const Floats along = g.x * n.x + g.y * n.y + g.z * n.z, rest = 1 - along * along;
        rootOf(rest > 0 ? rest : Floats{}, slope);
        const Floats here = far - slope * way;
        store(far < centroid ? far : centroid, centroids + i);
        store(here < bound ? here : bound, bounds + i);
    }
}

void levelPieces(const PieceRules& rules, const float* longest, const MeasuredPieces& pieces,
                 const float* centroids, int count, float* nearest, int* level) {
    const PieceRules r = rules;
    for (int i = 0; i < count; i += kWidth) {
        Floats near, off, off_triangle, length, centroid;
        Ints limit;
        load(nearest + i, near), load(pieces.sag + i, off), load(pieces.triangle_sag + i, off_triangle);
        load(longest + i, length), load(centroids + i, centroid), load(pieces.finest + i, limit);
        near -= off;
        store(near, nearest + i);
        const Floats times = length * r.per_spacing_squared;
        Ints bits;
        __builtin_memcpy(&bits, &times, sizeof bits);
        const Ints power = (bits >> 23) - 127, last = Ints{} + (kPieceLevels - 1);
        const Ints at = power < last ? power : last;
        const Floats in_proportion = r.length_per_distance * near;
        const Floats enough = in_proportion < r.longest_enough ? in_proportion : Floats{} + r.longest_enough;
        const Ints is_long = (near < r.fine_within) | (length > enough * enough);
        const Ints is_cut = (times > 1) & ~(limit > at) & is_long;
        // A sample lies where the surface is, which is off the triangle by about so much.
        const Ints finished =
            centroid - 2 * off_triangle < r.margin ? Ints{} + kPieceFinished : Ints{} + kPieceFar;
        const Ints kept = is_cut ? at : finished;
        store(near < r.margin ? kept : Ints{} + kPieceDropped, level + i);
    }
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
