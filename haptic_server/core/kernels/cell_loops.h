// These loops find cells that the surface crosses, and move points onto it. They are part of kernel_loops.h.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1); edges 4 a .. 4 a + 3 run along axis a.
constexpr int kEdgeLow[12] = {0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};

// Reads table[index], where the index is 0 or more.
#if defined(__AVX512F__)
inline void gather(const float* table, const Ints& index, Floats& out) {
    out = Floats(_mm512_mask_i32gather_ps(__m512{}, __mmask16(-1), __m512i(index), table, sizeof(float)));
}
inline void gather(const int* table, const Ints& index, Ints& out) {
    out = Ints(_mm512_mask_i32gather_epi32(__m512i{}, __mmask16(-1), __m512i(index), table, sizeof(int)));
}
#elif defined(__AVX2__)
inline void gather(const float* table, const Ints& index, Floats& out) {
    out = Floats(_mm256_mask_i32gather_ps(__m256{}, table, __m256i(index), __m256(~Ints{}), sizeof(float)));
}
inline void gather(const int* table, const Ints& index, Ints& out) {
    out = Ints(_mm256_mask_i32gather_epi32(__m256i{}, table, __m256i(index), __m256i(~Ints{}), sizeof(int)));
}
#else
template <class T, class Vector>
inline void gather(const T* table, const Ints& index, Vector& out) {
    alignas(64) int at[kWidth];
    alignas(64) T result[kWidth];
    store(index, at);
    for (int l = 0; l < kWidth; ++l) result[l] = table[at[l]];
    load(result, out);
}
#endif

// Writes the lanes that are wanted, of kCellLanes, side by side to out, which has room for all. Returns how
// many.
#if defined(__AVX512F__)
template <class T>
inline int packLanes(const T* lanes, const int* is_wanted, T* out) {
    const __m512i wanted = _mm512_load_si512(is_wanted);
    const __mmask16 mask = _mm512_test_epi32_mask(wanted, wanted);
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(mask, _mm512_load_si512(lanes)));
    return __builtin_popcount(mask);
}
#else
template <class T>
inline int packLanes(const T* lanes, const int* is_wanted, T* out) {
    int count = 0;
    for (int l = 0; l < kCellLanes; ++l) {
        out[count] = lanes[l];
        count -= is_wanted[l];  // a true comparison is -1
    }
    return count;
}
#endif

// Finds where the density, linear along each edge, equals iso, for kWidth cells: [edge][lane], as a share of
// the edge. Edges that are not crossed hold anything.
void crossings(const CellArrays& cells, int first, float (&at)[12 * kWidth]) {
    for (int edge = 0; edge < 12; ++edge) {
        const int low_corner = kEdgeLow[edge];
        Floats low, high;
        load(cells.excess[low_corner] + first, low);
        load(cells.excess[low_corner | 1 << edge / 4] + first, high);
        store(low / (low - high), at + edge * kWidth);
    }
}

struct Points {
    Floats x, y, z;
};

// Bit by edge: does its low corner lie at 1 on this axis?
constexpr int edgesFrom1(int axis) {
    int edges = 0;
    for (int edge = 0; edge < 12; ++edge) edges |= (kEdgeLow[edge] >> axis & 1) << edge;
    return edges;
}

template <int kAxis>
inline void crossingOnAxis(const Ints& edge, const Floats& share, Floats& out) {
    const Ints low = (Ints{} + edgesFrom1(kAxis)) >> edge & 1;
    out = (edge >> 2) == kAxis ? share : __builtin_convertvector(low, Floats);
}

// The crossing is in cell steps.
inline void crossingOn(const float (&at)[12 * kWidth], const Ints& edge, const Ints& lane, Points& p) {
    Floats share;
    gather(at, edge * kWidth + lane, share);
    crossingOnAxis<0>(edge, share, p.x);
    crossingOnAxis<1>(edge, share, p.y);
    crossingOnAxis<2>(edge, share, p.z);
}

