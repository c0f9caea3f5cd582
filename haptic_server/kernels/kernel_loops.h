// The loops of kernels.h, for the compiler to make vector instructions of. Included once per instruction set,
// with BONEMILL_CPU_LEVEL_NAMESPACE set; includes nothing with inline functions, whose copies the linker
// would mix up between instruction sets.
#include "haptic_server/kernels/kernels.h"

namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// Of single precision, in one register: GCC 12 takes wider vectors apart into scalars where it must choose
// lanes.
#if defined(__AVX512F__)
constexpr int kWidth = 16;
#elif defined(__AVX2__)
constexpr int kWidth = 8;
#else
constexpr int kWidth = 4;
#endif
static_assert(kCellLanes % kWidth == 0 && (kRowSlack + 1) % kWidth == 0);

template <class Scalar>
inline Scalar least(Scalar a, Scalar b) {
    return b < a ? b : a;
}
template <class Scalar>
inline Scalar largest(Scalar a, Scalar b) {
    return a < b ? b : a;
}
inline float root(float x) {
    return __builtin_sqrtf(x);
}
inline double root(double x) {
    return __builtin_sqrt(x);
}

template <class Scalar>
void intoFrame(const FrameChange<Scalar>& f, const float* __restrict x, const float* __restrict y,
               const float* __restrict z, int count, Scalar* __restrict out_x, Scalar* __restrict out_y,
               Scalar* __restrict out_z) {
    const FrameChange<Scalar> frame = f;
    for (int i = 0; i < count; ++i) {
        const Scalar dx = Scalar(x[i]) - frame.origin[0], dy = Scalar(y[i]) - frame.origin[1],
                     dz = Scalar(z[i]) - frame.origin[2];
        out_x[i] = frame.R[0] * dx + frame.R[1] * dy + frame.R[2] * dz;
        out_y[i] = frame.R[3] * dx + frame.R[4] * dy + frame.R[5] * dz;
        out_z[i] = frame.R[6] * dx + frame.R[7] * dy + frame.R[8] * dz;
    }
}

template <class Scalar>
void nearerRound(const RoundSolid<Scalar>& solid, const Scalar* __restrict px, const Scalar* __restrict py,
                 const Scalar* __restrict pz, int count, Scalar* __restrict out) {
    const RoundSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        const Scalar x = px[i] - s.from[0], y = py[i] - s.from[1], z = pz[i] - s.from[2];
        const Scalar along =
            least(largest(x * s.axis[0] + y * s.axis[1] + z * s.axis[2], Scalar(0)), s.length);
        const Scalar dx = x - along * s.axis[0], dy = y - along * s.axis[1], dz = z - along * s.axis[2];
        out[i] = least(out[i], root(dx * dx + dy * dy + dz * dz) - s.radius);
    }
}

template <class Scalar>
void sampleNearerRound(const RoundSolid<Scalar>& solid, const Scalar* __restrict px,
                       const Scalar* __restrict py, const Scalar* __restrict pz, int count,
                       Scalar* __restrict distance, Scalar* __restrict gx, Scalar* __restrict gy,
                       Scalar* __restrict gz) {
    constexpr Scalar kOnAxis = Scalar(1e-15);  // m
    const RoundSolid<Scalar> s = solid;
    for (int i = 0; i < count; ++i) {
        const Scalar x = px[i] - s.from[0], y = py[i] - s.from[1], z = pz[i] - s.from[2];
        const Scalar along =
            least(largest(x * s.axis[0] + y * s.axis[1] + z * s.axis[2], Scalar(0)), s.length);
        const Scalar dx = x - along * s.axis[0], dy = y - along * s.axis[1], dz = z - along * s.axis[2];
        const Scalar to_axis = root(dx * dx + dy * dy + dz * dz);
        const Scalar scale = 1 / largest(to_axis, kOnAxis);
        const Scalar here = to_axis - s.radius;
        const Scalar there = distance[i], tx = gx[i], ty = gy[i], tz = gz[i];
        const bool is_nearer = here < there;
        distance[i] = is_nearer ? here : there;
        gx[i] = is_nearer ? dx * scale : tx;
        gy[i] = is_nearer ? dy * scale : ty;
        gz[i] = is_nearer ? dz * scale : tz;
    }
}

