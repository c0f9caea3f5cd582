// These are the loops of kernels.h, for the compiler to make vector instructions of. The file is included
// once per instruction set, with BONEMILL_CPU_LEVEL_NAMESPACE set; includes nothing with inline functions,
// whose copies the linker would mix up between instruction sets (those of immintrin.h have none).
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/core/kernels/kernels.h"

// The vector types have the width of the registers.
namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {
namespace {

// The lanes are of single precision, in one register: GCC 12 takes wider vectors apart into scalars where it
// must choose lanes.
#if defined(__AVX512F__)
constexpr int kWidth = 16;
#elif defined(__AVX2__)
constexpr int kWidth = 8;
#else
constexpr int kWidth = 4;
#endif
static_assert(kCellLanes % kWidth == 0);

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
// The numbers of the lanes.
inline void countLanes(Ints& lane) {
    for (int l = 0; l < kWidth; ++l) lane[l] = l;
}
inline bool isAny(const Ints& mask) {
#if defined(__AVX512F__)
    return _mm512_test_epi32_mask(__m512i(mask), __m512i(mask)) != 0;
#elif defined(__AVX2__)
    return _mm256_testz_si256(__m256i(mask), __m256i(mask)) == 0;
#else
    int any = 0;
    for (int l = 0; l < kWidth; ++l) any |= mask[l];
    return any != 0;
#endif
}
inline void rootOf(const Floats& v, Floats& out) {
    alignas(64) float in[kWidth], result[kWidth];
    store(v, in);
    for (int l = 0; l < kWidth; ++l) result[l] = root(in[l]);
    load(result, out);
}

// There are as many densities as there are single precision lanes.
using Words = uint16_t __attribute__((vector_size(2 * kWidth)));
// These are for rows that are only looked at.
constexpr int kWideWords = kWidth == 4 ? 8 : 16;
using WideWords = uint16_t __attribute__((vector_size(2 * kWideWords)));

template <class W>
inline void loadWords(const uint16_t* p, W& words) {
    __builtin_memcpy(&words, p, sizeof words);
}

}  // namespace
}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE

// These need the vectors.
#include "haptic_server/core/kernels/cell_loops.h"
#include "haptic_server/core/kernels/pack_loops.h"
#include "haptic_server/core/kernels/piece_loops.h"
#include "haptic_server/core/kernels/point_loops.h"
#include "haptic_server/core/kernels/row_loops.h"
#include "haptic_server/core/kernels/rubbing_loops.h"
#include "haptic_server/core/kernels/shift_loops.h"

namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {

extern const Kernels kTable;
const Kernels kTable = {.single = {intoFrame<float>, nearerRound<float>, sampleNearerRound<float>,
                                   nearerCone<float>, sampleNearerCone<float>, addContacts<float>},
                        .twice = {intoFrame<double>, nearerRound<double>, sampleNearerRound<double>,
                                  nearerCone<double>, sampleNearerCone<double>, addContacts<double>},
                        .add_rubbing = addRubbing,
                        .select_near = selectNear,
                        .remove_plane = millPlane<-1>,
                        .add_plane = millPlane<+1>,
                        .lay_plane = layPlane,
                        .read_cells = readListedCells,
                        .cell_patches = cellPatches,
                        .cell_fills = cellFills,
                        .project_into_cells = projectIntoCells,
                        .pack_points = packPoints,
                        .move_onto_surface = moveOntoSurface,
                        .sink_surface = sinkSurface,
                        .hat_boxes = hatBoxes,
                        .add_hat = addHat,
                        .add_hat_where_any = addHatWhereAny,
                        .cell_triangles = cellTriangles,
                        .halve_pieces = halvePieces,
                        .measure_pieces = measurePieces,
                        .lower_bounds = lowerBounds,
                        .level_pieces = levelPieces,
                        .least_scaled = leastScaled,
                        .range_of_rows = rangeOfRows,
                        .cell_sides = cellSides};

}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