// kWidth cells, and where the surface crosses their edges.
struct CrossedLanes {
    Ints lane, inside;
    alignas(64) float at[12 * kWidth];
};
inline void findCrossings(const CellArrays& cells, int first, CrossedLanes& crossed) {
    countLanes(crossed.lane);
    crossings(cells, first, crossed.at);
    load(cells.inside + first, crossed.inside);
    crossed.inside = first + crossed.lane < cells.count ? crossed.inside : Ints{};
}
// Finds the n-th triangle of each cell that has so many: its corners are in cell steps. False: there is none.
inline bool findTriangles(const CrossedLanes& crossed, const int* triangles, int n, Ints& is_one,
                          Points (&corner)[3]) {
    Ints edges;
    gather(triangles, crossed.inside * kTrianglesPerCell + n, edges);
    is_one = edges != 0;
    if (!isAny(is_one)) return false;
    crossingOn(crossed.at, edges & 15, crossed.lane, corner[0]);
    crossingOn(crossed.at, edges >> 4 & 15, crossed.lane, corner[1]);
    crossingOn(crossed.at, edges >> 8, crossed.lane, corner[2]);
    return true;
}

void cellPatches(const CellArrays& cells, const int* triangles, const float steps[3],
                 const CellPatches& out) {
    for (int first = 0; first < cells.count; first += kWidth) {
        CrossedLanes crossed;
        findCrossings(cells, first, crossed);
        Floats twice{}, mx{}, my{}, mz{};
        Ints is_one;
        Points corner[3];
        for (int n = 0; n < kTrianglesPerCell && findTriangles(crossed, triangles, n, is_one, corner); ++n) {
            const auto& [a, b, c] = corner;
            const Floats ux = (b.x - a.x) * steps[0], uy = (b.y - a.y) * steps[1],
                         uz = (b.z - a.z) * steps[2];
            const Floats vx = (c.x - a.x) * steps[0], vy = (c.y - a.y) * steps[1],
                         vz = (c.z - a.z) * steps[2];
            const Floats nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
            Floats area;
            rootOf(nx * nx + ny * ny + nz * nz, area);
            twice += is_one ? area : Floats{};
            mx += is_one ? area * (a.x + b.x + c.x) : Floats{};
            my += is_one ? area * (a.y + b.y + c.y) : Floats{};
            mz += is_one ? area * (a.z + b.z + c.z) : Floats{};
        }
        const Floats scale = 1 / (3 * twice);
        store(twice / 2, out.area + first);
        store(mx * scale, out.x + first);
        store(my * scale, out.y + first);
        store(mz * scale, out.z + first);
    }
}

// Returns how much of the face z = 1 is bone; each inside corner, or run of such, is cut off by itself.
inline Floats filledTop(const Floats (&excess)[8], const Ints& inside) {
    constexpr int kAround[4] = {4, 5, 7, 6};
    Floats area{};
    for (int n = 0; n < 4; ++n) {
        const int at[4] = {kAround[n], kAround[(n + 1) & 3], kAround[(n + 2) & 3], kAround[(n + 3) & 3]};
        const Floats &e0 = excess[at[0]], &e1 = excess[at[1]], &e2 = excess[at[2]], &e3 = excess[at[3]];
        const Ints is_in = (inside >> at[0] & 1) != 0, has_next = (inside >> at[1] & 1) != 0,
                   has_opposite = (inside >> at[2] & 1) != 0, has_last = (inside >> at[3] & 1) != 0;
        const Floats to_last = e0 / (e0 - e3), to_next = e0 / (e0 - e1);
        const Floats alone = to_last * to_next / 2, first_of_two = (to_last + e1 / (e1 - e2)) / 2;
        const Floats of_three = 1 - e2 / (e2 - e1) * (e2 / (e2 - e3)) / 2;
        const Ints is_alone = is_in & ~has_last & ~has_next,
                   is_first = is_in & has_next & ~has_last & ~has_opposite,
                   is_middle = is_in & has_last & has_next & ~has_opposite;
        area += is_alone ? alone : is_first ? first_of_two : is_middle ? of_three : Floats{};
    }
    return (inside >> 4) == 15 ? Floats{} + 1 : area;
}

