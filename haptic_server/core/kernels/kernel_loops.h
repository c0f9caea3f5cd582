// These are the loops of kernels.h, for the compiler to make vector instructions of. The file is included
// once per instruction set, with BONEMILL_CPU_LEVEL_NAMESPACE set; includes nothing with inline functions,
// whose copies the linker would mix up between instruction sets (those of immintrin.h have none).
#if defined(__AVX2__)
#include <immintrin.h>
#endif

#include "haptic_server/core/kernels/brick_layout.h"
#include "haptic_server/core/kernels/kernels.h"
#include "haptic_server/core/kernels/loop_vectors.h"
// The others need the vectors.
#include "haptic_server/core/kernels/cell_loops.h"
#include "haptic_server/core/kernels/point_loops.h"
#include "haptic_server/core/kernels/row_loops.h"

namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE {

extern const Kernels kTable;
const Kernels kTable = {.single = {intoFrame<float>, nearerRound<float>, sampleNearerRound<float>,
                                   nearerCone<float>, sampleNearerCone<float>, addContacts<float>},
                        .twice = {intoFrame<double>, nearerRound<double>, sampleNearerRound<double>,
                                  nearerCone<double>, sampleNearerCone<double>, addContacts<double>},
                        .select_near = selectNear,
                        .remove_plane = millPlane<-1>,
                        .add_plane = millPlane<+1>,
                        .lay_plane = layPlane,
                        .cell_patches = cellPatches,
                        .project_into_cells = projectIntoCells,
                        .move_onto_surface = moveOntoSurface,
                        .least_scaled = leastScaled,
                        .range_of_rows = rangeOfRows,
                        .cell_sides = cellSides};

}  // namespace bonemill::BONEMILL_CPU_LEVEL_NAMESPACE