constexpr int kSumLanes = 8;  // of every sum, whatever the width of the registers
using Doubles = double __attribute__((vector_size(4 * kWidth)));
constexpr int kDoubles = kWidth / 2, kParts = kSumLanes / kDoubles;

inline void load(const double* p, Doubles& v) {
    __builtin_memcpy(&v, p, sizeof v);
}
double total(const Doubles (&parts)[kParts]) {
    double v[kSumLanes];
    __builtin_memcpy(v, parts, sizeof v);
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}
double dot(const double* a, const double* b, int padded) {
    Doubles sum[kParts] = {}, x, y;
    for (int i = 0; i < padded; i += kSumLanes)
        for (int part = 0; part < kParts; ++part) {
            load(a + i + part * kDoubles, x), load(b + i + part * kDoubles, y);
            sum[part] += x * y;
        }
    return total(sum);
}
double sumOf(const double* a, int padded) {
    Doubles sum[kParts] = {}, x;
    for (int i = 0; i < padded; i += kSumLanes)
        for (int part = 0; part < kParts; ++part) {
            load(a + i + part * kDoubles, x);
            sum[part] += x;
        }
    return total(sum);
}

template <class Scalar>
void addContacts(const ContactFrame& frame, const float* __restrict x, const float* __restrict y,
                 const float* __restrict z, const float* __restrict weight, const Scalar* __restrict distance,
                 const Scalar* __restrict gx, const Scalar* __restrict gy, const Scalar* __restrict gz,
                 int count, ContactSums& sums) {
    const ContactFrame f = frame;
    // J: of the depth by the tool's pose, negative: g, r x g.
    alignas(64) double J[6][kContactBatch], pull[kContactBatch], k[kContactBatch], energy[kContactBatch],
        depths[kContactBatch];
    for (int i = 0; i < count; ++i) {
        const double rx = double(x[i]) - f.p_OT[0], ry = double(y[i]) - f.p_OT[1],
                     rz = double(z[i]) - f.p_OT[2];
        const double tx = double(gx[i]), ty = double(gy[i]), tz = double(gz[i]);
        const double vx = f.R_VT[0] * tx + f.R_VT[1] * ty + f.R_VT[2] * tz;
        const double vy = f.R_VT[3] * tx + f.R_VT[4] * ty + f.R_VT[5] * tz;
        const double vz = f.R_VT[6] * tx + f.R_VT[7] * ty + f.R_VT[8] * tz;
        const double depth = -double(distance[i]), w = double(weight[i]);
        const double capped = least(depth, f.depth_cap);
        J[0][i] = vx, J[1][i] = vy, J[2][i] = vz;
        J[3][i] = ry * vz - rz * vy, J[4][i] = rz * vx - rx * vz, J[5][i] = rx * vy - ry * vx;
        pull[i] = w * capped;
        // Beyond the cap the secant keeps the matrix's direction.
        k[i] = depth > f.depth_cap ? pull[i] / depth : w;
        energy[i] = pull[i] * (depth - capped / 2);
        depths[i] = depth;
    }
    const int padded = (count + kSumLanes - 1) / kSumLanes * kSumLanes;
    for (int i = count; i < padded; ++i) {
        for (int axis = 0; axis < 6; ++axis) J[axis][i] = 0;
        pull[i] = k[i] = energy[i] = depths[i] = 0;
    }
    sums.energy += sumOf(energy, padded);
    for (int i = 0; i < count; ++i) sums.max_depth = largest(sums.max_depth, depths[i]);
    for (int axis = 0; axis < 3; ++axis) {
        sums.force[axis] -= dot(pull, J[axis], padded);
        sums.torque[axis] -= dot(pull, J[3 + axis], padded);
    }
    alignas(64) double kJ[kContactBatch];
    double* sum = sums.stiffness;
    for (int row = 0; row < 6; ++row) {
        for (int i = 0; i < padded; ++i) kJ[i] = k[i] * J[row][i];
        for (int column = row; column < 6; ++column) *sum++ += dot(kJ, J[column], padded);
    }
}