// By the divergence theorem with the field (0, 0, z) it is the integral of z n_z over the cell's triangles,
// plus the bone's part of the face z = 1.
void cellFills(const CellArrays& cells, const int* triangles, float* fills) {
    for (int first = 0; first < cells.count; first += kWidth) {
        CrossedLanes crossed;
        findCrossings(cells, first, crossed);
        Floats excess[8];
        for (int c = 0; c < 8; ++c) load(cells.excess[c] + first, excess[c]);
        Floats fill = filledTop(excess, crossed.inside);
        Ints is_one;
        Points corner[3];
        for (int n = 0; n < kTrianglesPerCell && findTriangles(crossed, triangles, n, is_one, corner); ++n) {
            const auto& [a, b, c] = corner;
            const Floats across = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
            fill += is_one ? (a.z + b.z + c.z) / 3 * across : Floats{};
        }
        store(fill, fills + first);
    }
}

// Computes excess and slope of the trilinear density at `p`.
inline void sampleCells(const Floats (&e)[8], const Points& p, Floats& excess, Points& slope) {
    const Floats dx0 = e[1] - e[0], dx1 = e[3] - e[2], dx2 = e[5] - e[4], dx3 = e[7] - e[6];
    const Floats a0 = e[0] + p.x * dx0, a1 = e[2] + p.x * dx1, a2 = e[4] + p.x * dx2, a3 = e[6] + p.x * dx3;
    const Floats dy0 = a1 - a0, dy1 = a3 - a2;
    const Floats b0 = a0 + p.y * dy0, b1 = a2 + p.y * dy1;
    const Floats low = dx0 + p.y * (dx1 - dx0), high = dx2 + p.y * (dx3 - dx2);
    slope.z = b1 - b0;
    slope.y = dy0 + p.z * (dy1 - dy0);
    slope.x = low + p.z * (high - low);
    excess = b0 + p.z * slope.z;
}

inline void isWithin(const Floats& v, float low, float high, Ints& mask) {
    mask &= (v >= low) & (v <= high);
}

void projectIntoCells(const CellArrays& cells, const float steepness[3], const float inverse_spacing[3],
                      float tolerance, int most_steps, const CellProjections& out) {
    for (int first = 0; first < cells.count; first += kWidth) {
        Floats e[8], limit{};
        for (int corner = 0; corner < 8; ++corner) {
            load(cells.excess[corner] + first, e[corner]);
            const Floats size = e[corner] < 0 ? -e[corner] : e[corner];
            limit = limit < size ? size : limit;
        }
        limit *= tolerance;
        Points p, slope{}, here;
        load(out.x + first, p.x);
        load(out.y + first, p.y);
        load(out.z + first, p.z);
        Ints walks = ~Ints{}, is_found{};
        for (int n = 0; n <= most_steps && isAny(walks); ++n) {
            Floats excess;
            sampleCells(e, p, excess, here);
            slope.x = walks ? here.x : slope.x;
            slope.y = walks ? here.y : slope.y;
            slope.z = walks ? here.z : slope.z;
            const Ints arrives = walks & (excess <= limit) & (-excess <= limit);
            is_found |= arrives;
            walks &= ~arrives;
            const Floats ux = here.x * steepness[0], uy = here.y * steepness[1], uz = here.z * steepness[2];
            const Floats rise = here.x * ux + here.y * uy + here.z * uz;
            const Floats scale = -excess / rise;
            const Points step{scale * ux, scale * uy, scale * uz};
            const Points next{p.x + step.x, p.y + step.y, p.z + step.z};
            walks &= rise > 0;
            isWithin(step.x, -1, 1, walks), isWithin(step.y, -1, 1, walks), isWithin(step.z, -1, 1, walks);
            isWithin(next.x, 0, 1, walks), isWithin(next.y, 0, 1, walks), isWithin(next.z, 0, 1, walks);
            p.x = walks ? next.x : p.x;
            p.y = walks ? next.y : p.y;
            p.z = walks ? next.z : p.z;
        }
        store(p.x, out.x + first), store(p.y, out.y + first), store(p.z, out.z + first);
        const Floats gx = slope.x * inverse_spacing[0], gy = slope.y * inverse_spacing[1],
                     gz = slope.z * inverse_spacing[2];
        Floats length;
        rootOf(gx * gx + gy * gy + gz * gz, length);
        const Floats scale = length > 0 ? -1 / length : Floats{};
        store(gx * scale, out.normal_x + first);
        store(gy * scale, out.normal_y + first);
        store(gz * scale, out.normal_z + first);
        store(is_found & 1, out.is_found + first);
    }
}