using Floats = float __attribute__((vector_size(4 * kWidth)));
using Ints = int __attribute__((vector_size(4 * kWidth)));

inline void load(const float* p, Floats& v) {
    __builtin_memcpy(&v, p, sizeof v);
}
inline void load(const int* p, Ints& v) {
    __builtin_memcpy(&v, p, sizeof v);
}
inline void store(const Floats& v, float* p) {
    __builtin_memcpy(p, &v, sizeof v);
}
inline void store(const Ints& v, int* p) {
    __builtin_memcpy(p, &v, sizeof v);
}
inline void rootOf(const Floats& v, Floats& out) {
    alignas(64) float in[kWidth], result[kWidth];
    store(v, in);
    for (int l = 0; l < kWidth; ++l) result[l] = root(in[l]);
    load(result, out);
}

// As many densities as there are single precision lanes.
using Words = uint16_t __attribute__((vector_size(2 * kWidth)));
// For rows that are only looked at.
constexpr int kWideWords = kWidth == 4 ? 8 : 16;
using WideWords = uint16_t __attribute__((vector_size(2 * kWideWords)));

template <class W>
inline void loadWords(const uint16_t* p, W& words) {
    __builtin_memcpy(&words, p, sizeof words);
}

// Anything to mill: a row of air has nothing to remove, a solid one no room to add.
template <int kDirection>
bool isFinished(const uint16_t* row, int count) {
    constexpr uint16_t kFinished = kDirection < 0 ? 0 : 65535;
    WideWords any{}, part;
    for (int i = 0; i < count; i += kWideWords) {
        loadWords(row + i, part);
        any |= part ^ kFinished;
    }
    uint64_t parts[sizeof any / sizeof(uint64_t)], left = 0;
    __builtin_memcpy(parts, &any, sizeof any);
    for (const uint64_t p : parts) left |= p;
    return left == 0;
}

// kDirection: -1 removes, +1 adds. Without branches; lanes beyond the burr's reach or the row keep their
// density.
template <int kDirection>
MilledRow millRow(const BurrRow& burr, const uint16_t* __restrict row, int count, uint16_t* __restrict out) {
    if (isFinished<kDirection>(row, count)) return {0, 0, 0};
    constexpr float kMost = 65535, kCore = kDirection < 0 ? 0 : kMost;
    const BurrRow b = burr;
    Ints lane, changed{}, removed{}, added{};  // counts below zero: a true comparison is -1
    for (int l = 0; l < kWidth; ++l) lane[l] = l;
    for (int i = 0; i < count; i += kWidth) {
        Words words;
        loadWords(row + i, words);
        const Ints old = __builtin_convertvector(words, Ints);
        const Floats x = b.first_x + __builtin_convertvector(lane + i, Floats) * b.step_x;
        const Floats squared = x * x + b.off_row_squared;
        Floats distance;
        rootOf(squared, distance);
        const Floats ramp = float(b.iso) - float(kDirection) * b.slope * (distance - b.radius);
        const Floats low = ramp < 0 ? Floats{} : ramp;
        const Floats clamped = (low > kMost ? Floats{} + kMost : low) + 0.5f;
        const Ints limit =
            __builtin_convertvector(squared < b.core_squared ? Floats{} + kCore : clamped, Ints);
        const Ints step = old + kDirection * b.amount;
        const Ints moved = kDirection < 0 ? (limit > step ? limit : step) : (limit < step ? limit : step);
        const Ints towards = kDirection < 0 ? (moved < old ? moved : old) : (moved > old ? moved : old);
        const Ints now = (squared < b.reach_squared) & (lane + i < count) ? towards : old;
        const Words fresh = __builtin_convertvector(now, Words);
        __builtin_memcpy(out + i, &fresh, sizeof fresh);
        changed += now != old;
        removed += (old >= b.iso) & (now < b.iso);
        added += (old < b.iso) & (now >= b.iso);
    }
    MilledRow sum{0, 0, 0};
    for (int l = 0; l < kWidth; ++l) {
        sum.changed -= changed[l];
        sum.removed -= removed[l];
        sum.added -= added[l];
    }
    return sum;
}

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2 & 1); edges 4 a .. 4 a + 3 run along axis a.
constexpr int kEdgeLow[12] = {0, 2, 4, 6, 0, 1, 4, 5, 0, 1, 2, 3};