inline void floorOf(const Floats& v, Ints& out) {
    const Ints truncated = __builtin_convertvector(v, Ints);
    out = truncated + (v < __builtin_convertvector(truncated, Floats));  // a true comparison is -1
}

inline void cellUnder(const Floats& u, int dim, Ints& cell, Floats& in_cell) {
    Ints below;
    floorOf(u, below);
    const Ints high = below > dim - 1 ? Ints{} + (dim - 1) : below;
    cell = high < -1 ? Ints{} - 1 : high;
    in_cell = u - __builtin_convertvector(cell, Floats);
}

// Reads the densities minus iso at the corners of each lane's cell, two side by side at once.
void readCells(const DensityView& d, const Ints& i, const Ints& j, const Ints& k, Floats (&e)[8]) {
    constexpr int kInBrick = kBrickCells - 1, kY = int(kBrickStrideY), kZ = int(kBrickStrideZ);
    const Ints u = i + 1, v = j + 1, w = k + 1;
    alignas(64) int brick[kWidth], in_brick[kWidth], pairs[4][kWidth];
    store((u >> kBrickShift) + d.bricks_x * ((v >> kBrickShift) + d.bricks_y * (w >> kBrickShift)), brick);
    store((u & kInBrick) + kY * (v & kInBrick) + kZ * (w & kInBrick) + kBrickLow * (1 + kY + kZ), in_brick);
    for (int l = 0; l < kWidth; ++l) {
        const uint16_t* p = d.bricks + d.slots[brick[l]] * kBrickSize + size_t(in_brick[l]);
        __builtin_memcpy(&pairs[0][l], p, sizeof(int));
        __builtin_memcpy(&pairs[1][l], p + kBrickStrideY, sizeof(int));
        __builtin_memcpy(&pairs[2][l], p + kBrickStrideZ, sizeof(int));
        __builtin_memcpy(&pairs[3][l], p + kBrickStrideZ + kBrickStrideY, sizeof(int));
    }
    const float iso = float(d.iso);
    for (int n = 0; n < 4; ++n) {
        Ints pair;
        load(pairs[n], pair);
        e[2 * n] = __builtin_convertvector(pair & 0xffff, Floats) - iso;
        e[2 * n + 1] = __builtin_convertvector(pair >> 16 & 0xffff, Floats) - iso;
    }
}

// kCellLanes cells on their way into the arrays.
struct CellLanes {
    alignas(64) float excess[8][kCellLanes];
    alignas(64) int inside[kCellLanes], place[kCellLanes], is_crossed[kCellLanes];
};