template <class T, class Vector>
inline void gather(const T* table, const Ints& index, Vector& out) {
    alignas(64) int at[kWidth];
    alignas(64) T result[kWidth];
    store(index, at);
    for (int l = 0; l < kWidth; ++l) result[l] = table[at[l]];
    load(result, out);
}
inline bool isAny(const Ints& mask) {
    int any = 0;
    for (int l = 0; l < kWidth; ++l) any |= mask[l];
    return any != 0;
}

// Where the density, linear along each edge, equals iso, for kCellLanes cells: [axis][edge][lane], cell
// steps. Edges that are not crossed hold anything.
void crossings(const CellArrays& cells, int first, float (&at)[3][12 * kWidth]) {
    for (int edge = 0; edge < 12; ++edge) {
        const int axis = edge / 4, low_corner = kEdgeLow[edge];
        Floats low, high;
        load(cells.excess[low_corner] + first, low);
        load(cells.excess[low_corner | 1 << axis] + first, high);
        for (int d = 0; d < 3; ++d)
            store(d == axis ? low / (low - high) : Floats{} + float(low_corner >> d & 1),
                  at[d] + edge * kWidth);
    }
}

struct Points {
    Floats x, y, z;
};

inline void crossingOn(const float (&at)[3][12 * kWidth], const Ints& edge, const Ints& lane, Points& p) {
    const Ints index = edge * kWidth + lane;
    gather(at[0], index, p.x);
    gather(at[1], index, p.y);
    gather(at[2], index, p.z);
}