// Reads kWidth cells from `first` of the list on.
inline void readLanes(const DensityView& density, const CellList& cells, int first, CellLanes& out) {
    const int to = first % kCellLanes;
    Ints lane, i, j, k, inside{};
    countLanes(lane);
    lane += first;
    load(cells.i + first, i), load(cells.j + first, j), load(cells.k + first, k);
    const Ints is_one = lane < cells.count;
    const Ints anywhere = Ints{} - 1;
    i = is_one ? i + cells.first[0] : anywhere;
    j = is_one ? j + cells.first[1] : anywhere;
    k = is_one ? k + cells.first[2] : anywhere;
    Floats e[8];
    readCells(density, i, j, k, e);
    for (int c = 0; c < 8; ++c) {
        inside |= (e[c] >= 0) & 1 << c;
        store(e[c], out.excess[c] + to);
    }
    store(inside, out.inside + to), store(lane, out.place + to);
    store(is_one & (inside != 0) & (inside != 255), out.is_crossed + to);
}

int readListedCells(const DensityView& density, const CellList& cells, const ReadCells& out) {
    const DensityView d = density;
    int crossed = 0;
    for (int first = 0; first < cells.count; first += kCellLanes) {
        CellLanes lanes;
        for (int part = 0; part < kCellLanes; part += kWidth) readLanes(d, cells, first + part, lanes);
        __builtin_memcpy(out.inside + first, lanes.inside, sizeof lanes.inside);
        for (int c = 0; c < 8; ++c) packLanes(lanes.excess[c], lanes.is_crossed, out.excess[c] + crossed);
        packLanes(lanes.inside, lanes.is_crossed, out.crossed_inside + crossed);
        crossed += packLanes(lanes.place, lanes.is_crossed, out.place + crossed);
    }
    return crossed;
}

void moveOntoSurface(const DensityView& density, int steps, const SurfacePoints& points) {
    const DensityView d = density;
    const float ix = d.inverse_spacing[0], iy = d.inverse_spacing[1], iz = d.inverse_spacing[2];
    const float reach_squared = points.reach * points.reach;
    for (int first = 0; first < points.count; first += kWidth) {
        Points start, p, in_cell, slope;
        Floats excess, e[8] = {};
        load(points.x + first, start.x), load(points.y + first, start.y), load(points.z + first, start.z);
        Ints is_found = ~Ints{};
        for (int l = 0; l < kWidth; ++l) is_found[l] = first + l < points.count ? -1 : 0;
        Ints i_read = Ints{} - 2, j_read{}, k_read{};  // no cell yet
        const Floats zero{};
        start.x = is_found ? start.x : zero, start.y = is_found ? start.y : zero,
        start.z = is_found ? start.z : zero;
        p = start;
        for (int n = 0; n < steps; ++n) {
            Ints i, j, k;
            cellUnder((p.x + d.origin[0]) * ix, d.dims[0], i, in_cell.x);
            cellUnder((p.y + d.origin[1]) * iy, d.dims[1], j, in_cell.y);
            cellUnder((p.z + d.origin[2]) * iz, d.dims[2], k, in_cell.z);
            // Mostly the second step begins in the cells of the first.
            if (isAny((i != i_read) | (j != j_read) | (k != k_read))) readCells(d, i, j, k, e);
            i_read = i, j_read = j, k_read = k;
            sampleCells(e, in_cell, excess, slope);
            slope.x *= ix, slope.y *= iy, slope.z *= iz;
            const Floats rise = slope.x * slope.x + slope.y * slope.y + slope.z * slope.z;
            is_found &= rise > 0;
            const Floats scale = excess / (is_found ? rise : 1 + zero);
            p.x -= scale * slope.x, p.y -= scale * slope.y, p.z -= scale * slope.z;
            const Floats dx = p.x - start.x, dy = p.y - start.y, dz = p.z - start.z;
            is_found &= dx * dx + dy * dy + dz * dz <= reach_squared;
            p.x = is_found ? p.x : start.x, p.y = is_found ? p.y : start.y, p.z = is_found ? p.z : start.z;
        }
        store(p.x, points.x + first), store(p.y, points.y + first), store(p.z, points.z + first);
    }
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