void cellPatches(const CellArrays& cells, const int* triangle_edges, const float steps[3],
                 const CellPatches& out) {
    Ints lane;
    for (int l = 0; l < kWidth; ++l) lane[l] = l;
    for (int first = 0; first < cells.count; first += kWidth) {
        alignas(64) float at[3][12 * kWidth];
        crossings(cells, first, at);
        Ints inside;
        load(cells.inside + first, inside);
        inside = first + lane < cells.count ? inside : Ints{};
        Floats twice{}, mx{}, my{}, mz{};
        for (int triangle = 0; triangle < 5; ++triangle) {
            const Ints row = inside * kTriangleStride + 3 * triangle;
            Ints edge[3];
            for (int v = 0; v < 3; ++v) gather(triangle_edges + v, row, edge[v]);
            const Ints is_one = (edge[0] | edge[1]) != 0;
            if (!isAny(is_one)) break;
            Points a, b, c;
            crossingOn(at, edge[0], lane, a);
            crossingOn(at, edge[1], lane, b);
            crossingOn(at, edge[2], lane, c);
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

// Excess and slope of the trilinear density at `p`.
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

inline void cellUnder(const Floats& u, int dim, Ints& cell, Floats& in_cell) {
    const Ints truncated = __builtin_convertvector(u, Ints);
    const Ints below =
        truncated + (u < __builtin_convertvector(truncated, Floats));  // a true comparison is -1
    const Ints high = below > dim - 1 ? Ints{} + (dim - 1) : below;
    cell = high < -1 ? Ints{} - 1 : high;
    in_cell = u - __builtin_convertvector(cell, Floats);
}

// Densities minus iso at the corners of each lane's cell.
void readCells(const DensityView& d, const Ints& i, const Ints& j, const Ints& k, Floats (&e)[8]) {
    alignas(64) float corner[8][kWidth];
    const float iso = float(d.iso);
    for (int l = 0; l < kWidth; ++l) {
        const uint16_t* p = d.first + i[l] + int64_t(d.stride_y) * j[l] + int64_t(d.stride_z) * k[l];
        corner[0][l] = float(p[0]), corner[1][l] = float(p[1]);
        corner[2][l] = float(p[d.stride_y]), corner[3][l] = float(p[d.stride_y + 1]);
        p += d.stride_z;
        corner[4][l] = float(p[0]), corner[5][l] = float(p[1]);
        corner[6][l] = float(p[d.stride_y]), corner[7][l] = float(p[d.stride_y + 1]);
    }
    for (int c = 0; c < 8; ++c) {
        load(corner[c], e[c]);
        e[c] -= iso;
    }
}

void moveOntoSurface(const DensityView& density, int steps, const SurfacePoints& points) {
    const DensityView d = density;
    const float ix = d.inverse_spacing[0], iy = d.inverse_spacing[1], iz = d.inverse_spacing[2];
    for (int first = 0; first < points.count; first += kWidth) {
        Points start, p, own, in_cell, slope;
        Floats reach_squared, excess, e[8];
        load(points.x + first, start.x), load(points.y + first, start.y), load(points.z + first, start.z);
        load(points.own_x + first, own.x), load(points.own_y + first, own.y),
            load(points.own_z + first, own.z);
        load(points.reach_squared + first, reach_squared);
        Ints is_found = ~Ints{};
        for (int l = 0; l < kWidth; ++l) is_found[l] = first + l < points.count ? -1 : 0;
        const Floats zero{};
        start.x = is_found ? start.x : zero, start.y = is_found ? start.y : zero,
        start.z = is_found ? start.z : zero;
        p = start;
        for (int n = 0; n < steps; ++n) {
            Ints i, j, k;
            cellUnder((p.x + d.origin[0]) * ix, d.dims[0], i, in_cell.x);
            cellUnder((p.y + d.origin[1]) * iy, d.dims[1], j, in_cell.y);
            cellUnder((p.z + d.origin[2]) * iz, d.dims[2], k, in_cell.z);
            readCells(d, i, j, k, e);
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
        store(is_found ? p.x : own.x, points.x + first);
        store(is_found ? p.y : own.y, points.y + first);
        store(is_found ? p.z : own.z, points.z + first);
    }
}

float leastScaled(const float* __restrict value, const float* __restrict lowest,
                  const float* __restrict scale, int count, float most) {
    constexpr int kLanes = 16;
    float lane[kLanes];
    for (int l = 0; l < kLanes; ++l) lane[l] = most;
    int i = 0;
    for (; i + kLanes <= count; i += kLanes)
        for (int l = 0; l < kLanes; ++l)
            lane[l] = least(lane[l], (value[i + l] - lowest[i + l]) * scale[i + l]);
    float result = most;
    for (int l = 0; l < kLanes; ++l) result = least(result, lane[l]);
    for (; i < count; ++i) result = least(result, (value[i] - lowest[i]) * scale[i]);
    return result;
}

void rangeOfRows(const uint16_t* row, int count, size_t stride, int rows, uint16_t& low, uint16_t& high) {
    uint16_t l = low, h = high;
    if (count < kWideWords) {
        for (int r = 0; r < rows; ++r, row += stride)
            for (int i = 0; i < count; ++i) l = least(l, row[i]), h = largest(h, row[i]);
    } else {
        WideWords lows = WideWords{} + l, highs = WideWords{} + h, part;
        for (int r = 0; r < rows; ++r, row += stride)
            for (int i = 0; i < count; i += kWideWords) {
                loadWords(row + least(i, count - kWideWords), part);  // the last one may overlap
                lows = part < lows ? part : lows;
                highs = highs < part ? part : highs;
            }
        for (int n = 0; n < kWideWords; ++n) l = least(l, lows[n]), h = largest(h, highs[n]);
    }
    low = l, high = h;
}

}  // namespace

extern const Kernels kTable;
const Kernels kTable = {
    .single = {intoFrame<float>, nearerRound<float>, sampleNearerRound<float>, addContacts<float>},
    .twice = {intoFrame<double>, nearerRound<double>, sampleNearerRound<double>, addContacts<double>},
    .remove_row = millRow<-1>,
    .add_row = millRow<+1>,
    .cell_patches = cellPatches,
    .project_into_cells = projectIntoCells,
    .move_onto_surface = moveOntoSurface,
    .least_scaled = leastScaled,
    .range_of_rows = rangeOfRows};

}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
